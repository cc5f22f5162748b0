#include "stress/setting.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "trace/compare.h"

namespace atrium::stress {
namespace {

using material::Material;
using material::SpectralBasis;

constexpr double kRounding = 1e-6;  // of sums of float irradiance over thousands of elements

Material plastic() {
  Material m;
  m.combination = Material::Combination::Coupled;
  m.body_reflectance = 0.6;
  m.k_rg = 1.0;
  m.c = 8.0;
  return m;
}
Material mirror() {
  Material m;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  m.n = 0.2;
  m.kappa = 20.0;
  return m;
}
Material glass(Material::Medium medium) {
  Material m;
  m.medium = medium;
  m.k_df = 0.0;
  m.k_rg = m.k_tp_rg = 1.0;
  return m;
}

std::uint64_t count(const std::vector<float>& values) {
  return static_cast<std::uint64_t>(
      std::count_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); }));
}

}  // namespace

std::string text(double x) {
  char t[32];
  std::snprintf(t, sizeof t, "%.4g", x);
  return t;
}

scene::Camera look_at(const Vec3d& eye, const Vec3d& target, double yfov) {
  scene::Camera camera;
  const bool steep = std::abs((target - eye).normalized().z()) > 0.99;
  camera.to_scene = scene::look_at(eye, target, steep ? Vec3d::UnitY() : Vec3d::UnitZ());
  camera.yfov = yfov;
  return camera;
}

Setting furnished_room(double emission) {
  SceneKit kit;
  const auto white = kit.diffuse(0.6);
  kit.room({0, 0, 0}, {4, 3, 2.5}, white);
  kit.polygon("lamp", kit.diffuse(0.3, emission * M_PI),
              {{1.5, 1, 2.4}, {1.5, 2, 2.4}, {2.5, 2, 2.4}, {2.5, 1, 2.4}});
  kit.block("cupboard", white, {0.7, 0.8, 0}, {1.3, 1.7, 0.8});
  kit.block("wall", white, {2.9, -0.2, -0.2}, {3.0, 1.4, 2.1});
  kit.polygon("mirror", kit.material(mirror()),
              {{0.01, 0.5, 0.8}, {0.01, 2.0, 0.8}, {0.01, 2.0, 2.0}, {0.01, 0.5, 2.0}});
  kit.polygon("pane", kit.material(glass(Material::Medium::Pane)),
              {{1.6, 2.0, 0.1}, {2.6, 2.2, 0.1}, {2.6, 2.2, 1.6}, {1.6, 2.0, 1.6}});
  kit.block("glass", kit.material(glass(Material::Medium::Solid)), {1.6, 0.6, 0.01},
            {2.0, 1.0, 0.5});
  kit.block("plastic", kit.material(plastic()), {2.2, 1.2, 0.01}, {2.6, 1.6, 0.4});
  return {std::move(kit.model()), look_at({3.7, 2.7, 1.5}, {1.3, 1.0, 0.8}, 1.1), 1.0};
}

void move(Setting& setting, const Eigen::Affine3d& t) {
  const double scale = std::cbrt(t.linear().determinant());
  for (auto& node : setting.model.nodes) node.to_world = t * node.to_world;
  const auto moved = [&](const Eigen::Affine3d& frame) {
    Eigen::Affine3d f = t * frame;
    f.linear() /= scale;
    return f;
  };
  for (scene::Light& light : setting.model.lights) {
    light.to_scene = moved(light.to_scene);
    if (auto* point = std::get_if<scene::PointLight>(&light.kind))
      std::get<double>(point->intensity) *= scale * scale;
  }
  setting.camera.to_scene = moved(setting.camera.to_scene);
  setting.camera.height *= scale;
  setting.scale *= scale;
}

Trial::Trial(Setting setting, const scene::BuildOptions& options)
    : scene_(scene::build_scene(std::move(setting.model), options)),
      query_(scene_),
      camera_(std::move(setting.camera)),
      scale_(setting.scale) {
  camera_.to_scene.translation() -= scene_.origin;
}

const radiosity::SolveResult& Trial::solve(radiosity::SolveOptions options) {
  options.element_size *= scale_;
  solved_ = radiosity::solve(query_, SpectralBasis::grey(), options);
  return solved_;
}

trace::RenderResult Trial::picture(const trace::RenderOptions& options) const {
  return picture(camera_, options);
}

trace::RenderResult Trial::picture(const scene::Camera& camera,
                                   const trace::RenderOptions& options) const {
  const bool hybrid = options.method == trace::Method::Hybrid;
  return trace::render(query_, SpectralBasis::grey(), camera,
                       hybrid ? solved_.field : scene::SurfaceField{}, options);
}

double Trial::received() const {
  const scene::SurfaceField& f = solved_.field;
  double sum = 0.0;
  for (const auto* part : {&f.irradiance.direct, &f.irradiance.caustic, &f.irradiance.indirect})
    for (std::size_t i = 0; i < part->size(); ++i)
      if (f.valid[i] != 0)
        sum += static_cast<double>((*part)[i]) * static_cast<double>(f.element_area[i / 2]);
  return sum / (scale_ * scale_);
}

std::uint64_t count_not_finite(const radiosity::SolveResult& solved) {
  const scene::SurfaceField& f = solved.field;
  std::uint64_t sum = 0;
  for (const auto* q : {&f.irradiance, &f.body_irradiance})
    for (const auto* part : {&q->direct, &q->caustic, &q->indirect}) sum += count(*part);
  sum += count(f.standard_error) + count(f.element_area);
  for (const double x :
       {solved.flux.absorbed, solved.flux.emitted, solved.flux.escaped, solved.flux.in_medium,
        solved.flux.standard_error, solved.error_estimate, solved.mesh_error, solved.residual})
    sum += std::isfinite(x) ? 0U : 1U;
  return sum;
}

std::uint64_t count_not_finite(const trace::RenderResult& picture) {
  std::uint64_t sum = count(picture.image.pixels) +
                      picture.counters[scene::Counter::SamplesDropped] +
                      picture.counters[scene::Counter::RaysRefused];
  for (const double x :
       {picture.error_estimate, picture.bias_estimate, picture.block_error_estimate})
    sum += std::isfinite(x) ? 0U : 1U;
  return sum;
}

double imbalance(const radiosity::FluxBalance& f) {
  if (f.emitted == 0.0) return f.absorbed == 0.0 && f.escaped == 0.0 ? 0.0 : HUGE_VAL;
  return std::abs(f.emitted - f.absorbed - f.escaped - f.in_medium) /
         std::hypot(f.standard_error, kRounding * f.emitted);
}

namespace {

Outcome judge(const Trial& trial, double value, double expected) {
  const radiosity::FluxBalance& f = trial.solved().flux;
  Outcome o;
  o.deviation = std::abs(value / expected - 1.0);
  o.stated = 3.0 * std::hypot(f.standard_error / f.emitted, 10 * kRounding);
  o.imbalance = imbalance(f);
  o.not_finite = count_not_finite(trial.solved());
  return o;
}

}  // namespace

Outcome judge_flux(const Trial& trial, double expected) {
  return judge(trial, trial.received(), expected);
}

Outcome judge_absorbed(const Trial& trial, double expected) {
  return judge(trial, trial.solved().flux.absorbed, expected);
}

Outcome compare(const Trial& trial, const Trial& reference, double factor) {
  const radiosity::FluxBalance &a = trial.solved().flux, &b = reference.solved().flux;
  Outcome o = judge_flux(trial, reference.received() * factor);
  o.stated =
      3.0 * std::hypot(a.standard_error / a.emitted, b.standard_error / b.emitted, 10 * kRounding);
  return o;
}

Outcome compare(const trace::RenderResult& picture, const trace::RenderResult& reference,
                double field_error, double factor) {
  scene::Image image = picture.image;
  for (float& v : image.pixels) v = static_cast<float>(static_cast<double>(v) / factor);
  const scene::Image difference = trace::difference_image(image, reference.image);
  double sum = 0.0;
  for (const float e : difference.pixels) sum += std::pow(static_cast<double>(e), 2);
  Outcome o;
  o.deviation = std::sqrt(sum / static_cast<double>(difference.pixels.size()));
  o.stated = 1.5 * std::hypot(picture.error_estimate, reference.error_estimate, field_error);
  o.not_finite = count_not_finite(picture);
  return o;
}

Outcome judge_radiance(const trace::RenderResult& picture, double expected) {
  const scene::Image& image = picture.image;
  const int value = image.channel_index("G"), error = image.channel_index("stderr.G");
  double mean = 0.0, variance = 0.0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      mean += static_cast<double>(image.at(x, y, value));
      variance += std::pow(static_cast<double>(image.at(x, y, error)), 2);
    }
  const auto n = static_cast<double>(image.pixel_count());
  Outcome o;
  o.deviation = std::abs(mean / n / expected - 1.0);
  o.stated = 3.0 * std::sqrt(variance) / n / expected + 10 * kRounding;
  o.not_finite = count_not_finite(picture);
  return o;
}

}  // namespace atrium::stress
