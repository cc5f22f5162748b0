#include "scene/solution_io.h"

#include <bit>
#include <cstring>
#include <fstream>
#include <type_traits>

#include "hash64.h"
#include "material/error.h"
#include "scene/output_file.h"

namespace atrium::scene {
namespace fs = std::filesystem;

namespace {

static_assert(std::endian::native == std::endian::little, "solution files are little endian");

constexpr char kMagic[8] = {'A', 'T', 'R', 'I', 'U', 'M', 'S', 'F'};
constexpr std::uint32_t kVersion = 2;

/// Appends values; vectors with their length.
class Writer {
 public:
  template <class T>
  void operator()(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&v, sizeof v);
  }
  template <class T>
  void operator()(const std::vector<T>& v) {
    static_assert(std::is_arithmetic_v<T>);
    (*this)(static_cast<std::uint64_t>(v.size()));
    raw(v.data(), v.size() * sizeof(T));
  }
  void operator()(const std::string& s) {
    (*this)(static_cast<std::uint64_t>(s.size()));
    raw(s.data(), s.size());
  }
  void raw(const void* data, std::size_t size) {
    const char* p = static_cast<const char*>(data);
    bytes.insert(bytes.end(), p, p + size);
  }
  std::vector<char> bytes;
};

/// Takes values off; nothing is allocated that the file does not contain.
class Reader {
 public:
  Reader(const char* begin, const char* end, std::string name)
      : at_(begin), end_(end), name_(std::move(name)) {}
  template <class T>
  void operator()(T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&v, sizeof v);
  }
  template <class T>
  void operator()(std::vector<T>& v) {
    v.resize(count(sizeof(T)));
    raw(v.data(), v.size() * sizeof(T));
  }
  void operator()(std::string& s) {
    s.resize(count(1));
    raw(s.data(), s.size());
  }
  [[nodiscard]] std::size_t count(std::size_t item_size) {
    std::uint64_t n = 0;
    (*this)(n);
    if (n > static_cast<std::uint64_t>(end_ - at_) / item_size) damaged();
    return static_cast<std::size_t>(n);
  }
  [[noreturn]] void damaged() const { throw Error(name_ + ": is damaged"); }

 private:
  void raw(void* data, std::size_t size) {
    if (size > static_cast<std::size_t>(end_ - at_)) damaged();
    if (size != 0) std::memcpy(data, at_, size);
    at_ += size;
  }
  const char* at_;
  const char* end_;
  std::string name_;
};

template <class Archive, class Facet>
void facet(Archive& a, Facet& f) {
  for (int i = 0; i < 3; ++i) a(f.origin[i]);
  for (int i = 0; i < 3; ++i) a(f.axis_u[i]);
  for (int i = 0; i < 3; ++i) a(f.axis_v[i]);
  a(f.nx);
  a(f.ny);
  a(f.first_cell);
}
void facets(Writer& a, const std::vector<SurfaceField::Facet>& v) {
  a(static_cast<std::uint64_t>(v.size()));
  for (const SurfaceField::Facet& f : v) facet(a, f);
}
void facets(Reader& a, std::vector<SurfaceField::Facet>& v) {
  v.resize(a.count(12 * sizeof(float)));
  for (SurfaceField::Facet& f : v) facet(a, f);
}

template <class Archive, class Cut>
void cut(Archive& a, Cut& c) {
  for (int i = 0; i < 3; ++i) a(c.point[i]);
  for (int i = 0; i < 3; ++i) a(c.normal[i]);
  for (auto& child : c.child) a(child);
}
void cuts(Writer& a, const std::vector<SurfaceField::Cut>& v) {
  a(static_cast<std::uint64_t>(v.size()));
  for (const SurfaceField::Cut& c : v) cut(a, c);
}
void cuts(Reader& a, std::vector<SurfaceField::Cut>& v) {
  v.resize(a.count(8 * sizeof(float)));
  for (SurfaceField::Cut& c : v) cut(a, c);
}

/// One list of members for both directions. The binding stops compiling when a member is added.
template <class Archive, class Field>
void field(Archive& a, Field& f) {
  auto& [lanes, list, cell_element, triangle_facet, cut_list, element_facet, element_cell,
         element_area, irradiance, body_irradiance, standard_error, valid, unit] = f;
  a(lanes);
  facets(a, list);
  a(cell_element);
  a(triangle_facet);
  cuts(a, cut_list);
  a(element_facet);
  a(element_cell);
  a(element_area);
  for (auto* q : {&irradiance, &body_irradiance}) {
    a(q->direct);
    a(q->caustic);
    a(q->indirect);
  }
  a(standard_error);
  a(valid);
  a(unit);
}

bool all_below(const std::vector<std::uint32_t>& v, std::size_t limit) {
  return std::all_of(v.begin(), v.end(),
                     [&](std::uint32_t i) { return i < limit || i == SurfaceField::kNone; });
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
  bool ok = (f.lanes == 1 || f.lanes == 3 || f.lanes == 4 || f.lanes == 8) &&
            f.element_cell.size() == n && f.element_area.size() == n &&
            all_below(f.cell_element, n) && cuts_consistent(f) &&
            all_below(f.element_facet, f.facets.size());
  for (const SurfaceField::Facet& facet : f.facets) {
    const std::uint64_t cells = std::uint64_t{facet.nx} * facet.ny;
    ok = ok && facet.first_cell + cells <= f.cell_element.size();
  }
  const std::size_t values = n * 2 * static_cast<std::size_t>(std::max(f.lanes, 0));
  for (const SurfaceField::Quantities* q : {&f.irradiance, &f.body_irradiance}) {
    ok = ok && sized(q->direct, values) && sized(q->caustic, values) && sized(q->indirect, values);
  }
  return ok && sized(f.standard_error, n * 2) && (f.valid.empty() || f.valid.size() == n * 2);
}

std::uint64_t checksum(const char* data, std::size_t size) {
  Hash64 h;
  h.bytes(data, size);
  return h.result();
}

std::vector<char> read_all(const fs::path& file) {
  std::error_code ec;
  if (fs::is_directory(file, ec)) throw Error(file.string() + ": cannot be read: is a folder");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

void write_solution(const Solution& solution, const fs::path& file) {
  Writer w;
  w.raw(kMagic, sizeof kMagic);
  w(kVersion);
  w(solution.scene_hash);
  w(solution.basis);
  w(solution.options);
  field(w, solution.field);
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
  const std::vector<char> bytes = read_all(file);
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
  Reader r(bytes.data() + kHead, bytes.data() + size, name);
  r(solution.scene_hash);
  r(solution.basis);
  r(solution.options);
  field(r, solution.field);
  if (!consistent(solution.field)) throw Error(name + ": is damaged");
  return solution;
}

void check_solution(const Solution& solution, const Scene& scene, const std::string& basis,
                    const fs::path& file) {
  if (solution.scene_hash != hash_scene(scene) ||
      solution.field.triangle_facet.size() != scene.triangle_count()) {
    throw Error(file.string() + ": was solved for another scene (files or options that change it)");
  }
  if (solution.basis != basis) {
    throw Error(file.string() + ": was solved with " + solution.basis + ", this run uses " + basis);
  }
}

}  // namespace atrium::scene
