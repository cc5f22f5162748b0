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
#include "rounds.h"
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
PixelSample<N> trace(const View<N>& view, const scene::Ray& ray, GatherGuide& guide,
                     scene::Sampler& sampler, scene::Counters& counters) {
  if (view.options.mode == Mode::Paper) return trace_paper(view, ray, sampler, counters);
  if (view.options.method == Method::Path) return trace_path(view, ray, sampler, counters);
  return trace_hybrid(view, ray, guide, sampler, counters);
}

/// Edge of a tile in the middle of the picture, at the camera [m] and by how much it grows.
std::array<float, 2> tile_edge(const scene::Camera& camera, const RenderOptions& o) {
  const double aspect = static_cast<double>(o.width) / static_cast<double>(o.height);
  const auto a = camera.ray(Vec2d(0.5, 0.5), aspect);
  const auto b = camera.ray(Vec2d(0.5, 0.5 + static_cast<double>(kTile) / o.height), aspect);
  return {(a.origin - b.origin).norm(), (a.direction - b.direction).norm()};
}

// Workers report through one of them at a time; the others go on.
class SerialProgress {
 public:
  void report(const scene::Control& control, double fraction, const std::string& remark) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() || fraction < last_ + 0.002) return;
    last_ = fraction;
    control.report("render", fraction, remark);
  }

 private:
  std::mutex mutex_;
  double last_ = 0.0;
};

/// One view being rendered.
template <int N>
class ViewTracer {
 public:
  ViewTracer(const View<N>& view, const scene::Camera& camera, const PixelWindow& window,
             const scene::Control& control)
      : view_(view),
        camera_(camera),
        window_(window),
        control_(control),
        tiles_(tiles_of(window.width, window.height)),
        guides_(tiles_.size()),
        counters_(tiles_.size()) {
    const auto pixels =
        static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
    done_.assign(pixels, 0);
    rays_.assign(pixels, 0);
    cost_.assign(pixels, 1.0f);
  }

  /// As Pass has it.
  bool pass(const std::vector<std::uint32_t>& samples, const PassProgress& progress, Film& film,
            RenderResult& result) {
    std::atomic<std::size_t> tiles_done = 0;
    std::atomic<bool> late = false, interrupted = false;
    scene::parallel_for(tiles_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        // Every pixel gets its first sample; after that a request ends the pass where it is.
        if (!first_ && control_.stop_requested()) {
          interrupted = true;
          continue;
        }
        if (!first_ && time_is_up()) {
          late = true;
          continue;
        }
        guides_[t].learn();
        trace_tile(tiles_[t], samples, film, guides_[t], counters_[t]);
        const double share = static_cast<double>(++tiles_done) / static_cast<double>(tiles_.size());
        progress_.report(control_, progress.from + (progress.to - progress.from) * share,
                         progress.remark);
      }
    });
    first_ = false;
    for (std::size_t i = 0; i < done_.size(); ++i)
      cost_[i] = static_cast<float>(rays_[i]) / static_cast<float>(std::max(done_[i], 1U));
    if (interrupted)
      result.stopped_by = "interrupt";
    else if (late)
      result.stopped_by = "time limit";
    return !interrupted && !late;
  }

  [[nodiscard]] const std::vector<float>& cost() const { return cost_; }
  [[nodiscard]] scene::Counters counters() const {
    scene::Counters sum;
    for (const scene::Counters& c : counters_) sum += c;
    return sum;
  }

 private:
  [[nodiscard]] bool time_is_up() const {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    return view_.options.time_limit > 0.0 && elapsed.count() > view_.options.time_limit;
  }

  void trace_tile(const Tile& tile, const std::vector<std::uint32_t>& samples, Film& film,
                  GatherGuide& guide, scene::Counters& counters) {
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) {
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(window_.width) +
            static_cast<std::size_t>(x);
        const std::uint64_t before = counters.rays();
        for (; done_[pixel] < samples[pixel]; ++done_[pixel])
          trace_sample(x, y, done_[pixel], film, guide, counters);
        rays_[pixel] += counters.rays() - before;
      }
  }

  void trace_sample(int x, int y, std::uint32_t number, Film& film, GatherGuide& guide,
                    scene::Counters& counters) {
    const RenderOptions& o = view_.options;
    const int px = x + window_.x0;  // pixel of the whole image: a crop shows the same samples
    const int py = y + window_.y0;
    const auto pixel = static_cast<std::uint32_t>(py) * static_cast<std::uint32_t>(o.width) +
                       static_cast<std::uint32_t>(px);
    constexpr auto kSets = static_cast<std::uint32_t>(kReplicates);
    const std::uint32_t replicate = number % kSets;
    scene::Sampler sampler(o.seed, scene::hash_combine(pixel, replicate), number / kSets);
    const Vec2f jitter = sampler.next_2d();
    const Vec2d place((px + static_cast<double>(jitter.x())) / o.width,
                      (py + static_cast<double>(jitter.y())) / o.height);
    const double aspect = static_cast<double>(o.width) / static_cast<double>(o.height);
    const scene::Camera::CameraRay r = camera_.ray(place, aspect);
    film.add(x, y, replicate, trace(view_, {r.origin, r.direction}, guide, sampler, counters),
             view_.shading.basis(), counters);
  }

  const View<N>& view_;
  const scene::Camera& camera_;
  const PixelWindow& window_;
  const scene::Control& control_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<Tile> tiles_;
  std::vector<GatherGuide> guides_;        // by tile
  std::vector<scene::Counters> counters_;  // by tile
  std::vector<std::uint32_t> done_;        // samples by pixel
  std::vector<std::uint64_t> rays_;        // by pixel
  std::vector<float> cost_;                // [rays per sample]
  SerialProgress progress_;
  bool first_ = true;
};

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
  const PixelWindow window = pixel_window(options);
  // Blocks average already; sharing would add its bias and take hardly any noise.
  const bool blocks_only = options.block_error > 0.0 && !(options.error > 0.0);
  const bool shares = options.share_samples && options.method != Method::Path &&
                      options.mode == Mode::Radiometric && !blocks_only;
  Film film(window.width, window.height, options.components, shares);
  ViewTracer<N> tracer(view, camera, window, control);
  RenderResult result;
  take_samples(
      film, window.width, window.height, options,
      [&](const std::vector<std::uint32_t>& samples, const PassProgress& progress) {
        return tracer.pass(samples, progress, film, result);
      },
      tracer.cost(), result);
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
