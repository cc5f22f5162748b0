#include "film.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "for_pixels.h"

namespace atrium::trace {
namespace {

void move_mean(Rgb& mean, const Rgb& value, float n) { mean += (value - mean) / n; }

}  // namespace

Film::Film(int width, int height, const Contents& contents) : width_(width), height_(height) {
  const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  pixels_.resize(n);
  if (contents.checks) missed_.resize(n);
  if (contents.components) terms_.resize(n);
  if (contents.classes) classes_.emplace(n);
  if (contents.splats) splats_.emplace(n, contents.components, contents.classes);
  if (contents.shares) {
    bodies_.resize(n);
    changes_.resize(n);
  }
}

void Film::add_splats(const std::vector<Splat>& splats,
                      const std::array<std::uint64_t, kReplicates>& paths) {
  splats_->add(splats);
  splats_->count(paths);
}

template <int N>
void Film::add_body(Body& body, const Pixel& pixel, std::size_t replicate,
                    const PixelSample<N>& sample, const material::SpectralBasis& basis) {
  const std::array<Rgb, kParts> radiance{basis.to_rgb(sample.body_direct),
                                         basis.to_rgb(sample.body_indirect)};
  const auto n = static_cast<float>(pixel.count);
  for (std::size_t part = 0; part < kParts; ++part) {
    const double before =
        static_cast<double>(luminance(radiance[part]) - luminance(body.mean[part]));
    move_mean(body.mean[part], radiance[part], n);
    const double after =
        static_cast<double>(luminance(radiance[part]) - luminance(body.mean[part]));
    body.m2[part] += before * after;
    move_mean(body.radiance[part][replicate], radiance[part],
              static_cast<float>(pixel.replicate_count[replicate]));
  }
  move_mean(body.albedo, basis.to_rgb(sample.body_albedo), n);
  move_mean(body.field, basis.to_rgb(sample.body_field), n);
  body.position += (sample.position - body.position) / n;
}

template <int N>
void Film::add(int x, int y, std::size_t replicate, const PixelSample<N>& sample,
               const material::SpectralBasis& basis, scene::Counters& counters) {
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
  }
  move_mean(p.replicate[replicate], rgb, static_cast<float>(++p.replicate_count[replicate]));
  const auto n = static_cast<float>(p.count);
  if (!missed_.empty())
    move_mean(missed_[i][replicate], basis.to_rgb(sample.field_missed),
              static_cast<float>(p.replicate_count[replicate]));
  if (!terms_.empty())
    for (std::size_t t = 0; t < kTerms; ++t)
      move_mean(terms_[i][t], basis.to_rgb(sample.term[t]), n);
  if (classes_) {
    std::array<Rgb, kLightClasses> classes;
    for (std::size_t c = 0; c < kLightClasses; ++c)
      classes[c] = basis.to_rgb(sample.light_class[c]);
    classes_->add(i, replicate, classes, n, static_cast<float>(p.replicate_count[replicate]));
  }
  if (!bodies_.empty()) add_body(bodies_[i], p, replicate, sample, basis);
  move_mean(p.albedo, basis.to_rgb(sample.albedo), n);
  move_mean(p.irradiance, basis.to_rgb(sample.irradiance), n);
  for (std::size_t c = 0; c < 3; ++c)
    p.normal[c] += (sample.normal[static_cast<int>(c)] - p.normal[c]) / n;
  if (sample.depth > 0.0f) {
    ++p.hits;
    p.depth += (sample.depth - p.depth) / static_cast<float>(p.hits);
  }
}

template void Film::add<1>(int, int, std::size_t, const PixelSample<1>&,
                           const material::SpectralBasis&, scene::Counters&);
template void Film::add<3>(int, int, std::size_t, const PixelSample<3>&,
                           const material::SpectralBasis&, scene::Counters&);
template void Film::add<4>(int, int, std::size_t, const PixelSample<4>&,
                           const material::SpectralBasis&, scene::Counters&);
template void Film::add<8>(int, int, std::size_t, const PixelSample<8>&,
                           const material::SpectralBasis&, scene::Counters&);

Rgb Film::mean(std::size_t i) const {
  const Pixel& p = pixels_[i];
  Rgb mean = make_rgb(p.mean[0], p.mean[1], p.mean[2]);
  if (!changes_.empty())
    for (const Rgb& change : changes_[i].part) mean += change;
  if (splats_) mean += splats_->mean(i, kPictureLayer);
  return mean;
}

// E (x - y)^2 = s^2 (1/a + 1/b) for means of a and b samples; their joint mean has s^2 / (a + b)
// and weighs (a + b) / n.
float Film::replicate_factor(std::size_t i, std::size_t half) const {
  const Pixel& p = pixels_[i];
  const auto a = static_cast<float>(p.replicate_count[2 * half]);
  const auto b = static_cast<float>(p.replicate_count[2 * half + 1]);
  return p.count > 0 ? std::sqrt(a * b) / static_cast<float>(p.count) : 0.0f;
}

void Film::put_samples(std::size_t i, PictureSamples& samples) const {
  std::array<Rgb, kReplicates> value = pixels_[i].replicate;
  if (!changes_.empty())
    for (std::size_t r = 0; r < kReplicates; ++r) value[r] += changes_[i].replicate[r];
  samples.mean[i] = mean(i);
  if (!missed_.empty())
    for (std::size_t r = 0; r < kReplicates; ++r) samples.missed[r][i] = missed_[i][r];
  for (std::size_t h = 0; h < 2; ++h) {
    Rgb& deviation = samples.deviation[h][i];
    deviation = (value[2 * h] - value[2 * h + 1]) * replicate_factor(i, h);
    if (splats_) deviation += splats_->deviation(i, h);
    if (changes_.empty()) continue;
    for (std::size_t k = 0; k < 2; ++k) samples.change[h][k][i] = changes_[i].replicate[2 * h + k];
  }
}

PictureSamples Film::develop() {
  if (!bodies_.empty()) share();
  PictureSamples samples;
  samples.width = width_;
  samples.height = height_;
  samples.mean.resize(pixels_.size());
  for (auto& half : samples.deviation) half.resize(pixels_.size());
  if (!bodies_.empty())
    for (auto& half : samples.change)
      for (auto& replicate : half) replicate.resize(pixels_.size());
  if (!missed_.empty())
    for (auto& replicate : samples.missed) replicate.resize(pixels_.size());
  for_pixels(width_, height_, [&](int, int, std::size_t i) { put_samples(i, samples); });
  return samples;
}

Rgb Film::term(std::size_t i, std::size_t term) const {
  Rgb value = terms_[i][term];
  if (splats_) value += splats_->mean(i, layer_of(static_cast<Term>(term)));
  if (changes_.empty()) return value;
  if (term == static_cast<std::size_t>(Term::DirectReflection)) value += changes_[i].part[0];
  if (term == static_cast<std::size_t>(Term::IndirectReflection)) value += changes_[i].part[1];
  return value;
}

void Film::count_samples(int& least, double& mean) const {
  std::uint32_t fewest = pixels_.front().count;
  double sum = 0.0;
  for (const Pixel& p : pixels_) {
    fewest = std::min(fewest, p.count);
    sum += p.count;
  }
  least = static_cast<int>(fewest);
  mean = sum / static_cast<double>(pixels_.size());
}

Rgb Film::class_mean(std::size_t i, LightClass c) const {
  Rgb value = classes_->mean(i, c);
  if (splats_) value += splats_->mean(i, layer_of(c));
  return value;
}

float Film::class_error(std::size_t i, LightClass c) const {
  float squares = 0.0f;
  for (std::size_t h = 0; h < 2; ++h) {
    float d = classes_->difference(i, c, h) * replicate_factor(i, h);
    if (splats_) d += splats_->class_deviation(i, c, h);
    squares += d * d;
  }
  return std::sqrt(squares);
}

std::vector<std::string> Film::layer_names() const {
  static constexpr const char* kTermNames[kTerms] = {"C1", "C2", "C3",      "C4",
                                                     "C5", "C6", "emission"};
  std::vector<std::string> names{"R", "G", "B"};
  const auto add = [&](const std::string& layer, const char* parts) {
    for (; *parts != 0; ++parts) names.push_back(layer + "." + *parts);
  };
  add("stderr", "RGB");
  add("albedo", "RGB");
  add("irradiance", "RGB");
  add("normal", "XYZ");
  add("depth", "Z");
  add("samples", "N");
  if (!terms_.empty())
    for (const char* t : kTermNames) add(t, "RGB");
  if (classes_)
    for (const std::string_view c : kLightClassNames) {
      add(std::string(c), "RGB");
      add("stderr." + std::string(c), "Y");
    }
  return names;
}

scene::Image Film::image(const std::vector<Rgb>& error) const {
  scene::Image image;
  image.width = width_;
  image.height = height_;
  image.channels = layer_names();
  image.pixels.reserve(pixels_.size() * image.channels.size());
  const auto put = [&](const Rgb& c) {
    image.pixels.insert(image.pixels.end(), c.lane.begin(), c.lane.end());
  };
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& p = pixels_[i];
    put(mean(i));
    put(error[i]);
    put(p.albedo);
    put(p.irradiance);
    image.pixels.insert(image.pixels.end(), p.normal.begin(), p.normal.end());
    image.pixels.push_back(p.depth);
    image.pixels.push_back(static_cast<float>(p.count));
    if (!terms_.empty())
      for (std::size_t t = 0; t < kTerms; ++t) put(term(i, t));
    if (!classes_) continue;
    for (std::size_t c = 0; c < kLightClasses; ++c) {
      put(class_mean(i, static_cast<LightClass>(c)));
      image.pixels.push_back(class_error(i, static_cast<LightClass>(c)));
    }
  }
  return image;
}

}  // namespace atrium::trace
