#include "trace/render.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <string>
#include <vector>

#include "film.h"
#include "integrator.h"
#include "material/error.h"
#include "scene/parallel.h"
#include "trace/camera_window.h"

namespace atrium::trace {
namespace {

constexpr int kTile = 16;

struct Tile {
  int x0, y0, x1, y1;
};

std::vector<Tile> tiles_of(int width, int height) {
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += kTile)
    for (int x = 0; x < width; x += kTile)
      tiles.push_back({x, y, std::min(x + kTile, width), std::min(y + kTile, height)});
  return tiles;
}

template <int N>
PixelSample<N> trace(const View<N>& view, const scene::Ray& ray, scene::Sampler& sampler,
                     scene::Counters& counters) {
  if (view.options.mode == Mode::Paper) return trace_paper(view, ray, sampler, counters);
  if (view.options.method == Method::Path) return trace_path(view, ray, sampler, counters);
  return trace_hybrid(view, ray, sampler, counters);
}

template <int N>
void render_tile(const View<N>& view, const scene::Camera& camera, const PixelWindow& window,
                 const Tile& tile, int first_sample, int last_sample, Film& film,
                 scene::Counters& counters) {
  const RenderOptions& o = view.options;
  const double aspect = static_cast<double>(o.width) / static_cast<double>(o.height);
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x) {
      const int px = x + window.x0;  // pixel of the whole image: a crop shows the same samples
      const int py = y + window.y0;
      const auto stream = static_cast<std::uint32_t>(py) * static_cast<std::uint32_t>(o.width) +
                          static_cast<std::uint32_t>(px);
      for (int i = first_sample; i < last_sample; ++i) {
        scene::Sampler sampler(o.seed, stream, static_cast<std::uint32_t>(i));
        const Vec2f jitter = sampler.next_2d();
        const Vec2d place((px + static_cast<double>(jitter.x())) / o.width,
                          (py + static_cast<double>(jitter.y())) / o.height);
        const scene::Camera::CameraRay r = camera.ray(place, aspect);
        film.add(x, y, trace(view, {r.origin, r.direction}, sampler, counters),
                 view.shading.basis(), counters);
      }
    }
}

// Workers report through one of them at a time; the others go on.
class SerialProgress {
 public:
  void report(const scene::Control& control, double fraction) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() || fraction < last_ + 0.002) return;
    last_ = fraction;
    control.report("render", fraction);
  }

 private:
  std::mutex mutex_;
  double last_ = 0.0;
};

template <int N>
RenderResult render_lanes(const scene::RayQuery& query, const material::SpectralBasis& basis,
                          const scene::Camera& camera, const scene::SurfaceField& field,
                          const RenderOptions& options, const scene::Control& control) {
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const scene::Shading<N> shading(query, basis);
  const View<N> view{shading, field, options};
  const PixelWindow window = pixel_window(options);
  const bool shares =
      options.share_samples && options.method != Method::Path && options.mode == Mode::Radiometric;
  Film film(window.width, window.height, options.components, shares);
  const std::vector<Tile> tiles = tiles_of(window.width, window.height);
  std::vector<scene::Counters> counters(tiles.size());

  // Passes of doubling size: a picture of the whole view early, few synchronisations later.
  RenderResult result;
  SerialProgress progress;
  while (result.samples_done < options.samples && result.complete) {
    const int first = result.samples_done;
    const int last = std::min(options.samples, first + std::clamp(first, 1, 16));
    std::atomic<std::size_t> tiles_done = 0;
    std::atomic<bool> stopped = false;
    scene::parallel_for(tiles.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        // Every pixel gets its first sample; after that a request ends the pass where it is.
        const bool late = options.time_limit > 0.0 && elapsed() > options.time_limit;
        if (first > 0 && (late || control.stop_requested())) {
          stopped = true;
          continue;
        }
        render_tile(view, camera, window, tiles[t], first, last, film, counters[t]);
        progress.report(control, (first + (last - first) * static_cast<double>(++tiles_done) /
                                              static_cast<double>(tiles.size())) /
                                     options.samples);
      }
    });
    result.complete = !stopped;
    if (!stopped) result.samples_done = last;
  }
  for (const scene::Counters& c : counters) result.counters += c;
  film.share();
  result.image = film.image();
  result.error_estimate = film.error_estimate();
  return result;
}

void check(const scene::SurfaceField& field, const material::SpectralBasis& basis,
           const RenderOptions& o) {
  if (o.width < 1 || o.height < 1 || o.width > 65536 || o.height > 65536)
    throw std::invalid_argument("render: width and height must be within 1..65536");
  if (o.samples < 1) throw std::invalid_argument("render: samples must be at least 1");
  if (!field.empty() && field.lanes != basis.lanes())
    throw std::invalid_argument("render: the field was solved with another number of lanes");
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
