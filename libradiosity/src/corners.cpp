#include "radiosity/corners.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "material/bsdf.h"
#include "scene/parallel.h"

namespace atrium::radiosity {
namespace {

using scene::Side;
using scene::SurfaceField;

/// A corner on its facet's lattice of the smallest cells.
struct Place {
  std::uint32_t facet, y, x;
  // clang-tidy 14 takes the 0 that it compares with for a pointer.
  auto operator<=>(const Place&) const = default;  // NOLINT(modernize-use-nullptr)
};

struct Use {
  Place place;
  std::uint8_t level;
  std::uint64_t slot;  // element * 4 + corner
};

class CornerFinder {
 public:
  explicit CornerFinder(const SurfaceField& layout) : layout_(layout) {
    for (const std::uint8_t l : layout.element_level) finest_ = std::max(finest_, int{l});
  }

  CellCorners find() {
    share_corners();
    find_hanging();
    return std::move(result_);
  }

 private:
  /// A point of an element's cell in halves of its edge, 0 to 2.
  Place place(std::uint32_t e, std::uint32_t half_x, std::uint32_t half_y) const {
    const int shift = finest_ - layout_.element_level[e];
    const auto on_lattice = [&](std::uint32_t cell, std::uint32_t half) {
      return (cell << shift) + (half << shift) / 2;
    };
    return {layout_.element_facet[e], on_lattice(layout_.element_y[e], half_y),
            on_lattice(layout_.element_x[e], half_x)};
  }

  void share_corners() {
    const std::size_t count = layout_.element_count();
    std::vector<Use> uses;
    uses.reserve(4 * count);
    for (std::uint32_t e = 0; e < count; ++e)
      for (std::uint32_t k = 0; k < 4; ++k)
        uses.push_back(
            {place(e, 2 * (k & 1U), k & 2U), layout_.element_level[e], std::uint64_t{e} * 4 + k});
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
      return std::tie(a.place, a.level, a.slot) < std::tie(b.place, b.level, b.slot);
    });
    result_.of_element.resize(count);
    for (const Use& use : uses) {
      if (places_.empty() || places_.back() != use.place) {
        const int shift = finest_ - use.level;
        places_.push_back(use.place);
        result_.corners.push_back(
            {use.place.facet, use.level, use.place.x >> shift, use.place.y >> shift});
      }
      result_.of_element[use.slot / 4][use.slot % 4] =
          static_cast<std::uint32_t>(places_.size() - 1);
    }
  }

  void find_hanging() {
    constexpr std::array<std::array<std::uint32_t, 4>, 4> kEdges{
        {{0, 1, 0, 2}, {2, 1, 1, 3}, {1, 0, 0, 1}, {1, 2, 2, 3}}};  // middle x, y; its ends
    std::vector<std::pair<std::uint8_t, CellCorners::Hanging>> found;
    for (std::uint32_t e = 0; e < layout_.element_count(); ++e) {
      if (layout_.element_level[e] == finest_) continue;
      for (const auto& [x, y, a, b] : kEdges) {
        const Place middle = place(e, x, y);
        const auto it = std::lower_bound(places_.begin(), places_.end(), middle);
        if (it == places_.end() || *it != middle) continue;
        const auto& own = result_.of_element[e];
        found.push_back({layout_.element_level[e],
                         {static_cast<std::uint32_t>(it - places_.begin()), {own[a], own[b]}}});
      }
    }
    // The ends of an edge can only hang on larger cells.
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [level, h] : found) result_.hanging.push_back(h);
  }

  const SurfaceField& layout_;
  int finest_ = 0;
  std::vector<Place> places_;  // by corner, ascending
  CellCorners result_;
};

template <int N>
void evaluate(const SurfaceField& field, const CellCorners& corners,
              const std::vector<float>& array, std::vector<float>& result) {
  scene::parallel_for(corners.corners.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (const Side side : {Side::Front, Side::Back}) {
        const CellCorners::Corner& c = corners.corners[i];
        const SurfaceField::Stencil s = field.stencil(
            field.facets[c.facet], c.level, static_cast<float>(c.x), static_cast<float>(c.y), side);
        const Spectrum<N> value = field.interpolate<N>(array, s, side);
        for (int k = 0; k < N; ++k)
          result[(i * 2 + static_cast<std::size_t>(side)) * N + static_cast<std::size_t>(k)] =
              value[k];
      }
  });
}

}  // namespace

CellCorners cell_corners(const SurfaceField& layout) { return CornerFinder(layout).find(); }

std::vector<float> corner_values(const SurfaceField& field, const CellCorners& corners,
                                 const std::vector<float>& array) {
  if (corners.of_element.size() != field.element_count())
    throw std::invalid_argument("corner_values: corners of another layout");
  if (array.empty()) return {};
  const std::size_t stride = 2 * static_cast<std::size_t>(field.lanes);
  std::vector<float> result(corners.corners.size() * stride);
  with_lanes(field.lanes, [&](auto lanes) { evaluate<lanes()>(field, corners, array, result); });
  for (const CellCorners::Hanging& h : corners.hanging)
    for (std::size_t k = 0; k < stride; ++k)
      result[h.corner * stride + k] =
          0.5f * (result[h.between[0] * stride + k] + result[h.between[1] * stride + k]);
  return result;
}

std::array<float, 4> corner_weights(const SurfaceField& layout, std::uint32_t element,
                                    const Vec3f& position) {
  const SurfaceField::Facet& facet = layout.facets[layout.element_facet[element]];
  const Vec3d d = position.cast<double>() - facet.origin.cast<double>();
  const auto along = [&](const Vec3f& axis, std::uint32_t cell) {
    const double t = std::ldexp(d.dot(axis.cast<double>()), layout.element_level[element]) - cell;
    return static_cast<float>(std::clamp(t, 0.0, 1.0));
  };
  const float x = along(facet.axis_u, layout.element_x[element]);
  const float y = along(facet.axis_v, layout.element_y[element]);
  return {(1.0f - x) * (1.0f - y), x * (1.0f - y), (1.0f - x) * y, x * y};
}

}  // namespace atrium::radiosity
