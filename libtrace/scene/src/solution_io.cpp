#include "scene/solution_io.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <span>

#include "hash64.h"
#include "import_util.h"
#include "material/error.h"
#include "scene/archive.h"
#include "scene/output_file.h"

namespace atrium::scene {
namespace fs = std::filesystem;

namespace {

constexpr char kMagic[8] = {'A', 'T', 'R', 'I', 'U', 'M', 'S', 'F'};
constexpr std::uint32_t kVersion = 4;

template <class Archive, class Facet>
void facet(Archive& a, Facet& f) {
  for (int i = 0; i < 3; ++i) a(f.origin[i]);
  for (int i = 0; i < 3; ++i) a(f.axis_u[i]);
  for (int i = 0; i < 3; ++i) a(f.axis_v[i]);
  a(f.nx);
  a(f.ny);
  a(f.first_cell);
  a(f.clump);
}
void facets(ArchiveWriter& a, const std::vector<SurfaceField::Facet>& v) {
  a(static_cast<std::uint64_t>(v.size()));
  for (const SurfaceField::Facet& f : v) facet(a, f);
}
void facets(ArchiveReader& a, std::vector<SurfaceField::Facet>& v) {
  v.resize(a.count(12 * sizeof(float) + 1));
  for (SurfaceField::Facet& f : v) facet(a, f);
}

template <class Archive, class Cut>
void cut(Archive& a, Cut& c) {
  for (int i = 0; i < 3; ++i) a(c.point[i]);
  for (int i = 0; i < 3; ++i) a(c.normal[i]);
  for (auto& child : c.child) a(child);
}
void cuts(ArchiveWriter& a, const std::vector<SurfaceField::Cut>& v) {
  a(static_cast<std::uint64_t>(v.size()));
  for (const SurfaceField::Cut& c : v) cut(a, c);
}
void cuts(ArchiveReader& a, std::vector<SurfaceField::Cut>& v) {
  v.resize(a.count(8 * sizeof(float)));
  for (SurfaceField::Cut& c : v) cut(a, c);
}

template <class Archive, class Quantities>
void quantities(Archive& a, Quantities& q) {
  a(q.direct);
  a(q.caustic);
  a(q.indirect);
}

template <class Archive, class Group>
void group(Archive& a, Group& g) {
  auto& [name, factor, irradiance, body_irradiance, light_error, indirect_error] = g;
  a(name);
  a(factor);
  quantities(a, irradiance);
  quantities(a, body_irradiance);
  a(light_error);
  a(indirect_error);
}
void groups(ArchiveWriter& a, const std::vector<GroupField>& v) {
  a(static_cast<std::uint64_t>(v.size()));
  for (const GroupField& g : v) group(a, g);
}
void groups(ArchiveReader& a, std::vector<GroupField>& v) {
  v.resize(a.count(10 * sizeof(std::uint64_t)));
  for (GroupField& g : v) group(a, g);
}

/// One list of members for both directions. The binding stops compiling when a member is added.
template <class Archive, class Field>
void field(Archive& a, Field& f) {
  auto& [lanes, list, nodes, triangle_facet, cut_list, element_facet, element_level, element_x,
         element_y, element_area, irradiance, body_irradiance, standard_error, valid, unit] = f;
  a(lanes);
  facets(a, list);
  a(nodes);
  a(triangle_facet);
  cuts(a, cut_list);
  a(element_facet);
  a(element_level);
  a(element_x);
  a(element_y);
  a(element_area);
  quantities(a, irradiance);
  quantities(a, body_irradiance);
  a(standard_error);
  a(valid);
  a(unit);
}

/// The grids lie in the array, and behind them every block of children has one parent, in front of
/// it, so walks down end.
bool nodes_consistent(const SurfaceField& f) {
  std::uint64_t blocks_begin = 0;
  for (const SurfaceField::Facet& facet : f.facets) {
    if (!facet.origin.allFinite() || !facet.axis_u.allFinite() || !facet.axis_v.allFinite())
      return false;
    if (facet.nx == 0 || facet.ny == 0 || facet.nx > 1U << 16 || facet.ny > 1U << 16) return false;
    blocks_begin = std::max(blocks_begin, facet.first_cell + std::uint64_t{facet.nx} * facet.ny);
  }
  if (blocks_begin > f.nodes.size() || (f.nodes.size() - blocks_begin) % 4 != 0) return false;
  std::vector<int> level((f.nodes.size() - blocks_begin) / 4,
                         -1);  // of the blocks; -1: no parent yet
  for (std::size_t i = 0; i < f.nodes.size(); ++i) {
    const std::uint32_t node = f.nodes[i];
    if (!SurfaceField::is_inner(node)) {
      if (node != SurfaceField::kNone && node >= f.element_count()) return false;
      continue;
    }
    const std::uint64_t first = node & ~SurfaceField::kInner;
    if (first <= i || first < blocks_begin || first >= f.nodes.size()) return false;
    if ((first - blocks_begin) % 4 != 0) return false;
    const int own = i < blocks_begin ? 0 : level[(i - blocks_begin) / 4];
    int& below = level[(first - blocks_begin) / 4];
    if (own < 0 || below >= 0 || own >= SurfaceField::kMaxLevel) return false;
    below = own + 1;
  }
  return true;
}

/// Every element is the leaf at its own place.
bool elements_consistent(const SurfaceField& f) {
  const std::size_t n = f.element_count();
  if (f.element_level.size() != n || f.element_x.size() != n || f.element_y.size() != n ||
      f.element_area.size() != n)
    return false;
  for (std::uint32_t e = 0; e < n; ++e) {
    const int level = f.element_level[e];
    if (f.element_facet[e] >= f.facets.size() || level > SurfaceField::kMaxLevel ||
        !(f.element_area[e] > 0.0f))
      return false;
    const SurfaceField::Cell cell =
        f.cell(f.facets[f.element_facet[e]], level, f.element_x[e], f.element_y[e]);
    if (cell.node != e || cell.level != level) return false;
  }
  return true;
}

/// Triangles lead to facets, cuts to facets or to cuts behind themselves: every walk ends.
bool cuts_consistent(const SurfaceField& f) {
  const auto leads_on = [&](std::uint32_t i, std::size_t from) {
    if (SurfaceField::is_cut(i)) {
      const std::uint32_t cut = i & ~SurfaceField::kCut;
      return cut >= from && cut < f.cuts.size();
    }
    return i == SurfaceField::kNone || i < f.facets.size();
  };
  for (const std::uint32_t i : f.triangle_facet)
    if (!leads_on(i, 0)) return false;
  for (std::size_t k = 0; k < f.cuts.size(); ++k)
    for (const std::uint32_t child : f.cuts[k].child)
      if (!leads_on(child, k + 1)) return false;
  return true;
}

/// Look-ups index without checks, so every index is checked here.
bool consistent(const SurfaceField& f) {
  const std::size_t n = f.element_count();
  const auto sized = [&](const std::vector<float>& v, std::size_t size) {
    return v.empty() || v.size() == size;
  };
  bool ok = (f.lanes == 1 || f.lanes == 3 || f.lanes == 4 || f.lanes == 8) && cuts_consistent(f) &&
            nodes_consistent(f) && elements_consistent(f);
  const std::size_t values = n * 2 * static_cast<std::size_t>(std::max(f.lanes, 0));
  for (const SurfaceField::Quantities* q : {&f.irradiance, &f.body_irradiance}) {
    ok = ok && sized(q->direct, values) && sized(q->caustic, values) && sized(q->indirect, values);
  }
  return ok && sized(f.standard_error, n * 2) && f.valid.size() == n * 2;
}

/// Groups are of the field's elements, and all of them can be told apart.
bool consistent(const std::vector<GroupField>& groups, const SurfaceField& f) {
  const std::size_t sides = f.element_count() * 2;
  const std::size_t values = sides * static_cast<std::size_t>(f.lanes);
  if (groups.size() > kMostLightGroups) return false;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const SurfaceField::Quantities* q : {&groups[g].irradiance, &groups[g].body_irradiance})
      for (const std::vector<float>* v : {&q->direct, &q->caustic, &q->indirect})
        if (!v->empty() && v->size() != values) return false;
    if (groups[g].light_error.size() != sides || groups[g].indirect_error.size() != sides ||
        !(groups[g].factor >= 0.0 && std::isfinite(groups[g].factor)))
      return false;
    for (std::size_t other = 0; other < g; ++other)
      if (groups[other].name == groups[g].name) return false;
  }
  return true;
}

std::uint64_t checksum(const char* data, std::size_t size) {
  Hash64 h;
  h.bytes(data, size);
  return h.result();
}

}  // namespace

void write_solution(const Solution& solution, const fs::path& file) {
  ArchiveWriter w;
  w.raw(kMagic, sizeof kMagic);
  w(kVersion);
  w(solution.scene_hash);
  w(solution.basis);
  w(solution.options);
  field(w, solution.field);
  groups(w, solution.groups);
  w(solution.state);
  const std::uint64_t sum = checksum(w.bytes.data(), w.bytes.size());
  w(sum);

  OutputFile output(file);
  std::ofstream out(output.path(), std::ios::binary);
  out.write(w.bytes.data(), static_cast<std::streamsize>(w.bytes.size()));
  out.close();
  if (!out) throw RuntimeFailure(file.string() + ": writing failed");
  output.commit();
}

Solution read_solution(const fs::path& file) {
  const std::vector<std::uint8_t> whole =
      read_file_bytes(file, std::numeric_limits<std::uintmax_t>::max());
  const std::span bytes(reinterpret_cast<const char*>(whole.data()), whole.size());
  const std::string name = file.string();
  constexpr std::size_t kHead = sizeof kMagic + sizeof kVersion;
  if (bytes.size() < kHead || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0) {
    throw Error(name + ": is no radiosity solution");
  }
  std::uint32_t version = 0;
  std::memcpy(&version, bytes.data() + sizeof kMagic, sizeof version);
  if (version != kVersion) {
    throw Error(name + ": has format version " + std::to_string(version) + "; this program reads " +
                std::to_string(kVersion));
  }
  std::uint64_t sum = 0;
  if (bytes.size() < kHead + sizeof sum) throw Error(name + ": is truncated or damaged");
  const std::size_t size = bytes.size() - sizeof sum;
  std::memcpy(&sum, bytes.data() + size, sizeof sum);
  if (sum != checksum(bytes.data(), size)) throw Error(name + ": is truncated or damaged");

  Solution solution;
  ArchiveReader r(bytes.data() + kHead, bytes.data() + size, name);
  r(solution.scene_hash);
  r(solution.basis);
  r(solution.options);
  field(r, solution.field);
  groups(r, solution.groups);
  r(solution.state);
  if (!consistent(solution.field) || !consistent(solution.groups, solution.field))
    throw Error(name + ": is damaged");
  return solution;
}

void dim(Solution& solution, const std::vector<std::pair<std::string, double>>& factors) {
  for (const auto& [name, factor] : factors) {
    std::string known;
    GroupField* found = nullptr;
    for (GroupField& g : solution.groups) {
      known += (known.empty() ? "'" : ", '") + g.name + "'";
      if (g.name == name) found = &g;
    }
    if (known.empty()) throw Error("the solution holds no light groups");
    if (found == nullptr) throw Error("no light group '" + name + "'; there are " + known);
    if (!(factor >= 0.0 && std::isfinite(factor)))
      throw Error("light group '" + name + "': a factor must be a number of at least 0");
    found->factor = factor;
  }
  if (solution.groups.empty()) return;
  std::vector<double> all;
  for (const GroupField& g : solution.groups) all.push_back(g.factor);
  solution.field = reweight(solution.field, solution.groups, all);
  solution.state = {};
}

void check_solution(const Solution& solution, const Scene& scene, const std::string& basis,
                    const fs::path& file, Dimmed dimmed) {
  if (solution.scene_hash != hash_scene(scene) ||
      solution.field.triangle_facet.size() != scene.triangle_count()) {
    throw Error(file.string() + ": was solved for another scene (files or options that change it)");
  }
  for (const GroupField& g : solution.groups) {
    if (g.factor != 1.0 && dimmed == Dimmed::Refused)
      throw Error(file.string() + ": light group '" + g.name +
                  "' is dimmed, the scene's lights are not");
  }
  if (solution.basis != basis) {
    throw Error(file.string() + ": was solved with " + solution.basis + ", this run uses " + basis);
  }
}

}  // namespace atrium::scene
