#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "bidirectional.h"
#include "film.h"
#include "integrator.h"
#include "rounds.h"
#include "scene/parallel.h"
#include "small_lamps.h"

namespace atrium::trace {

inline constexpr int kTile = 16;  ///< edge [pixels]

struct Tile {
  int x0, y0, x1, y1;
};
[[nodiscard]] inline std::vector<Tile> tiles_of(int width, int height) {
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += kTile)
    for (int x = 0; x < width; x += kTile)
      tiles.push_back({x, y, std::min(x + kTile, width), std::min(y + kTile, height)});
  return tiles;
}

/// A camera sample by the method and mode that the options have.
template <int N>
[[nodiscard]] PixelSample<N> trace_from_eye(const View<N>& view, const scene::Ray& ray,
                                            GatherGuide& guide, scene::Sampler& sampler,
                                            scene::Sampler* check, scene::Counters& counters) {
  if (view.options.mode == Mode::Paper) return trace_paper(view, ray, sampler, counters);
  if (view.options.method == Method::Path) return trace_path(view, ray, sampler, counters);
  return trace_hybrid(view, ray, guide, sampler, check, counters);
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

/// One view being rendered: camera samples and, if asked for, paths from lights, into a film.
template <int N>
class ViewTracer {
 public:
  /// \param from_lights  paths from lights, too. \param check_every  of so many samples one
  /// checks the field; 0: none.
  ViewTracer(const View<N>& view, const Eye& eye, bool from_lights, std::uint32_t check_every,
             const scene::Control& control)
      : view_(view),
        eye_(eye),
        window_(eye.window),
        from_lights_(from_lights),
        check_every_(check_every),
        control_(control),
        lamps_(view.shading.scene(), view.shading.lights().surfaces(), eye),
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
    return done_.size() == pixels && rays_.size() == pixels && counters_.size() == tiles &&
           piece_.next <= piece_.end;
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
  /// Of samples that pixels are to have: no more than `most`, or than there are. What a damaged
  /// state asks for would have no end.
  void limit(std::vector<std::uint32_t>& samples, std::uint32_t most) const {
    for (std::size_t i = 0; i < done_.size(); ++i)
      samples[i] = std::min(samples[i], std::max(most, done_[i]));
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
      const std::uint64_t left = pieces * ((most + kSamplesAtOnce - 1) / kSamplesAtOnce);
      if (piece_.next == piece_.end) piece_ = {0, left};
      // A damaged state may say that there is work without end.
      if (const std::uint64_t at = piece_.next % pieces; piece_.end - piece_.next > left)
        piece_ = {at, at + left};
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
    const scene::Ray ray = camera_ray(px, py, jitter);
    if (from_lights_) trace_light(pixel, number, work, counters);
    PixelSample<N> sample =
        from_lights_ ? trace_bidirectional(view_, eye_, ray, work.path, sampler, counters)
                     : trace_and_check(ray, pixel, number, guide, sampler, counters);
    if (const auto lamps = lamps_.of(x, y); !lamps.empty()) {
      if (is_among(lamps, jitter)) sample.add_emission(sample[Term::Emission] * -1.0f);
      for (std::uint32_t k = 0; k < kLampRays; ++k) {
        scene::Sampler numbers(o.seed ^ kLampStream, scene::hash_combine(pixel, replicate),
                               number / kSets * kLampRays + k);
        for (const FilmRect& lamp : lamps) {
          const scene::Ray to_lamp = camera_ray(px, py, lamp.sample(numbers.next_2d()));
          sample.add_emission(first_emission(to_lamp, counters) * (lamp.area() / kLampRays));
        }
      }
    }
    film.add(x, y, replicate, sample, view_.shading.basis(), counters);
  }

  /// \param at  within the pixel, in [0, 1]^2.
  [[nodiscard]] scene::Ray camera_ray(int px, int py, const Vec2f& at) const {
    const Vec2d place((px + static_cast<double>(at.x())) / view_.options.width,
                      (py + static_cast<double>(at.y())) / view_.options.height);
    const scene::Camera::CameraRay r = eye_.camera.ray(place, eye_.aspect);
    return {r.origin, r.direction};
  }

  /// Radiance of the first surface itself that a camera ray meets, or of the sky.
  Spectrum<N> first_emission(const scene::Ray& ray, scene::Counters& counters) const {
    const scene::Shading<N>& shading = view_.shading;
    float distance = 0.0f;
    const auto hit = shading.closest(ray, counters, scene::Counter::RaysPrimary, &distance);
    if (!hit) return sky_radiance(shading, ray);
    const Spectrum<N> emitted = shading.lights().emitted(*hit, -ray.direction);
    if (emitted.is_zero()) return emitted;
    const scene::Interaction<N> surface = shading.interact(*hit, -ray.direction);
    return emitted * segment_transmittance(shading, {}, surface, ray, distance);
  }

  /// Every check_every_-th sample checks the field, from a random one of each pixel and replicate
  /// on, with numbers of its own: the picture is the same with and without.
  PixelSample<N> trace_and_check(const scene::Ray& ray, std::uint32_t pixel, std::uint32_t number,
                                 GatherGuide& guide, scene::Sampler& sampler,
                                 scene::Counters& counters) {
    constexpr auto kSets = static_cast<std::uint32_t>(kReplicates);
    const std::uint32_t stream = scene::hash_combine(pixel, number % kSets);
    const std::uint32_t index = number / kSets;
    if (check_every_ == 0 || (scene::hash32(stream) + index) % check_every_ != 0)
      return trace_from_eye(view_, ray, guide, sampler, nullptr, counters);
    scene::Sampler numbers(view_.options.seed ^ (kCheckStream + view_.options.check_seed), stream,
                           index);
    PixelSample<N> sample = trace_from_eye(view_, ray, guide, sampler, &numbers, counters);
    sample.field_missed *= static_cast<float>(check_every_);
    return sample;
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

  // With paths from lights: tiles between two additions to the film, and samples of a pixel. A stop
  // waits for the end of such a piece: sums have the same order whether there was one or not.
  static constexpr std::size_t kTilesAtOnce = 64;
  static constexpr std::uint32_t kSamplesAtOnce = 4;
  static constexpr std::uint32_t kLampRays = 4;  // of a sample of a pixel that shows small lamps
  static constexpr std::uint64_t kCheckStream = 0x636865636b21ULL;
  static constexpr std::uint64_t kLampStream = 0x6c616d707321ULL;
  static constexpr std::uint64_t kLightStream = 0x6c696768747321ULL;

  const View<N>& view_;
  const Eye& eye_;
  const PixelWindow& window_;
  const bool from_lights_;
  const std::uint32_t check_every_;
  const scene::Control& control_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const SmallLamps lamps_;
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

}  // namespace atrium::trace
