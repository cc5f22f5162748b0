#include <array>
#include <cmath>
#include <numbers>

#include "validation/convergence.h"
#include "validation/scene_kit.h"
#include "validation/solution.h"

namespace atrium::validation {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRho = 0.5;
constexpr int kTexels = 32;  // of emission along an edge
constexpr int kPoints = 12;  // of comparison along an edge

double radiosity_at(const Vec3d& p) {
  return 1.0 + 0.25 * std::sin(2.0 * p.x() + 0.5) * std::cos(1.7 * p.y() - 0.3 * p.z()) +
         0.15 * std::cos(2.3 * p.z() + 0.4);
}

struct Face {
  const char* name;
  Vec3d corner, u, v;  ///< u x v looks into the cube
  [[nodiscard]] Vec3d at(double s, double t) const { return corner + s * u + t * v; }
  [[nodiscard]] Vec3d normal() const { return u.cross(v); }
};
const std::array<Face, 6>& faces() {
  static const std::array<Face, 6> list{{{"x0", {0, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                         {"x1", {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                         {"y0", {0, 0, 0}, {0, 0, 1}, {1, 0, 0}},
                                         {"y1", {0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                         {"z0", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                         {"z1", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}}}};
  return list;
}

/// E = int B cos cos / (pi r^2) dA. As the kernel integrates to 1 in the cube, only B(q) - B(p) is
/// integrated, which is small where the kernel peaks: next to edges.
double irradiance_at(const Face& own, const Vec3d& p) {
  constexpr int kPanels = 8;
  constexpr std::size_t kNodes = 3 * std::size_t{kPanels};  // each way
  constexpr std::array<double, 3> kNode{0.1127016653792583, 0.5, 0.8872983346207417};
  constexpr std::array<double, 3> kWeight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const Vec3d n = own.normal();
  const double here = radiosity_at(p);
  double sum = 0.0;
  for (const Face& other : faces()) {
    if (&other == &own) continue;
    const Vec3d m = other.normal();
    for (std::size_t i = 0; i < kNodes; ++i)
      for (std::size_t j = 0; j < kNodes; ++j) {
        const std::size_t across = i / 3, along = j / 3;
        const Vec3d q = other.at((static_cast<double>(across) + kNode[i % 3]) / kPanels,
                                 (static_cast<double>(along) + kNode[j % 3]) / kPanels);
        const Vec3d d = q - p;
        const double r2 = d.squaredNorm();
        sum += kWeight[i % 3] * kWeight[j % 3] * (radiosity_at(q) - here) * n.dot(d) * -m.dot(d) /
               (r2 * r2);
      }
  }
  return here + sum / (kPi * kPanels * kPanels);
}

/// M / largest in 8 bits; what a pixel's rounding leaves goes to the next, so that means are right.
material::Texture emission(const Face& face, double largest) {
  material::Texture texture;
  texture.width = texture.height = kTexels;
  texture.channels = 1;
  texture.srgb = false;
  texture.wrap_u = texture.wrap_v = material::Texture::Wrap::Clamp;
  double carry = 0.0;
  for (int j = 0; j < kTexels; ++j)
    for (int i = 0; i < kTexels; ++i) {
      const Vec3d p = face.at((i + 0.5) / kTexels, (j + 0.5) / kTexels);
      const double m = radiosity_at(p) - kRho * irradiance_at(face, p);
      const double wanted = 255.0 * m / largest + carry;
      const double pixel = std::clamp(std::round(wanted), 0.0, 255.0);
      carry = wanted - pixel;
      texture.pixels.push_back(static_cast<std::uint8_t>(pixel));
    }
  return texture;
}

scene::Model manufactured_model() {
  constexpr double kLargest = 1.5;  // above every M
  SceneKit kit;
  for (const Face& face : faces()) {
    material::Material m;
    m.body_reflectance = kRho;
    m.emission = kLargest / kPi;
    m.emission_texture.texture = {static_cast<std::uint32_t>(kit.model().textures.size())};
    kit.model().textures.push_back(emission(face, kLargest));
    kit.polygon(face.name, kit.material(m),
                {face.at(0, 0), face.at(1, 0), face.at(1, 1), face.at(0, 1)});
    kit.model().meshes.back().uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  }
  return std::move(kit.model());
}

struct Comparison {
  Face face;
  std::uint32_t object, triangle;
  Vec3d point;
  double irradiance;
};
std::vector<Comparison> comparisons() {
  std::vector<Comparison> list;
  for (std::uint32_t f = 0; f < 6; ++f)
    for (int i = 0; i < kPoints; ++i)
      for (int j = 0; j < kPoints; ++j) {
        // Not symmetric to any grid.
        const double s = (i + 0.37) / kPoints, t = (j + 0.59) / kPoints;
        const Vec3d p = faces()[f].at(s, t);
        list.push_back({faces()[f], f, s >= t ? 0U : 1U, p, irradiance_at(faces()[f], p)});
      }
  return list;
}

/// Deviations of the field from the prescribed solution at the points.
struct Deviations {
  std::vector<double> constant, interpolated;
};
Deviations deviations(const scene::Model& model, const std::vector<Comparison>& points, int cells,
                      std::uint64_t seed) {
  const int samples = (1 << 20) / (6 * cells * cells);
  scene::BuildOptions as_is;
  as_is.pane_detection = false;
  as_is.repair = false;
  const Solution s(scene::build_scene(model, as_is), {.element_size = 1.0 / cells,
                                                      .max_level = 0,
                                                      .row_rays = samples / 8,
                                                      .gather_rays = samples,
                                                      .direct_samples = samples,
                                                      .seed = seed});
  const scene::SurfaceField& field = s.result().field;
  Deviations d;
  for (const Comparison& c : points) {
    const scene::ObjectId object(c.object);
    const Vec3f p = (c.point - s.scene().origin).cast<float>();
    const std::uint32_t element = field.element_at(s.scene(), object, c.triangle, p);
    d.constant.push_back(s.irradiance(element, Solution::Part::Total) - c.irradiance);
    const auto stencil = field.stencil(s.scene(), object, c.triangle, p, scene::Side::Front);
    double smooth = 0.0;
    for (const auto* array : {&field.irradiance.direct, &field.irradiance.indirect})
      smooth += static_cast<double>(field.interpolate<1>(*array, stencil, scene::Side::Front)[0]);
    d.interpolated.push_back(smooth - c.irradiance);
  }
  return d;
}

/// RMS of what two independent runs have in common: their noise averages out of the products.
double common_rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return std::sqrt(std::max(0.0, sum / static_cast<double>(a.size())));
}

}  // namespace

SizeCurves manufactured_against_size() {
  const scene::Model model = manufactured_model();
  const std::vector<Comparison> points = comparisons();
  SizeCurves curves{{"constant on elements", {}, {}}, {"interpolated", {}, {}}};
  for (const int cells : {2, 4, 8}) {
    const Deviations a = deviations(model, points, cells, 1),
                     b = deviations(model, points, cells, 2);
    curves.constant.x.push_back(1.0 / cells);
    curves.constant.error.push_back(common_rms(a.constant, b.constant));
    curves.interpolated.x.push_back(1.0 / cells);
    curves.interpolated.error.push_back(common_rms(a.interpolated, b.interpolated));
  }
  return curves;
}

}  // namespace atrium::validation
