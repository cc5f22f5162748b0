#include "plain_colours.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace atrium::view {
namespace {

using scene::BakedModel;
using Kind = BakedModel::Material::Kind;

constexpr Colour kShines{255, 250, 235}, kBlack{12, 12, 12};

/// What surfaces send out, as radiosities; pictures in the mean.
Values radiosities(const BakedModel& model, const BakedModel::Primitive& p,
                   const std::vector<double>& factors) {
  const std::int32_t picture = model.materials[p.material].texture;
  const Rgb mean =
      picture >= 0 ? model.textures[static_cast<std::size_t>(picture)].mean_rgb() : Rgb(1.0f);
  Values values{Place::Points, 3, {}};
  for (std::size_t i = 0; i < p.positions.size(); ++i) {
    Rgb sum;
    for (std::size_t g = 0; g < p.groups.size(); ++g) {
      const double factor = factors.size() == p.groups.size() ? factors[g] : 1.0;
      sum += p.groups[g][i].radiance * static_cast<float>(factor * std::numbers::pi);
    }
    sum *= mean;
    values.numbers.insert(values.numbers.end(), sum.lane.begin(), sum.lane.end());
  }
  return values;
}

Colour display(const Rgb& c) {
  Values one{Place::Points, 3, {c[0], c[1], c[2]}};
  return surface_colours(one)[0];
}

}  // namespace

std::vector<Colour> plain_colours(const BakedModel& model, const BakedModel::Primitive& p,
                                  const std::vector<double>& factors,
                                  const std::optional<double>& ev) {
  const BakedModel::Material& m = model.materials[p.material];
  if (m.kind == Kind::Glass) return {p.positions.size(), display(m.color)};
  // A mirror seen plainly: grey with a little of its colour.
  if (m.kind == Kind::Metal) return {p.positions.size(), display(Rgb(0.25f) + 0.25f * m.color)};
  const Values values = radiosities(model, p, factors);
  if (ev) return tone_mapped(values, *ev);
  std::vector<Colour> colours;
  for (std::size_t i = 0; i < p.positions.size(); ++i) {
    const float* v = &values.numbers[3 * i];
    colours.push_back(v[0] + v[1] + v[2] > 0.0f ? kShines : kBlack);
  }
  return colours;
}

}  // namespace atrium::view
