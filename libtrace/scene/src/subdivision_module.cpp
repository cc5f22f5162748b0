// The only code that sees OpenSubdiv; a module of its own because linking that library costs every
// program start over a million instructions.
#include "subdivision_module.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/bfr/tessellation.h>
#include <opensubdiv/far/error.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include "module.h"

namespace atrium::scene {
namespace {

namespace osd = OpenSubdiv;
using Surface = osd::Bfr::Surface<double>;
using Refiner = osd::Far::TopologyRefiner;

constexpr int kMaxRate = 64;
constexpr std::size_t kMaxTriangles = 8'000'000;

// OpenSubdiv reports to stderr unless told otherwise; failures come back as null pointers.
void silence_opensubdiv() {
  static const bool once = [] {
    osd::Far::SetErrorCallback([](osd::Far::ErrorType, const char*) {});
    osd::Far::SetWarningCallback([](const char*) {});
    return true;
  }();
  (void)once;
}

std::unique_ptr<Refiner> make_refiner(const MeshData& mesh) {
  const SubdivisionCage& cage = *mesh.cage;
  const std::vector<int> sizes(cage.face_sizes.begin(), cage.face_sizes.end());
  const std::vector<int> indices(cage.face_indices.begin(), cage.face_indices.end());
  std::vector<int> crease_points;
  std::vector<float> crease_weights;
  for (const SubdivisionCage::Crease& crease : cage.creases) {
    crease_points.insert(crease_points.end(),
                         {static_cast<int>(crease.a), static_cast<int>(crease.b)});
    crease_weights.push_back(std::min(crease.sharpness, osd::Sdc::Crease::SHARPNESS_INFINITE));
  }
  osd::Far::TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(mesh.positions.size());
  descriptor.numFaces = static_cast<int>(sizes.size());
  descriptor.numVertsPerFace = sizes.data();
  descriptor.vertIndicesPerFace = indices.data();
  descriptor.numCreases = static_cast<int>(crease_weights.size());
  descriptor.creaseVertexIndexPairs = crease_points.data();
  descriptor.creaseWeights = crease_weights.data();

  osd::Sdc::Options rules;
  rules.SetVtxBoundaryInterpolation(cage.sharp_boundary
                                        ? osd::Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER
                                        : osd::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
  using Factory = osd::Far::TopologyRefinerFactory<osd::Far::TopologyDescriptor>;
  const auto scheme = cage.scheme == SubdivisionCage::Scheme::Loop ? osd::Sdc::SCHEME_LOOP
                                                                   : osd::Sdc::SCHEME_CATMARK;
  std::unique_ptr<Refiner> refiner(Factory::Create(descriptor, Factory::Options(scheme, rules)));
  if (!refiner) throw std::runtime_error("its faces do not form a surface");
  return refiner;
}

// Limit surface of one face after the other; keeps its work space.
class FaceSurface {
 public:
  FaceSurface(const Refiner& refiner, const MeshData& mesh) : mesh_(mesh), factory_(refiner, {}) {
    for (const Vec3d& p : mesh.positions) points_.insert(points_.end(), {p.x(), p.y(), p.z()});
    for (std::size_t i = 0; i < mesh.positions.size() && has_extra(); ++i) {
      const Vec2f uv = mesh.uvs.empty() ? Vec2f(0.0f, 0.0f) : mesh.uvs[i];
      const Vec3f color = mesh.colors.empty() ? Vec3f(1.0f, 1.0f, 1.0f) : mesh.colors[i];
      for (const float v : {uv.x(), uv.y(), color.x(), color.y(), color.z()}) extra_.push_back(v);
    }
  }

  [[nodiscard]] bool has_extra() const { return !mesh_.uvs.empty() || !mesh_.colors.empty(); }

  bool select(int face) {
    if (!factory_.InitVertexSurface(face, &surface_)) return false;
    patch_points_.resize(3 * static_cast<std::size_t>(surface_.GetNumPatchPoints()));
    surface_.PreparePatchPoints(points_.data(), 3, patch_points_.data(), 3);
    if (has_extra()) {
      if (!factory_.InitVaryingSurface(face, &linear_)) return false;
      linear_points_.resize(5 * static_cast<std::size_t>(linear_.GetNumPatchPoints()));
      linear_.PreparePatchPoints(extra_.data(), 5, linear_points_.data(), 5);
    }
    return true;
  }

  [[nodiscard]] osd::Bfr::Parameterization parameterization() const {
    return surface_.GetParameterization();
  }
  [[nodiscard]] Vec3d position(const Vec2d& uv) const {
    Vec3d p;
    surface_.Evaluate(uv.data(), patch_points_.data(), 3, p.data());
    return p;
  }
  /// Normal of the limit surface, unit; zero where it has none.
  [[nodiscard]] Vec3d normal(const Vec2d& uv) const {
    Vec3d p, du, dv;
    surface_.Evaluate(uv.data(), patch_points_.data(), 3, p.data(), du.data(), dv.data());
    const Vec3d n = du.cross(dv);
    const double length = n.norm();
    // Parallel or vanishing tangents leave only rounding errors in the product.
    if (!(length > 1e-10 * (du.squaredNorm() + dv.squaredNorm()))) return Vec3d::Zero();
    return n / length;
  }
  [[nodiscard]] std::array<double, 5> extra(const Vec2d& uv) const {
    std::array<double, 5> values{};
    linear_.Evaluate(uv.data(), linear_points_.data(), 5, values.data());
    return values;
  }

 private:
  const MeshData& mesh_;
  osd::Bfr::RefinerSurfaceFactory<> factory_;
  std::vector<double> points_, extra_;
  Surface surface_, linear_;
  std::vector<double> patch_points_, linear_points_;
};

// The length that a chord error at a world position is compared with.
class Tolerance {
 public:
  Tolerance(const MeshData& mesh, double max_error, const Eigen::Affine3d& to_world,
            const std::optional<Camera>& view)
      : max_error_(max_error), to_world_(to_world) {
    if (view && view->kind == Camera::Kind::Orthographic) {
      fixed_ = view->height;
    } else if (view) {
      eye_ = view->to_scene.translation();
    } else {
      Bounds bounds;
      for (const Vec3d& p : mesh.positions) bounds.extend(to_world * p);
      fixed_ = bounds.diagonal().norm();
    }
  }
  /// Share of the tolerance that a deviation at a (local) place uses up; at most 1 is good.
  [[nodiscard]] double used(const Vec3d& place, const Vec3d& deviation) const {
    const double distance = eye_ ? (to_world_ * place - *eye_).norm() : fixed_;
    return (to_world_.linear() * deviation).norm() /
           std::max(max_error_ * distance, std::numeric_limits<double>::min());
  }

 private:
  double max_error_;
  Eigen::Affine3d to_world_;
  std::optional<Vec3d> eye_;
  double fixed_ = 1.0;
};

// Largest share of the tolerance used by a grid of `rate` cells per side over one quadrilateral
// piece of a face (or a triangle): chords against the surface at cell centres and edge middles.
template <class Place>
double grid_error(int rate, bool triangle, const Tolerance& tolerance, const Place& place) {
  const int fine = 2 * rate;
  const std::size_t stride = static_cast<std::size_t>(fine) + 1;
  std::vector<Vec3d> grid(stride * stride, Vec3d::Zero());
  const auto at = [&](int i, int j) -> Vec3d& {
    return grid[static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i)];
  };
  for (int j = 0; j <= fine; ++j) {
    for (int i = 0; i <= (triangle ? fine - j : fine); ++i) {
      at(i, j) = place(Vec2d(double(i) / fine, double(j) / fine));
    }
  }
  double worst = 0.0;
  const auto check = [&](int i0, int j0, int i1, int j1) {
    const Vec3d& middle = at((i0 + i1) / 2, (j0 + j1) / 2);
    worst = std::max(worst, tolerance.used(middle, 0.5 * (at(i0, j0) + at(i1, j1)) - middle));
  };
  for (int j = 0; j <= fine; j += 2) {
    for (int i = 0; i <= (triangle ? fine - j : fine); i += 2) {
      const bool right = triangle ? i + 2 + j <= fine : i + 2 <= fine;
      const bool up = triangle ? i + j + 2 <= fine : j + 2 <= fine;
      if (right) check(i, j, i + 2, j);
      if (up) check(i, j, i, j + 2);
      if (right && up) check(i + 2, j, i, j + 2);
      if (right && up && !triangle) check(i, j, i + 2, j + 2);
    }
  }
  return worst;
}

double face_error(const FaceSurface& surface, int rate, const Tolerance& tolerance) {
  const osd::Bfr::Parameterization parameterization = surface.parameterization();
  const bool triangle = parameterization.GetType() == osd::Bfr::Parameterization::TRI;
  if (!parameterization.HasSubFaces()) {
    return grid_error(rate, triangle, tolerance,
                      [&](const Vec2d& uv) { return surface.position(uv); });
  }
  double worst = 0.0;  // an n-gon is n quadrilaterals, each half as wide as the face
  for (int piece = 0; piece < parameterization.GetFaceSize(); ++piece) {
    worst = std::max(worst, grid_error(std::max(1, rate / 2), false, tolerance, [&](Vec2d local) {
                       Vec2d uv;
                       local = 0.5 * local;  // sub-faces are half a unit wide
                       parameterization.ConvertSubFaceToCoord(piece, local.data(), uv.data());
                       return surface.position(uv);
                     }));
  }
  return worst;
}

// Doubling; a rate must hold at twice the rate too, because a chord can cut an S in its middle.
int face_rate(const FaceSurface& surface, const Tolerance& tolerance) {
  for (int rate = 1; rate < kMaxRate; rate *= 2) {
    if (face_error(surface, rate, tolerance) <= 1.0 &&
        face_error(surface, 2 * rate, tolerance) <= 1.0) {
      return rate;
    }
  }
  return kMaxRate;
}

struct Rates {
  std::vector<int> face;  // 0: no limit surface
  std::vector<int> edge;  // the larger of the two faces'
};

Rates choose_rates(const Refiner& refiner, FaceSurface& surface, const Tolerance& tolerance) {
  const osd::Far::TopologyLevel& level = refiner.GetLevel(0);
  Rates rates;
  std::size_t triangles = 0;
  for (int f = 0; f < level.GetNumFaces(); ++f) {
    const int rate = surface.select(f) ? face_rate(surface, tolerance) : 0;
    rates.face.push_back(rate);
    triangles += static_cast<std::size_t>(level.GetFaceVertices(f).size()) *
                 static_cast<std::size_t>(rate * rate) / 2;
  }
  for (; triangles > kMaxTriangles; triangles /= 4) {
    const int largest = *std::max_element(rates.face.begin(), rates.face.end());
    if (largest <= 1) break;
    for (int& rate : rates.face) rate = rate == 0 ? 0 : std::max(1, rate / 2);
  }
  rates.edge.assign(static_cast<std::size_t>(level.GetNumEdges()), 1);
  for (int f = 0; f < level.GetNumFaces(); ++f) {
    const osd::Far::ConstIndexArray edges = level.GetFaceEdges(f);
    for (int i = 0; i < edges.size(); ++i) {
      int& rate = rates.edge[static_cast<std::size_t>(edges[i])];
      rate = std::max(rate, rates.face[static_cast<std::size_t>(f)]);
    }
  }
  return rates;
}

// Collects the triangles of all faces; points on shared edges are made once.
class LimitMesh {
 public:
  LimitMesh(const Refiner& refiner, FaceSurface& surface, const MeshData& cage)
      : level_(refiner.GetLevel(0)), surface_(surface), cage_(cage) {
    mesh_.name = cage.name;
  }

  void add_face(int face, const Rates& rates) {
    const std::vector<int> face_rates = rates_of(face, rates);
    const osd::Bfr::Tessellation pattern(surface_.parameterization(),
                                         static_cast<int>(face_rates.size()), face_rates.data());
    if (!pattern.IsValid()) throw std::runtime_error("a face cannot be tessellated");
    std::vector<double> coords(2 * static_cast<std::size_t>(pattern.GetNumCoords()));
    pattern.GetCoords(coords.data());
    std::vector<int> facets(3 * static_cast<std::size_t>(pattern.GetNumFacets()));
    pattern.GetFacets(facets.data());

    const std::vector<std::uint64_t> keys = boundary_keys(face, rates);
    std::vector<std::uint32_t> points;
    for (std::size_t i = 0; i < coords.size() / 2; ++i) {
      const Vec2d uv(coords[2 * i], coords[2 * i + 1]);
      points.push_back(i < keys.size() ? shared_point(keys[i], uv) : new_point(uv));
    }
    for (std::size_t t = 0; t < facets.size(); t += 3) {
      const auto corner = [&](std::size_t k) {
        return points[static_cast<std::size_t>(facets[k])];
      };
      mesh_.triangles.push_back({corner(t), corner(t + 1), corner(t + 2)});
    }
  }

  MeshData finish() {
    fill_missing_normals();
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::vector<int> rates_of(int face, const Rates& rates) const {
    const osd::Far::ConstIndexArray edges = level_.GetFaceEdges(face);
    std::vector<int> result;
    result.reserve(static_cast<std::size_t>(edges.size()) + 2);
    for (int i = 0; i < edges.size(); ++i) {
      result.push_back(rates.edge[static_cast<std::size_t>(edges[i])]);
    }
    const int finest = *std::max_element(result.begin(), result.end());
    const int inner = std::max(rates.face[static_cast<std::size_t>(face)], finest > 1 ? 2 : 1);
    result.push_back(inner);
    if (edges.size() == 4) result.push_back(inner);
    return result;
  }

  // Names of the pattern's boundary points, which come first: corner 0, edge 0, corner 1, ...
  [[nodiscard]] std::vector<std::uint64_t> boundary_keys(int face, const Rates& rates) const {
    std::vector<std::uint64_t> keys;
    const osd::Far::ConstIndexArray corners = level_.GetFaceVertices(face);
    const osd::Far::ConstIndexArray edges = level_.GetFaceEdges(face);
    constexpr std::uint64_t edge_bit = 1ull << 63;
    for (int i = 0; i < corners.size(); ++i) {
      keys.push_back(static_cast<std::uint64_t>(corners[i]));
      const int rate = rates.edge[static_cast<std::size_t>(edges[i])];
      const bool forward = level_.GetEdgeVertices(edges[i])[0] == corners[i];
      for (int k = 1; k < rate; ++k) {
        keys.push_back(edge_bit | static_cast<std::uint64_t>(edges[i]) << 8 |
                       static_cast<std::uint64_t>(forward ? k : rate - k));
      }
    }
    return keys;
  }

  std::uint32_t new_point(const Vec2d& uv) {
    return append(surface_.position(uv), surface_.normal(uv).cast<float>(), uv);
  }

  // The first face to come decides the position; each side of a crease keeps its own normal.
  std::uint32_t shared_point(std::uint64_t key, const Vec2d& uv) {
    std::vector<std::uint32_t>& known = shared_[key];
    const Vec3f normal = surface_.normal(uv).cast<float>();
    constexpr float same_side = 0.9999f;
    for (const std::uint32_t index : known) {
      const Vec3f& other = mesh_.normals[index];
      if (normal.dot(other) > same_side || normal.isZero() || other.isZero()) return index;
    }
    const Vec3d position = known.empty() ? surface_.position(uv) : mesh_.positions[known.front()];
    const std::uint32_t index = append(position, normal, uv);
    known.push_back(index);
    return index;
  }

  std::uint32_t append(const Vec3d& position, const Vec3f& normal, const Vec2d& uv) {
    mesh_.positions.push_back(position);
    mesh_.normals.push_back(normal);
    if (surface_.has_extra()) {
      const std::array<double, 5> e = surface_.extra(uv);
      const auto f = [&](std::size_t i) { return static_cast<float>(e[i]); };
      if (!cage_.uvs.empty()) mesh_.uvs.emplace_back(f(0), f(1));
      if (!cage_.colors.empty()) mesh_.colors.emplace_back(f(2), f(3), f(4));
    }
    return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
  }

  // Where the surface has no tangent plane: the mean of the triangles around.
  void fill_missing_normals() {
    std::unordered_map<std::uint32_t, Vec3d> sums;
    for (const Triangle& t : mesh_.triangles) {
      for (const std::uint32_t corner : t) {
        if (!mesh_.normals[corner].isZero()) continue;
        const Vec3d& a = mesh_.positions[t[0]];
        const Vec3d area = (mesh_.positions[t[1]] - a).cross(mesh_.positions[t[2]] - a);
        sums.try_emplace(corner, Vec3d::Zero()).first->second += area;
      }
    }
    for (const auto& [corner, sum] : sums) {
      const double length = sum.norm();
      mesh_.normals[corner] =
          length > 0.0 ? Vec3d(sum / length).cast<float>().eval() : Vec3f(0.0f, 1.0f, 0.0f);
    }
  }

  const osd::Far::TopologyLevel& level_;
  FaceSurface& surface_;
  const MeshData& cage_;
  MeshData mesh_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> shared_;
};

MeshData tessellate_cage(const MeshData& cage_mesh, const Tolerance& tolerance) {
  silence_opensubdiv();
  const std::unique_ptr<Refiner> refiner = make_refiner(cage_mesh);
  FaceSurface surface(*refiner, cage_mesh);
  const Rates rates = choose_rates(*refiner, surface, tolerance);
  LimitMesh mesh(*refiner, surface, cage_mesh);
  for (int f = 0; f < refiner->GetLevel(0).GetNumFaces(); ++f) {
    if (rates.face[static_cast<std::size_t>(f)] == 0) continue;
    if (surface.select(f)) mesh.add_face(f, rates);
  }
  return mesh.finish();
}

class OpenSubdivModule final : public SubdivisionModule {
 public:
  // Rates follow curvature and distance face by face, with one rate per shared edge, so neighbours
  // meet without cracks: boundary positions are equal to the last bit. Corners on a sharp crease
  // appear once per side, with that side's normal. A parallel view has no distance: its height
  // counts. Rates stop at 64 per edge, and lower where a mesh would exceed 8 million triangles.
  std::string tessellate(const MeshData& cage_mesh, double max_error,
                         const Eigen::Affine3d& to_world, const std::optional<Camera>& view,
                         MeshData& mesh) const override try {
    mesh = tessellate_cage(cage_mesh, Tolerance(cage_mesh, max_error, to_world, view));
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
};

}  // namespace
}  // namespace atrium::scene

extern "C" __attribute__((visibility("default"))) const atrium::scene::SubdivisionModule*
atrium_subdivision(int interface_version) {
  static const atrium::scene::OpenSubdivModule module;
  return interface_version == atrium::scene::kModuleInterface ? &module : nullptr;
}
