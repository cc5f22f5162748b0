#include "rounds.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "allotment.h"
#include "picture_error.h"

namespace atrium::trace {
namespace {

constexpr std::uint32_t kFirst = 2 * kReplicates;  // samples of a pixel before any estimate
constexpr std::uint32_t kLargestPass = 16;         // samples of a pixel
constexpr int kBlock = 8;                          // edge of the blocks of the block error
constexpr std::uint32_t kMostOfPixel = 1U << 16;   // samples
constexpr double kAim = 0.97;    // of the target: a round that just misses it costs another one
constexpr double kGrowth = 2.0;  // of the cost of the picture in one round
constexpr double kLeast = 1.1;   // an estimate that is about the target needs some more to move
constexpr double kNoiseShare = 0.25;  // of the square asked for, at least, is left to noise
constexpr double kStep = 1.25;        // what a round lowers the square of the noise by, at least

using Clock = std::chrono::steady_clock;

struct Errors {
  ErrorEstimate pixel, block;
};

/// What is expected of the field where `asked` is what may be wrong.
double expected_field(const RenderOptions& o, double asked) {
  return asked > 0.0 ? o.field_expected * asked : std::numeric_limits<double>::infinity();
}

Errors estimate(const PictureSamples& samples, const RenderOptions& o) {
  return {estimate_error(samples, expected_field(o, o.error)),
          estimate_error(average_blocks(samples, kBlock), expected_field(o, o.block_error))};
}

/// Worse of the two errors, relative to what is asked for.
double excess(const Errors& e, const RenderOptions& o) {
  return std::max(o.error > 0.0 ? e.pixel.value / o.error : 0.0,
                  o.block_error > 0.0 ? e.block.value / o.block_error : 0.0);
}

/// The same of what is certain of the field's own error.
double field_excess(const Errors& e, const RenderOptions& o) {
  return std::max(o.error > 0.0 ? e.pixel.least_field / o.error : 0.0,
                  o.block_error > 0.0 ? e.block.least_field / o.block_error : 0.0);
}

/// Is the field's own error, which samples do not lower, too large?
bool is_field_too_large(const ErrorEstimate& e, double asked, double share) {
  if (!(asked > 0.0)) return false;
  return e.least_field > asked || (e.least_field > 0.0 && e.field > share * asked && share < 1.0);
}

std::string remark_of(const Errors& e, const RenderOptions& o) {
  char text[64];
  if (o.error > 0.0 || !(o.block_error > 0.0))
    std::snprintf(text, sizeof text, "error %.3g %%", 100.0 * e.pixel.value);
  else
    std::snprintf(text, sizeof text, "error of blocks %.3g %%", 100.0 * e.block.value);
  return text;
}

/// One picture in the making.
class Rounds {
 public:
  Rounds(Film& film, int width, int height, const RenderOptions& options, const Pass& pass,
         const std::vector<float>& cost, RoundState& state, RenderResult& result)
      : film_(film),
        options_(options),
        pass_(pass),
        cost_(cost),
        state_(state),
        samples_(state.samples),
        result_(result) {
    plan_.width = width;
    plan_.height = height;
    samples_.resize(cost.size(), 0);
  }

  /// Passes of doubling size: a picture of the whole view early, few synchronisations later.
  bool uniform(std::uint32_t samples, double progress_to) {
    for (std::uint32_t n = 0; n < samples;) {
      const std::uint32_t next = std::min(samples, n + std::clamp(n, 1U, kLargestPass));
      std::fill(samples_.begin(), samples_.end(), next);
      const double share = progress_to / samples;
      if (!pass_(samples_, {share * n, share * next, {}})) return false;
      n = next;
      if (n < samples && preview_due()) show(film_.develop());
    }
    result_.stopped_by = "samples";
    return true;
  }

  /// As many rays as `mean` samples of every pixel take, where they lower the error most.
  void spread(std::uint32_t mean) {
    if (mean <= kFirst) {
      (void)uniform(mean, 1.0);
      return;
    }
    const double first = static_cast<double>(kFirst) / mean;
    if (!uniform(kFirst, first)) return;
    const Errors now = develop();
    plan_from(now);
    samples_ = allot_samples(plan_, {.goal = 0.0, .growth = 1.0 / first, .most = kMostOfPixel});
    ++state_.rounds;
    (void)pass_(samples_, {first, 1.0, remark_of(now, options_)});
  }

  void until_error() {
    const auto most = static_cast<std::uint32_t>(options_.samples);
    if (state_.rounds == 0 && !uniform(std::min(kFirst, most), 0.02)) return;
    if (state_.rounds > 0 && !pass_(samples_, {0.0, 1.0, {}})) return;  // what was in progress
    for (Errors now = develop();; now = develop()) {
      const double e = excess(now, options_);
      if (!(e > 1.0)) {
        result_.stopped_by = "error";
        return;
      }
      if (is_field_too_large(now.pixel, options_.error, options_.field_share) ||
          is_field_too_large(now.block, options_.block_error, options_.field_share)) {
        result_.stopped_by = "radiosity";
        return;
      }
      const double done = 1.0 / (e * e);
      if (!plan_round(now, e, most)) {
        result_.stopped_by = "samples";
        return;
      }
      ++state_.rounds;
      if (!pass_(samples_, {done, std::min(1.0, kGrowth * done), remark_of(now, options_)})) return;
    }
  }

  void finish() {
    const PictureSamples samples = film_.develop();
    const Errors e = estimate(samples, options_);
    result_.rounds = state_.rounds;
    result_.error_estimate = e.pixel.value;
    result_.bias_estimate = e.pixel.bias;
    result_.field_error_estimate = e.pixel.field;
    result_.block_error_estimate = e.block.value;
    result_.field_excess = field_excess(e, options_);
    result_.complete = result_.stopped_by == "error" || result_.stopped_by == "samples" ||
                       result_.stopped_by == "radiosity";
    result_.image = film_.image(error_layer(samples));
    film_.count_samples(result_.samples_done, result_.samples_mean);
  }

 private:
  Errors develop() {
    const PictureSamples samples = film_.develop();
    if (preview_due()) show(samples);
    return estimate(samples, options_);
  }

  [[nodiscard]] bool preview_due() const {
    return options_.preview &&
           Clock::now() - shown_ >= std::chrono::duration<double>(options_.preview_seconds);
  }
  void show(const PictureSamples& samples) {
    options_.preview(film_.image(error_layer(samples)));
    shown_ = Clock::now();
  }

  void plan_from(const Errors& now) {
    plan_.noise = now.pixel.noise_squares;
    plan_.bias = now.pixel.bias_squares;
    plan_.count = samples_;
    plan_.cost = cost_;
  }

  /// false: every pixel has all the samples that it may get.
  bool plan_round(const Errors& now, double excess, std::uint32_t most) {
    const ErrorEstimate& e = now.pixel;
    plan_from(now);
    const double reduce = std::max(excess / kAim, std::sqrt(kLeast));
    const double square = (e.value / reduce) * (e.value / reduce);
    // Room for noise: what the field surely leaves, as more samples may lower its own estimate.
    const double room = std::max(square - e.least_field * e.least_field, kNoiseShare * square);
    const double noise = e.value * e.value - e.field * e.field;
    const double goal = std::sqrt(std::min(room, noise / kStep));
    samples_ = allot_samples(plan_, {.goal = goal, .growth = kGrowth, .most = most});
    if (samples_ != plan_.count) return true;
    // Nothing to tell pixels apart by: all of them.
    for (std::uint32_t& n : samples_)
      n = std::min(most, n + static_cast<std::uint32_t>(kReplicates));
    return samples_ != plan_.count;
  }

  Film& film_;
  const RenderOptions& options_;
  const Pass& pass_;
  const std::vector<float>& cost_;
  RoundState& state_;
  std::vector<std::uint32_t>& samples_;
  RenderResult& result_;
  PixelCosts plan_;
  Clock::time_point shown_;  // the last preview; long ago at first
};

}  // namespace

void take_samples(Film& film, int width, int height, const RenderOptions& options, const Pass& pass,
                  const std::vector<float>& cost, RoundState& state, RenderResult& result) {
  Rounds rounds(film, width, height, options, pass, cost, state, result);
  if (options.error > 0.0 || options.block_error > 0.0)
    rounds.until_error();
  else if (options.spread)
    rounds.spread(static_cast<std::uint32_t>(options.samples));
  else
    rounds.uniform(static_cast<std::uint32_t>(options.samples), 1.0);
  rounds.finish();
}

}  // namespace atrium::trace
