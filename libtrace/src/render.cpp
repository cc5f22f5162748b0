#include "trace/render.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "material/error.h"
#include "scene/archive.h"
#include "trace/camera_window.h"
#include "trace/strategy.h"
#include "view_tracer.h"

namespace atrium::trace {
namespace {

/// Hands over a picture's state now and then.
class Saver {
 public:
  explicit Saver(const RenderOptions& options) : options_(options) {}
  [[nodiscard]] bool due() const {
    constexpr std::chrono::seconds kEvery(60);
    return options_.save_state && std::chrono::steady_clock::now() - last_ > kEvery;
  }
  void save(const std::vector<char>& state) {
    options_.save_state(state);
    last_ = std::chrono::steady_clock::now();
  }

 private:
  const RenderOptions& options_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

bool traces_from_lights(const scene::Scene& scene, const RenderOptions& o) {
  if (o.method != Method::Path || o.paths == PathKind::FromEye) return false;
  return o.paths == PathKind::BothEnds || choose_strategy(scene).from_lights;
}

/// Edge of a tile in the middle of the picture, at the camera [m] and by how much it grows.
std::array<float, 2> tile_edge(const scene::Camera& camera, const RenderOptions& o) {
  const double aspect = static_cast<double>(o.width) / static_cast<double>(o.height);
  const auto a = camera.ray(Vec2d(0.5, 0.5), aspect);
  const auto b = camera.ray(Vec2d(0.5, 0.5 + static_cast<double>(kTile) / o.height), aspect);
  return {(a.origin - b.origin).norm(), (a.direction - b.direction).norm()};
}

/// Of how many samples one checks the field. What checks say of a whole picture depends on their
/// number, and a small picture has few samples.
std::uint32_t check_every(const PixelWindow& window) {
  const double pixels = static_cast<double>(window.width) * window.height;
  return static_cast<std::uint32_t>(std::clamp(pixels / 2048.0, 8.0, 64.0));
}

template <int N>
RenderResult render_lanes(const scene::RayQuery& query, const material::SpectralBasis& basis,
                          const scene::Camera& camera, const scene::SurfaceField& field,
                          const RenderOptions& options, const scene::Control& control) {
  const scene::Shading<N> shading(query, basis);
  const bool gathers = options.method == Method::Hybrid && options.mode == Mode::Radiometric &&
                       options.indirect == Indirect::Gather;
  const scene::BrightSurfaces bright =
      gathers ? scene::BrightSurfaces(query.scene(), field) : scene::BrightSurfaces();
  const auto [tile_near, tile_angle] = tile_edge(camera, options);
  const View<N> view{shading, field, options, bright, tile_near, tile_angle};
  const Eye eye{camera, static_cast<double>(options.width) / static_cast<double>(options.height),
                options.width, options.height, pixel_window(options)};
  const PixelWindow& window = eye.window;
  const bool from_lights = traces_from_lights(query.scene(), options);
  // Blocks average already; sharing would add its bias and take hardly any noise.
  const bool blocks_only = options.block_error > 0.0 && !(options.error > 0.0);
  const bool shares = options.share_samples && options.method != Method::Path &&
                      options.mode == Mode::Radiometric && !blocks_only && !options.classes;
  const bool checks = (options.error > 0.0 || options.block_error > 0.0) && !field.empty() &&
                      options.method == Method::Hybrid && options.mode == Mode::Radiometric;
  Film film(window.width, window.height,
            {.components = options.components,
             .classes = options.classes,
             .shares = shares,
             .splats = from_lights,
             .checks = checks});
  ViewTracer<N> tracer(view, eye, from_lights, checks ? check_every(window) : 0, control);
  RoundState rounds;
  const auto archive = [&](auto& a) {
    const bool fits = film.archive(a) && tracer.archive(a);
    a(rounds.rounds);
    a(rounds.samples);
    return fits;
  };
  if (options.state != nullptr) {
    scene::ArchiveReader reader(
        options.state->data(), options.state->data() + options.state->size(), "state of a picture");
    if (!archive(reader) || rounds.samples.size() != tracer.cost().size()) reader.damaged();
    tracer.update_cost();
    tracer.limit(rounds.samples, static_cast<std::uint32_t>(options.samples));
  }
  Saver saver(options);
  const auto save = [&] {
    scene::ArchiveWriter writer;
    archive(writer);
    saver.save(writer.bytes);
  };
  RenderResult result;
  take_samples(
      film, window.width, window.height, options,
      [&](const std::vector<std::uint32_t>& samples, const PassProgress& progress) {
        if (saver.due()) save();
        return tracer.pass(samples, progress, film, result);
      },
      tracer.cost(), rounds, result);
  if (options.save_state) save();
  result.counters = tracer.counters();
  return result;
}

void check(const scene::SurfaceField& field, const material::SpectralBasis& basis,
           const RenderOptions& o) {
  if (o.width < 1 || o.height < 1 || o.width > 65536 || o.height > 65536)
    throw std::invalid_argument("render: width and height must be within 1..65536");
  if (o.samples < 1) throw std::invalid_argument("render: samples must be at least 1");
  if (!(o.error >= 0.0) || !(o.block_error >= 0.0))
    throw std::invalid_argument("render: an error asked for must not be negative");
  if (!field.empty() && field.lanes != basis.lanes())
    throw std::invalid_argument("render: the field was solved with another number of lanes");
  if (o.classes && (o.mode == Mode::Paper ||
                    (o.method == Method::Hybrid && !field.empty() && o.indirect == Indirect::Mesh)))
    throw std::invalid_argument("render: the classes of light paths cannot be told apart");
  if (o.method != Method::Path && (o.save_state || o.state != nullptr))
    throw std::invalid_argument("render: only path tracing goes on from a state");
  if (o.mode == Mode::Paper && o.method == Method::Path)
    throw std::invalid_argument("render: paper mode has no path tracer, it is not a BSDF");
}

}  // namespace

PixelWindow pixel_window(const RenderOptions& o) {
  const auto place = [](double share, int size) {
    return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * size));
  };
  const int x0 = std::min(place(o.crop[0], o.width), o.width - 1);
  const int y0 = std::min(place(o.crop[1], o.height), o.height - 1);
  const int x1 = std::max(place(o.crop[2], o.width), x0 + 1);
  const int y1 = std::max(place(o.crop[3], o.height), y0 + 1);
  return {x0, y0, x1 - x0, y1 - y0};
}

RenderResult render(const scene::RayQuery& query, const material::SpectralBasis& basis,
                    const scene::Camera& camera, const scene::SurfaceField& field,
                    const RenderOptions& options, const scene::Control& control) {
  check(field, basis, options);
  return with_lanes(basis.lanes(), [&](auto lanes) {
    return render_lanes<lanes()>(query, basis, camera, field, options, control);
  });
}

}  // namespace atrium::trace
