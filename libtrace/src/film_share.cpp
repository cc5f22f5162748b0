// How a film's pixels share the samples of the light that bodies send.
#include <algorithm>
#include <cmath>

#include "error_scale.h"
#include "film.h"
#include "for_pixels.h"
#include "share_choice.h"

namespace atrium::trace {
namespace {

constexpr int kBesideField = 1;  // levels of what the field lacks; more of them are hardly chosen

Rgb illumination_of(const Rgb& radiance, const Rgb& albedo, float unit) {
  return Rgb::generate([&](int c) { return radiance[c] / unit / albedo[c]; });
}

}  // namespace

// A pixel that only partly shows a body keeps its own samples.
bool Film::usable(std::size_t i) const {
  const Pixel& p = pixels_[i];
  return std::all_of(p.replicate_count.begin(), p.replicate_count.end(),
                     [](std::uint32_t n) { return n > 0; }) &&
         p.hits == p.count && bodies_[i].albedo.min() > 1e-4f;
}

ShareGuides Film::guides() const {
  ShareGuides g{width_, height_};
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    g.add(bodies_[i].position, Vec3f(pixels_[i].normal.data()),
          usable(i) ? pixels_[i].depth : 0.0f);
  return g;
}

// A power of two that brings the brightest pixel below 1: squares are numbers whatever the unit.
float Film::light_unit() const {
  double most = 0.0;
  for (const Pixel& p : pixels_) most = std::max({most, p.mean[0], p.mean[1], p.mean[2]});
  return most > 0.0 ? static_cast<float>(std::exp2(std::ceil(std::log2(most)))) : 1.0f;
}

Illumination Film::illumination(const ShareGuides& where, std::size_t part, float unit) const {
  Illumination light;
  for (std::vector<Rgb>& replicate : light.replicate) replicate.resize(pixels_.size());
  light.variance.resize(pixels_.size());
  for_pixels(width_, height_, [&](int, int, std::size_t i) {
    if (!where.shows_body(i)) return;
    const Body& body = bodies_[i];
    for (std::size_t r = 0; r < kReplicates; ++r)
      light.replicate[r][i] = illumination_of(body.radiance[part][r], body.albedo, unit);
    const double y = static_cast<double>(luminance(body.albedo)) * static_cast<double>(unit);
    const double n = pixels_[i].count;
    light.variance[i] = static_cast<float>(2.0 * body.m2[part] / (n * (n - 1.0) * y * y));
  });
  return light;
}

// What illumination that is wrong by one unit means for the error of the picture, by pixel.
std::vector<Rgb> Film::share_weights(float unit) const {
  std::vector<double> y;
  for (const Pixel& p : pixels_)
    y.push_back(std::max(0.0, 0.2126 * p.mean[0] + 0.7152 * p.mean[1] + 0.0722 * p.mean[2]));
  const std::vector<double> scale = error_scales(width_, height_, y);
  std::vector<Rgb> weights(pixels_.size());
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    if (scale[i] > 0.0)
      weights[i] = bodies_[i].albedo * static_cast<float>(static_cast<double>(unit) / scale[i]);
  return weights;
}

// What the field alone says of a pixel; empty if none was read.
std::vector<Rgb> Film::field_illumination(const ShareGuides& where, float unit) const {
  if (std::none_of(bodies_.begin(), bodies_.end(),
                   [](const Body& body) { return body.field.max() > 0.0f; }))
    return {};
  std::vector<Rgb> field(pixels_.size());
  for_pixels(width_, height_, [&](int, int, std::size_t i) {
    if (where.shows_body(i))
      field[i] = illumination_of(bodies_[i].field, bodies_[i].albedo, unit);
  });
  return field;
}

// The field is of elements that have noise of their own. What samples find beside it has the shape
// of that noise, so on an even wall more can be shared of the whole light. Where nothing is large
// enough to have neighbours the field alone may be better than few samples.
void Film::offer_by_field(const ShareGuides& where, const std::vector<Rgb>& field,
                          const Illumination& own, ShareChoice& choice) const {
  Illumination whole = own;
  for_pixels(width_, height_, [&](int, int, std::size_t i) {
    for (std::vector<Rgb>& replicate : whole.replicate) replicate[i] += field[i];
  });
  share_by_levels(where, whole, kShareLevels, [&](Illumination&& shared) {
    for_pixels(width_, height_, [&](int, int, std::size_t i) {
      for (std::vector<Rgb>& replicate : shared.replicate) replicate[i] -= field[i];
    });
    choice.offer(shared);
  });
  Illumination& nothing = whole;
  for (std::vector<Rgb>& replicate : nothing.replicate)
    std::fill(replicate.begin(), replicate.end(), Rgb::zero());
  choice.offer(nothing);
}

void Film::share() {
  const ShareGuides where = guides();
  const std::vector<std::uint8_t> kinds = surface_kinds(where);
  const float unit = light_unit();
  const std::vector<Rgb> weights = share_weights(unit);
  const std::vector<Rgb> field = field_illumination(where, unit);
  changes_.assign(pixels_.size(), {});
  for (std::size_t part = 0; part < kParts; ++part) {
    const Illumination own = illumination(where, part, unit);
    const bool by_field = part == kIndirect && !field.empty();
    ShareChoice choice(where, kinds, weights, own);
    share_by_levels(where, own, by_field ? kBesideField : kShareLevels,
                    [&](Illumination&& shared) { choice.offer(shared); });
    if (by_field) offer_by_field(where, field, own, choice);
    for (const std::size_t half : {0U, 1U})
      for_pixels(width_, height_, [&](int, int, std::size_t i) {
        if (choice.taken(half, i) && where.shows_body(i))
          take_shared(i, part, half, choice.best(), unit);
      });
  }
}

void Film::take_shared(std::size_t i, std::size_t part, std::size_t half, const Illumination& light,
                       float unit) {
  const Body& body = bodies_[i];
  for (const std::size_t r : {2 * half, 2 * half + 1}) {
    const Rgb change = light.replicate[r][i] * body.albedo * unit - body.radiance[part][r];
    changes_[i].replicate[r] += change;
    changes_[i].part[part] += change * (static_cast<float>(pixels_[i].replicate_count[r]) /
                                        static_cast<float>(pixels_[i].count));
  }
}

}  // namespace atrium::trace
