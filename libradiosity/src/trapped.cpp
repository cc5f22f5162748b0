#include "trapped.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "material/error.h"

namespace atrium::radiosity {
namespace {

constexpr double kNoLoss = 1e-7;  // below what a float reflectance next to 1 can mean

template <int N>
bool all_sides_absorb(const Sides<N>& sides) {
  return std::all_of(sides.active.begin(), sides.active.end(), [&](SideIndex i) {
    return static_cast<double>((sides.reflectance[i] + sides.transmittance[i]).max()) <
           1.0 - kNoLoss;
  });
}

/// Which lanes get out, by side; spreads from rows that lose light to those that see their sides.
template <int N>
class Exits {
 public:
  Exits(const Problem<N>& problem, const Rows<N>& rows)
      : sides_(problem.sides), rows_(rows), out_(problem.side_count(), kAll) {
    for (std::size_t k = 0; k < rows.size(); ++k) out_[sides_.active[k]] = lossy(k);
  }

  std::vector<std::uint8_t> trapped() {
    while (spread()) {
    }
    for (std::uint8_t& mask : out_) mask = static_cast<std::uint8_t>(~mask & kAll);
    return out_;
  }

 private:
  static constexpr std::uint8_t kAll = static_cast<std::uint8_t>((1U << N) - 1U);

  std::uint8_t lossy(std::size_t k) const {
    if (rows_.rays[k] == 0) return kAll;
    std::array<double, N> kept{};
    for (std::uint64_t e = rows_.first[k]; e < rows_.first[k + 1]; ++e) {
      const auto& entry = rows_.entries[e];
      const bool chromatic = (entry.target & Rows<N>::kChromatic) != 0;
      const SideIndex t = entry.target & ~Rows<N>::kChromatic;
      for (int lane = 0; lane < N; ++lane) {
        const float weight = entry.weight * (chromatic ? rows_.spectral[entry.spectral][lane] : 1);
        kept[static_cast<std::size_t>(lane)] +=
            static_cast<double>(weight) * (static_cast<double>(sides_.reflectance[t][lane]) +
                                           static_cast<double>(sides_.transmittance[t][lane]));
      }
    }
    return lanes([&](int lane) {
      return kept[static_cast<std::size_t>(lane)] < (1.0 - kNoLoss) * rows_.rays[k];
    });
  }

  bool spread() {
    bool changed = false;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      std::uint8_t& mask = out_[sides_.active[k]];
      if (mask == kAll) continue;
      const std::uint8_t before = mask;
      for (std::uint64_t e = rows_.first[k]; e < rows_.first[k + 1] && mask != kAll; ++e) {
        const SideIndex t = rows_.entries[e].target & ~Rows<N>::kChromatic;
        const unsigned own = lanes([&](int l) { return sides_.reflectance[t][l] > 0.0f; });
        const unsigned other = lanes([&](int l) { return sides_.transmittance[t][l] > 0.0f; });
        mask = static_cast<std::uint8_t>(mask | (out_[t] & own) | (out_[t ^ 1U] & other));
      }
      changed |= mask != before;
    }
    return changed;
  }

  template <class F>
  static std::uint8_t lanes(F&& f) {
    unsigned mask = 0;
    for (int lane = 0; lane < N; ++lane) mask |= f(lane) ? 1U << lane : 0U;
    return static_cast<std::uint8_t>(mask);
  }

  const Sides<N>& sides_;
  const Rows<N>& rows_;
  std::vector<std::uint8_t> out_;
};

/// Sides that see each other, by the lowest of them.
class Groups {
 public:
  explicit Groups(std::size_t sides) : parent_(sides) {
    std::iota(parent_.begin(), parent_.end(), SideIndex{0});
  }
  SideIndex of(SideIndex i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(SideIndex a, SideIndex b) {
    a = of(a);
    b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<SideIndex> parent_;
};

struct Group {
  bool seen = false, lit = false;
  std::uint64_t rays = 0;
  std::vector<SideIndex> sides;
};

template <class Name>
std::string list(const std::vector<SideIndex>& sides, Name&& name) {
  constexpr std::size_t kShown = 4;
  std::vector<std::string> names;
  for (const SideIndex i : sides) {
    std::string n = name(i);
    if (!n.empty() && std::find(names.begin(), names.end(), n) == names.end())
      names.push_back(std::move(n));
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i)
    text += (i > 0 ? ", '" : "'") + names[i] + "'";
  if (names.size() > kShown) text += " and " + std::to_string(names.size() - kShown) + " more";
  return text;
}

template <int N>
[[noreturn]] void refuse(const Problem<N>& problem, const std::vector<SideIndex>& sides) {
  const scene::Scene& scene = problem.shading.scene();
  const auto object = [&](SideIndex i) -> const scene::Object& {
    const Elements& e = problem.elements;
    return scene.objects[e.pieces[e.first_piece[i / 2]].object.value];
  };
  const std::string materials =
      list(sides, [&](SideIndex i) { return scene.materials[object(i).material.value].name; });
  const std::string objects = list(sides, [&](SideIndex i) { return object(i).name; });
  throw Error(
      "radiosity: a closed enclosure reflects all light (reflectance 1), there is no "
      "finite solution" +
      (materials.empty() ? "" : "; material " + materials) +
      (objects.empty() ? "" : "; objects " + objects));
}

}  // namespace

template <int N>
std::vector<std::uint8_t> find_trapped(const Problem<N>& problem, const Rows<N>& rows) {
  if (all_sides_absorb(problem.sides)) return {};
  std::vector<std::uint8_t> trapped = Exits<N>(problem, rows).trapped();
  const bool any =
      std::any_of(trapped.begin(), trapped.end(), [](std::uint8_t t) { return t != 0; });
  return any ? trapped : std::vector<std::uint8_t>{};
}

template <int N>
void refuse_enclosures(const Problem<N>& problem, const Rows<N>& rows,
                       const std::vector<std::uint8_t>& trapped, const SideValues<N>& source,
                       const SideValues<N>& constant) {
  constexpr std::uint64_t kEvidence = 500;  // an opening of 1 % is missed once in 150 times
  if (trapped.empty()) return;
  Groups groups(problem.side_count());
  const auto for_entries = [&](auto&& f) {
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (std::uint64_t e = rows.first[k]; e < rows.first[k + 1]; ++e)
        f(problem.sides.active[k], rows.entries[e].target & ~Rows<N>::kChromatic);
  };
  for_entries([&](SideIndex from, SideIndex to) {
    if (trapped[from] != 0 && trapped[to] != 0) groups.unite(from, to);
  });
  std::map<SideIndex, Group> found;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const SideIndex i = problem.sides.active[k];
    if (trapped[i] == 0) continue;
    Group& g = found[groups.of(i)];
    g.sides.push_back(i);
    g.rays += rows.rays[k];
    for (int lane = 0; lane < N; ++lane)
      g.lit |= (trapped[i] >> lane & 1) != 0 && (source[i][lane] != 0 || constant[i][lane] != 0);
  }
  for_entries([&](SideIndex from, SideIndex to) {
    if (trapped[from] == 0 && trapped[to] != 0) found[groups.of(to)].seen = true;
  });
  for (const auto& [first, g] : found)
    if (g.lit && !g.seen && g.rays >= kEvidence) refuse(problem, g.sides);
}

#define ATRIUM_INSTANTIATE(N)                                                             \
  template std::vector<std::uint8_t> find_trapped(const Problem<N>&, const Rows<N>&);     \
  template void refuse_enclosures(const Problem<N>&, const Rows<N>&,                      \
                                  const std::vector<std::uint8_t>&, const SideValues<N>&, \
                                  const SideValues<N>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
