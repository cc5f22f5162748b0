#include "trace/compare.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "error_scale.h"
#include "rgb_planes.h"
#include "trace/light_classes.h"

namespace atrium::trace {

namespace {

constexpr int kBlock = 8;
constexpr int kTile = 16;
constexpr double kNormal95 = 1.959963984540054;

/// Three planes and one scalar in double precision; a pixel that is not finite has weight 0.
struct Planes {
  int width = 0, height = 0;
  std::vector<std::array<double, 3>> image, reference, variance;
  std::vector<std::uint8_t> valid;

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

double luminance_of(const std::array<double, 3>& c) {
  return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

Planes make_planes(const scene::Image& a, const scene::Image& b) {
  if (a.width != b.width || a.height != b.height) {
    throw std::invalid_argument("compare: the images have different sizes");
  }
  const RgbPlanes image(a), reference(b);
  const bool noise = RgbPlanes::present(b, "stderr.");
  const RgbPlanes error = noise ? RgbPlanes(b, "stderr.") : reference;
  Planes p;
  p.width = a.width;
  p.height = a.height;
  p.image.resize(image.size());
  p.reference.resize(image.size());
  p.variance.assign(image.size(), {0.0, 0.0, 0.0});
  p.valid.assign(image.size(), 1);
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int channel = static_cast<int>(c);
      p.image[i][c] = image.value(i, channel);
      p.reference[i][c] = reference.value(i, channel);
      if (noise) p.variance[i][c] = error.value(i, channel) * error.value(i, channel);
      if (!std::isfinite(p.image[i][c]) || !std::isfinite(p.reference[i][c]) ||
          !std::isfinite(p.variance[i][c])) {
        p.valid[i] = 0;
      }
    }
  }
  return p;
}

/// Means over 8x8 pixels; at the right and lower border over what is there.
Planes block_average(const Planes& p) {
  Planes r;
  r.width = (p.width + kBlock - 1) / kBlock;
  r.height = (p.height + kBlock - 1) / kBlock;
  const std::size_t n = static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height);
  r.image.assign(n, {});
  r.reference.assign(n, {});
  r.variance.assign(n, {});
  r.valid.assign(n, 0);
  std::vector<double> count(n, 0.0);
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      const std::size_t from = p.index(x, y), to = r.index(x / kBlock, y / kBlock);
      if (p.valid[from] == 0) continue;
      count[to] += 1.0;
      for (std::size_t c = 0; c < 3; ++c) {
        r.image[to][c] += p.image[from][c];
        r.reference[to][c] += p.reference[from][c];
        r.variance[to][c] += p.variance[from][c];
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (count[i] == 0.0) continue;
    r.valid[i] = 1;
    for (std::size_t c = 0; c < 3; ++c) {
      r.image[i][c] /= count[i];
      r.reference[i][c] /= count[i];
      r.variance[i][c] /= count[i] * count[i];  // pixels are independent samples
    }
  }
  return r;
}

/// The denominator of e for every pixel.
std::vector<double> scales(const Planes& p) {
  std::vector<double> luminance(p.reference.size());
  for (std::size_t i = 0; i < luminance.size(); ++i)
    luminance[i] = p.valid[i] != 0 ? luminance_of(p.reference[i]) : 0.0;
  return error_scales(p.width, p.height, luminance, p.valid);
}

struct Sums {
  double squares = 0.0;  ///< of e
  double noise = 0.0;    ///< variance of the reference in the same units
  double count = 0.0;
};

/// Mean of (squares - noise) over tiles, and the standard error of that mean.
struct TileMean {
  double mean = 0.0;
  double standard_error = 0.0;
};
TileMean tile_mean(const std::vector<Sums>& tiles) {
  double total = 0.0, count = 0.0;
  for (const Sums& t : tiles) {
    total += t.squares - t.noise;
    count += t.count;
  }
  if (!(count > 0.0)) return {};
  const double mean = total / count;
  double squares = 0.0;
  for (const Sums& t : tiles) {
    const double residual = t.squares - t.noise - mean * t.count;  // ratio estimator
    squares += residual * residual;
  }
  const double n = static_cast<double>(tiles.size());
  const double se = n > 1.0 ? std::sqrt(squares * n / (n - 1.0)) / count : 0.0;
  return {mean, se};
}

double root(double v) { return v > 0.0 ? std::sqrt(v) : 0.0; }

Measure measure(const Planes& p, int tile, double& noise, double* max_abs) {
  const std::vector<double> scale = scales(p);
  const int columns = (p.width + tile - 1) / tile;
  const int rows = (p.height + tile - 1) / tile;
  std::vector<Sums> tiles(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      const std::size_t i = p.index(x, y);
      if (p.valid[i] == 0) continue;
      Sums& t = tiles[static_cast<std::size_t>(y / tile) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(x / tile)];
      for (std::size_t c = 0; c < 3; ++c) {
        const double e = relative(p.image[i][c] - p.reference[i][c], scale[i]);
        t.squares += e * e;
        t.noise += relative(p.variance[i][c], scale[i] * scale[i]);
        t.count += 1.0;
        if (max_abs != nullptr) *max_abs = std::max(*max_abs, std::abs(e));
      }
    }
  }
  std::erase_if(tiles, [](const Sums& t) { return t.count == 0.0; });
  double noise_sum = 0.0, count = 0.0;
  for (const Sums& t : tiles) {
    noise_sum += t.noise;
    count += t.count;
  }
  noise = count > 0.0 ? std::sqrt(noise_sum / count) : 0.0;
  const TileMean m = tile_mean(tiles);
  return {root(m.mean), root(m.mean - kNormal95 * m.standard_error),
          root(m.mean + kNormal95 * m.standard_error)};
}

/// Standard error of the mean luminance from stderr.* layers; 0 without.
double mean_error(const scene::Image& image, const Planes& p) {
  if (!RgbPlanes::present(image, "stderr.")) return 0.0;
  const RgbPlanes error(image, "stderr.");
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < error.size(); ++i) {
    if (p.valid[i] == 0 || !std::isfinite(error.luminance(i))) continue;
    // The channels of a pixel come from the same paths: their errors add, not their variances.
    sum += error.luminance(i) * error.luminance(i);
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum) / count : 0.0;
}

void add_bias(const scene::Image& a, const scene::Image& b, const Planes& p, Comparison& result) {
  double image = 0.0, reference = 0.0;
  for (std::size_t i = 0; i < p.image.size(); ++i) {
    if (p.valid[i] == 0) {
      ++result.pixels_skipped;
      continue;
    }
    ++result.pixels;
    image += luminance_of(p.image[i]);
    reference += luminance_of(p.reference[i]);
  }
  if (result.pixels == 0) return;
  result.bias = relative(image - reference, reference);
  const double mean = reference / static_cast<double>(result.pixels);
  result.bias_error = relative(std::hypot(mean_error(a, p), mean_error(b, p)), mean);
}

double mean_luminance(const RgbPlanes& layer, const Planes& p) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < layer.size(); ++i) {
    if (p.valid[i] == 0) continue;
    sum += layer.luminance(i);
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

void add_terms(const scene::Image& a, const scene::Image& b, const Planes& p, Comparison& result) {
  const double whole = mean_luminance(RgbPlanes(b, ""), p);
  for (const char* name : {"C1", "C2", "C3", "C4", "C5", "C6", "emission"}) {
    const std::string layer = std::string(name) + ".";
    if (!RgbPlanes::present(a, layer) || !RgbPlanes::present(b, layer)) continue;
    const double reference = mean_luminance(RgbPlanes(b, layer), p);
    const double image = mean_luminance(RgbPlanes(a, layer), p);
    result.terms.push_back({name, relative(reference, whole), relative(image - reference, whole)});
  }
}

/// One channel of a layer; nullopt: the image has none.
std::optional<int> channel_of(const scene::Image& image, const std::string& name) {
  const int i = image.channel_index(name);
  return i < 0 ? std::nullopt : std::optional(i);
}

std::optional<ClassComparison> compare_class(const scene::Image& a, const scene::Image& b,
                                             const std::string& name, const Planes& p,
                                             double whole) {
  if (!RgbPlanes::present(a, name + ".") || !RgbPlanes::present(b, name + ".")) return std::nullopt;
  const auto error_a = channel_of(a, "stderr." + name + ".Y");
  const auto error_b = channel_of(b, "stderr." + name + ".Y");
  if (!error_a || !error_b) return std::nullopt;
  const RgbPlanes image(a, name + "."), reference(b, name + ".");
  double count = 0.0, of_image = 0.0, of_reference = 0.0, squares = 0.0, noise = 0.0;
  for (std::size_t i = 0; i < p.valid.size(); ++i) {
    if (p.valid[i] == 0) continue;
    const int x = static_cast<int>(i % static_cast<std::size_t>(p.width));
    const int y = static_cast<int>(i / static_cast<std::size_t>(p.width));
    const double one = image.luminance(i), two = reference.luminance(i);
    count += 1.0;
    of_image += one;
    of_reference += two;
    squares += (one - two) * (one - two);
    noise += std::pow(static_cast<double>(a.at(x, y, *error_a)), 2.0) +
             std::pow(static_cast<double>(b.at(x, y, *error_b)), 2.0);
  }
  if (!(count > 0.0)) return std::nullopt;
  return ClassComparison{name, relative(of_reference / count, whole),
                         relative((of_image - of_reference) / count, whole),
                         relative(kNormal95 * std::sqrt(noise) / count, whole),
                         relative(root((squares - noise) / count), whole)};
}

void add_classes(const scene::Image& a, const scene::Image& b, const Planes& p,
                 Comparison& result) {
  const double whole = mean_luminance(RgbPlanes(b, ""), p);
  for (const std::string_view name : kLightClassNames)
    if (const auto c = compare_class(a, b, std::string(name), p, whole))
      result.classes.push_back(*c);
}

}  // namespace

Comparison compare(const scene::Image& image, const scene::Image& reference) {
  const Planes planes = make_planes(image, reference);
  Comparison result;
  result.noise_known = RgbPlanes::present(reference, "stderr.");
  add_bias(image, reference, planes, result);
  add_terms(image, reference, planes, result);
  add_classes(image, reference, planes, result);
  result.pixel = measure(planes, kTile, result.pixel_noise, &result.max_abs);
  result.block = measure(block_average(planes), kTile / kBlock, result.block_noise, nullptr);
  return result;
}

scene::Image difference_image(const scene::Image& image, const scene::Image& reference) {
  const Planes p = make_planes(image, reference);
  const std::vector<double> scale = scales(p);
  scene::Image result;
  result.width = p.width;
  result.height = p.height;
  result.channels = {"R", "G", "B"};
  result.pixels.assign(p.image.size() * 3, 0.0f);
  for (std::size_t i = 0; i < p.image.size(); ++i) {
    if (p.valid[i] == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      result.pixels[i * 3 + c] =
          static_cast<float>(relative(p.image[i][c] - p.reference[i][c], scale[i]));
    }
  }
  return result;
}

scene::Image show_difference(const scene::Image& difference, double full_scale) {
  if (!(full_scale > 0.0)) throw std::invalid_argument("show_difference: full_scale must be > 0");
  scene::Image result = difference;
  for (float& v : result.pixels) {
    const double d = 0.5 + 0.5 * static_cast<double>(v) / full_scale;
    v = static_cast<float>(std::min(1.0, std::max(0.0, d)));
  }
  return result;
}

}  // namespace atrium::trace
