#include "trace/render.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <string>
#include <vector>

#include "bidirectional.h"
#include "film.h"
#include "integrator.h"
#include "material/error.h"
#include "rounds.h"
#include "scene/archive.h"
#include "scene/parallel.h"
#include "trace/camera_window.h"
#include "trace/strategy.h"

namespace atrium::trace {
namespace {

constexpr int kTile = 16;
// With paths from lights: tiles between two additions to the film, and samples of a pixel. A stop
// waits for the end of such a piece, so that sums have the same order whether there was one or not.
constexpr std::size_t kTilesAtOnce = 64;
constexpr std::uint32_t kSamplesAtOnce = 4;

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
  ViewTracer(const View<N>& view, const Eye& eye, bool from_lights, const scene::Control& control)
      : view_(view),
        eye_(eye),
        window_(eye.window),
        from_lights_(from_lights),
        control_(control),
        tiles_(tiles_of(eye.window.width, eye.window.height)),
        guides_(tiles_.size()),
        counters_(tiles_.size()) {
    const auto pixels =
        static_cast<std::size_t>(window_.width) * static_cast<std::size_t>(window_.height);
    done_.assign(pixels, 0);
    rays_.assign(pixels, 0);
    cost_.assign(pixels, 1.0f);
  }

  /// All state between two pieces of work, as Film::archive() has it.
  template <class Archive>
  bool archive(Archive& a) {
    const std::size_t pixels = done_.size(), tiles = counters_.size();
    a(done_);
    a(rays_);
    a(counters_);
    a(piece_);
    first_ = false;
    return done_.size() == pixels && rays_.size() == pixels && counters_.size() == tiles;
  }

  /// As Pass has it.
  bool pass(const std::vector<std::uint32_t>& samples, const PassProgress& progress, Film& film,
            RenderResult& result) {
    late_ = interrupted_ = false;
    if (samples_at_once(samples) == 0) return true;  // all done before this rendering went on
    if (from_lights_)
      pass_in_pieces(samples, progress, film);
    else
      pass_by_tiles(samples, progress, film);
    first_ = false;
    update_cost();
    if (interrupted_)
      result.stopped_by = "interrupt";
    else if (late_)
      result.stopped_by = "time limit";
    return !interrupted_ && !late_;
  }

  void update_cost() {
    for (std::size_t i = 0; i < done_.size(); ++i)
      cost_[i] = static_cast<float>(rays_[i]) / static_cast<float>(std::max(done_[i], 1U));
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

  /// Every pixel gets its first sample; after that a request ends the pass where it is.
  bool stopped() {
    if (first_) return false;
    if (control_.stop_requested())
      interrupted_ = true;
    else if (time_is_up())
      late_ = true;
    return interrupted_ || late_;
  }
  void report(const PassProgress& progress, double share) {
    progress_.report(control_, progress.from + (progress.to - progress.from) * share,
                     progress.remark);
  }

  void pass_by_tiles(const std::vector<std::uint32_t>& samples, const PassProgress& progress,
                     Film& film) {
    std::atomic<std::size_t> tiles_done = 0;
    const std::uint32_t all = samples_at_once(samples);
    scene::parallel_for(tiles_.size(), 1, [&](std::size_t begin, std::size_t end) {
      LightWork work;
      for (std::size_t t = begin; t < end; ++t) {
        if (stopped()) continue;
        guides_[t].learn();
        trace_tile(t, samples, all, work, film, counters_[t]);
        report(progress, static_cast<double>(++tiles_done) / static_cast<double>(tiles_.size()));
      }
    });
  }

  /// What paths from lights show is added after each piece, in the order of the tiles.
  void pass_in_pieces(const std::vector<std::uint32_t>& samples, const PassProgress& progress,
                      Film& film) {
    const std::uint64_t pieces = (tiles_.size() + kTilesAtOnce - 1) / kTilesAtOnce;
    std::vector<LightWork> work(std::min(kTilesAtOnce, tiles_.size()));
    while (const std::uint32_t most = samples_at_once(samples)) {
      if (piece_.next == piece_.end)
        piece_ = {0, pieces * ((most + kSamplesAtOnce - 1) / kSamplesAtOnce)};
      for (; piece_.next < piece_.end; ++piece_.next) {
        if (stopped()) return;
        const std::size_t first = (piece_.next % pieces) * kTilesAtOnce;
        const std::size_t count = std::min(kTilesAtOnce, tiles_.size() - first);
        scene::parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i)
            trace_tile(first + i, samples, kSamplesAtOnce, work[i], film, counters_[first + i]);
        });
        for (std::size_t i = 0; i < count; ++i) {
          film.add_splats(work[i].splats, work[i].paths);
          work[i].splats.clear();
          work[i].paths = {};
        }
        report(progress, static_cast<double>(piece_.next + 1) / static_cast<double>(piece_.end));
      }
    }
  }

  /// Most samples that one pixel is to get.
  [[nodiscard]] std::uint32_t samples_at_once(const std::vector<std::uint32_t>& samples) const {
    std::uint32_t most = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (samples[i] > done_[i]) most = std::max(most, samples[i] - done_[i]);
    return most;
  }

  /// Paths from lights of one tile.
  struct LightWork {
    LightPath<N> path;
    Splats splats;
    std::array<std::uint64_t, kReplicates> paths{};
  };

  /// \param most  samples of a pixel.
  void trace_tile(std::size_t number, const std::vector<std::uint32_t>& samples, std::uint32_t most,
                  LightWork& work, Film& film, scene::Counters& counters) {
    const Tile& tile = tiles_[number];
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) {
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(window_.width) +
            static_cast<std::size_t>(x);
        const std::uint64_t before = counters.rays();
        std::uint32_t& done = done_[pixel];
        const std::uint32_t end =
            samples[pixel] > done ? done + std::min(most, samples[pixel] - done) : done;
        for (; done < end; ++done) trace_sample(x, y, done, work, film, guides_[number], counters);
        rays_[pixel] += counters.rays() - before;
      }
  }

  void trace_sample(int x, int y, std::uint32_t number, LightWork& work, Film& film,
                    GatherGuide& guide, scene::Counters& counters) {
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
    const scene::Camera::CameraRay r = eye_.camera.ray(place, eye_.aspect);
    const scene::Ray ray{r.origin, r.direction};
    if (from_lights_) trace_light(pixel, number, work, counters);
    film.add(x, y, replicate,
             from_lights_ ? trace_bidirectional(view_, eye_, ray, work.path, sampler, counters)
                          : trace(view_, ray, guide, sampler, counters),
             view_.shading.basis(), counters);
  }

  /// The path from a light that belongs to a sample. All of a picture's are one sequence.
  void trace_light(std::uint32_t pixel, std::uint32_t number, LightWork& work,
                   scene::Counters& counters) {
    constexpr auto kSets = static_cast<std::uint32_t>(kReplicates);
    const std::uint32_t replicate = number % kSets;
    const std::uint64_t index = static_cast<std::uint64_t>(number / kSets) *
                                    static_cast<std::uint64_t>(eye_.width) *
                                    static_cast<std::uint64_t>(eye_.height) +
                                pixel;
    const auto epoch = static_cast<std::uint32_t>(index >> 32U);
    scene::Sampler sampler(view_.options.seed ^ kLightStream, scene::hash_combine(epoch, replicate),
                           static_cast<std::uint32_t>(index));
    trace_light_path(view_, sampler, work.path, counters);
    splat_light_path(view_, eye_, work.path, static_cast<std::uint16_t>(replicate), work.splats,
                     counters);
    ++work.paths[replicate];
  }

  static constexpr std::uint64_t kLightStream = 0x6c696768747321ULL;

  const View<N>& view_;
  const Eye& eye_;
  const PixelWindow& window_;
  const bool from_lights_;
  const scene::Control& control_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<Tile> tiles_;
  std::vector<GatherGuide> guides_;        // by tile
  std::vector<scene::Counters> counters_;  // by tile
  std::vector<std::uint32_t> done_;        // samples by pixel
  std::vector<std::uint64_t> rays_;        // by pixel
  std::vector<float> cost_;                // [rays per sample]
  struct Piece {
    std::uint64_t next = 0, end = 0;
  } piece_;  // of pass_in_pieces()
  SerialProgress progress_;
  std::atomic<bool> late_ = false, interrupted_ = false;
  bool first_ = true;
};

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
  Film film(window.width, window.height,
            {.components = options.components,
             .classes = options.classes,
             .shares = shares,
             .splats = from_lights});
  ViewTracer<N> tracer(view, eye, from_lights, control);
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
