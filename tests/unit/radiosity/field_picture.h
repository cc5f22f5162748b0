#pragma once

#include <numbers>

#include "radiosity/solve.h"
#include "scene/image.h"
#include "scene/ray_query.h"
#include "scene/shading.h"

namespace atrium::test {

/// What a camera would see of the field alone: (reflectance x interpolated irradiance + exitance) /
/// pi at the first surface, sheets that transmit left out. Samples in a grid of `side` x `side` per
/// pixel. Knows nothing of exported files.
template <int N>
scene::Image field_picture(const scene::RayQuery& query, const material::SpectralBasis& basis,
                           const scene::SurfaceField& field, const scene::Camera& camera, int width,
                           int height, int side = 3) {
  using scene::Side;
  const scene::Shading<N> shading(query, basis);
  scene::Counters counters;
  scene::Image image;
  image.width = width;
  image.height = height;
  image.channels = {"R", "G", "B"};
  const auto value_at = [&](double x, double y) {
    const auto r = camera.ray({x / width, y / height}, static_cast<double>(width) / height);
    const auto hit =
        shading.closest({r.origin, r.direction}, counters, scene::Counter::RaysPrimary);
    if (!hit) return Spectrum<N>();
    const scene::Interaction<N> at = shading.interact(*hit, -r.direction);
    Spectrum<N> sum = shading.lights().emitted(*hit, -r.direction);
    const auto stencil =
        field.stencil(query.scene(), hit->object, hit->triangle, hit->position, at.side);
    const auto e = field.interpolate<N>(field.irradiance.direct, stencil, at.side) +
                   field.interpolate<N>(field.irradiance.caustic, stencil, at.side) +
                   field.interpolate<N>(field.irradiance.indirect, stencil, at.side);
    return sum +
           at.bsdf.diffuse_reflectance(Vec3f(0, 0, 1)) * e * (1.0f / std::numbers::pi_v<float>);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Spectrum<N> sum;
      for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) sum += value_at(x + (i + 0.5) / side, y + (j + 0.5) / side);
      const Rgb c = basis.to_rgb<N>(sum * (1.0f / static_cast<float>(side * side)));
      image.pixels.insert(image.pixels.end(), c.lane.begin(), c.lane.end());
    }
  return image;
}

}  // namespace atrium::test
