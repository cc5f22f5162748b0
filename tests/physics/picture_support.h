#pragma once

#include <cmath>
#include <string>

#include "support/scenes.h"
#include "trace/render.h"

// Pictures of small scenes and what they say as one number.
namespace atrium::trace {

inline scene::Camera camera_at(const Vec3d& eye, const Vec3d& target, double yfov) {
  scene::Camera c;
  c.to_scene = scene::look_at(eye, target, Vec3d::UnitY());
  c.yfov = yfov;
  return c;
}

// Cameras are given in world coordinates; the scene is rebased to its centre.
inline scene::Camera in_scene(scene::Camera c, const scene::Scene& scene) {
  c.to_scene.translation() -= scene.origin;
  return c;
}

struct Picture {
  double mean = 0.0;   // of G over all pixels
  double error = 0.0;  // standard error of that mean
  RenderResult result;
};

inline Picture picture(const scene::Scene& scene, const scene::Camera& camera,
                       const RenderOptions& o,
                       const material::SpectralBasis& basis = material::SpectralBasis::rgb()) {
  const scene::RayQuery query(scene, {"isa=avx2"});
  Picture p;
  p.result = render(query, basis, in_scene(camera, scene), {}, o);
  const scene::Image& image = p.result.image;
  const int g = image.channel_index("G"), e = image.channel_index("stderr.G");
  double variance = 0.0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      p.mean += static_cast<double>(image.at(x, y, g));
      variance += std::pow(static_cast<double>(image.at(x, y, e)), 2.0);
    }
  const double n = image.width * image.height;
  p.mean /= n;
  p.error = std::sqrt(variance) / n;
  return p;
}

inline RenderOptions path_options(int size, int samples) {
  RenderOptions o;
  o.method = Method::Path;
  o.width = o.height = size;
  o.samples = samples;
  return o;
}

/// Mean luminance of a class of light paths over a picture, with its standard error.
struct Layer {
  double mean = 0.0, error = 0.0;
};
inline Layer layer(const scene::Image& image, std::string_view name) {
  Layer r;
  const int first = image.channel_index(std::string(name) + ".R");  // G and B follow
  const int e = image.channel_index("stderr." + std::string(name) + ".Y");
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      r.mean += static_cast<double>(
          luminance(Rgb::generate([&](int c) { return image.at(x, y, first + c); })));
      r.error += std::pow(static_cast<double>(image.at(x, y, e)), 2.0);
    }
  const double n = image.width * image.height;
  return {r.mean / n, std::sqrt(r.error) / n};
}

}  // namespace atrium::trace
