#include "film.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace atrium::trace {
namespace {

void move_mean(Rgb& mean, const Rgb& value, float n) { mean += (value - mean) / n; }

}  // namespace

Film::Film(int width, int height, bool components, bool shares) : width_(width), height_(height) {
  const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  pixels_.resize(n);
  if (components) terms_.resize(n);
  if (shares) bodies_.resize(n);
}

void Film::add_body(Body& body, const std::array<Rgb, 2>& radiance, const Rgb& albedo,
                    const Vec3f& position, std::uint32_t sample) {
  const std::size_t half = sample % 2;
  const auto n = static_cast<float>(sample + 1);
  ++body.count[half];
  for (std::size_t part = 0; part < 2; ++part) {
    const float before = luminance(radiance[part]) - luminance(body.mean[part]);
    move_mean(body.mean[part], radiance[part], n);
    body.m2[part] += before * (luminance(radiance[part]) - luminance(body.mean[part]));
    move_mean(body.radiance[part][half], radiance[part], static_cast<float>(body.count[half]));
  }
  move_mean(body.albedo, albedo, n);
  body.position += (position - body.position) / n;
}

template <int N>
void Film::add(int x, int y, const PixelSample<N>& sample, const material::SpectralBasis& basis,
               scene::Counters& counters) {
  const std::size_t i =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  const Spectrum<N> radiance = sample.sum();
  ++counters[scene::Counter::Samples];
  if (!radiance.is_finite()) {
    ++counters[scene::Counter::SamplesDropped];
    return;
  }
  Pixel& p = pixels_[i];
  const Rgb rgb = basis.to_rgb(radiance);
  ++p.count;
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = static_cast<double>(rgb[static_cast<int>(c)]);
    const double before = value - p.mean[c];
    p.mean[c] += before / p.count;
    p.m2[c] += before * (value - p.mean[c]);
  }
  const auto n = static_cast<float>(p.count);
  if (!terms_.empty())
    for (std::size_t t = 0; t < kTerms; ++t)
      move_mean(terms_[i][t], basis.to_rgb(sample.term[t]), n);
  if (!bodies_.empty())
    add_body(bodies_[i], {basis.to_rgb(sample.body_direct), basis.to_rgb(sample.body_indirect)},
             basis.to_rgb(sample.body_albedo), sample.position, p.count - 1);
  move_mean(p.albedo, basis.to_rgb(sample.albedo), n);
  move_mean(p.irradiance, basis.to_rgb(sample.irradiance), n);
  p.normal += (sample.normal - p.normal) / n;
  if (sample.depth > 0.0f) {
    ++p.hits;
    p.depth += (sample.depth - p.depth) / static_cast<float>(p.hits);
  }
}

template void Film::add<1>(int, int, const PixelSample<1>&, const material::SpectralBasis&,
                           scene::Counters&);
template void Film::add<3>(int, int, const PixelSample<3>&, const material::SpectralBasis&,
                           scene::Counters&);
template void Film::add<4>(int, int, const PixelSample<4>&, const material::SpectralBasis&,
                           scene::Counters&);
template void Film::add<8>(int, int, const PixelSample<8>&, const material::SpectralBasis&,
                           scene::Counters&);

void Film::share() {
  if (bodies_.empty()) return;
  ShareGuides guides{width_, height_, {}, {}, {}};
  std::array<Illumination, 2> parts;
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& p = pixels_[i];
    const Body& body = bodies_[i];
    // A pixel that only partly shows a body keeps its own samples.
    const bool usable = p.count > 1 && p.hits == p.count && body.albedo.min() > 1e-4f;
    guides.position.push_back(body.position);
    guides.normal.push_back(p.normal);
    guides.depth.push_back(usable ? p.depth : 0.0f);
    const float y = luminance(body.albedo);
    const auto n = static_cast<float>(p.count);
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t h = 0; h < 2; ++h)
        parts[k].half[h].push_back(
            usable ? Rgb::generate([&](int c) { return body.radiance[k][h][c] / body.albedo[c]; })
                   : Rgb::zero());
      parts[k].variance.push_back(usable ? 2.0f * body.m2[k] / (n * (n - 1.0f) * y * y) : 0.0f);
    }
  }
  const std::array<std::vector<float>, 2> before{parts[0].variance, parts[1].variance};
  for (Illumination& part : parts) part = share_illumination(guides, std::move(part));
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    if (guides.depth[i] > 0.0f) put_shared(i, parts, {before[0][i], before[1][i]});
}

void Film::put_shared(std::size_t i, const std::array<Illumination, 2>& parts,
                      const std::array<float, 2>& before) {
  Pixel& p = pixels_[i];
  const Body& body = bodies_[i];
  const double y = static_cast<double>(luminance(body.albedo));
  const double n = p.count;
  const float even = static_cast<float>(body.count[0]) / static_cast<float>(p.count);
  double all = 0.0, less = 0.0;  // variance of the mean: of the pixel, and what sharing takes away
  for (std::size_t c = 0; c < 3; ++c) all += p.m2[c] / (n * (n - 1.0)) / 3.0;
  for (std::size_t k = 0; k < 2; ++k) {
    const Rgb shared = parts[k].half[0][i] * even + parts[k].half[1][i] * (1.0f - even);
    const Rgb change = shared * body.albedo - body.mean[k];
    for (std::size_t c = 0; c < 3; ++c)
      p.mean[c] += static_cast<double>(change[static_cast<int>(c)]);
    const Term term = k == 0 ? Term::DirectReflection : Term::IndirectReflection;
    if (!terms_.empty()) terms_[i][static_cast<std::size_t>(term)] += change;
    less += 0.5 * y * y * static_cast<double>(before[k] - parts[k].variance[i]);  // two halves
  }
  const double kept = all > 0.0 ? std::clamp(1.0 - less / all, 0.01, 1.0) : 1.0;
  for (double& m2 : p.m2) m2 *= kept;
}

scene::Image Film::image() const {
  static constexpr const char* kRgb[3] = {"R", "G", "B"};
  static constexpr const char* kXyz[3] = {"X", "Y", "Z"};
  static constexpr const char* kTermNames[kTerms] = {"C1", "C2", "C3",      "C4",
                                                     "C5", "C6", "emission"};
  scene::Image image;
  image.width = width_;
  image.height = height_;
  const auto name = [&](const std::string& layer, const char* const(&parts)[3]) {
    for (const char* part : parts) image.channels.push_back(layer + "." + part);
  };
  for (const char* c : kRgb) image.channels.emplace_back(c);
  name("stderr", kRgb);
  name("albedo", kRgb);
  name("irradiance", kRgb);
  name("normal", kXyz);
  image.channels.emplace_back("depth.Z");
  if (!terms_.empty())
    for (const char* t : kTermNames) name(t, kRgb);

  image.pixels.reserve(pixels_.size() * image.channels.size());
  const auto put = [&](const Rgb& c) {
    image.pixels.insert(image.pixels.end(), c.lane.begin(), c.lane.end());
  };
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& p = pixels_[i];
    Rgb error;
    for (int c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(c);
      const double n = p.count;
      error[c] = p.count > 1 ? static_cast<float>(std::sqrt(p.m2[k] / (n * (n - 1.0)))) : 0.0f;
    }
    put(make_rgb(p.mean[0], p.mean[1], p.mean[2]));
    put(error);
    put(p.albedo);
    put(p.irradiance);
    put(make_rgb(static_cast<double>(p.normal.x()), static_cast<double>(p.normal.y()),
                 static_cast<double>(p.normal.z())));
    image.pixels.push_back(p.depth);
    if (!terms_.empty())
      for (const Rgb& t : terms_[i]) put(t);
  }
  return image;
}

double Film::error_estimate() const {
  double variance = 0.0, mean = 0.0;
  for (const Pixel& p : pixels_) {
    if (p.count < 2) continue;
    const double n = p.count;
    for (std::size_t c = 0; c < 3; ++c) {
      variance += p.m2[c] / (n * (n - 1.0));
      mean += p.mean[c];
    }
  }
  const double channels = 3.0 * static_cast<double>(pixels_.size());
  mean /= channels;
  return mean > 0.0 ? std::sqrt(variance / channels) / mean : 0.0;
}

}  // namespace atrium::trace
