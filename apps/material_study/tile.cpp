#include "material_study/tile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/features.h"
#include "scene/ray_query.h"
#include "trace/tone_map.h"
#ifdef ATRIUM_WITH_RADIOSITY
#include "radiosity/solve.h"
#endif

namespace atrium::study {

namespace {

using scene::Image;

scene::SurfaceField ambient_light([[maybe_unused]] const scene::RayQuery& query,
                                  [[maybe_unused]] const material::SpectralBasis& basis,
                                  [[maybe_unused]] const TileOptions& options,
                                  [[maybe_unused]] const scene::Control& control) {
#ifdef ATRIUM_WITH_RADIOSITY
  radiosity::SolveOptions o;
  // Effort in step with that of the picture.
  const auto samples = static_cast<std::uint32_t>(std::clamp(options.samples, 2, 64));
  o.max_elements = std::max(200U, std::min(1500U, 40 * samples));
  o.row_rays = 32;
  o.gather_rays = 32;
  o.direct_samples = 8;
  o.caustic_photons = 20000 * samples / 64;
  o.seed = options.seed;
  o.paper_weights = true;
  return radiosity::solve(query, basis, o, {.progress = {}, .stop = control.stop}).field;
#else
  return {};
#endif
}

std::vector<bool> pixels_of_subject(const scene::RayQuery& query, const scene::Camera& camera,
                                    const TileOptions& o) {
  std::vector<bool> mask;
  scene::Counters counters;
  for (int y = 0; y < o.height; ++y)
    for (int x = 0; x < o.width; ++x) {
      const Vec2d film((x + 0.5) / o.width, (y + 0.5) / o.height);
      const auto ray = camera.ray(film, double{1} * o.width / o.height);
      const auto hit = query.closest({.origin = ray.origin, .direction = ray.direction}, counters,
                                     scene::Counter::RaysPrimary);
      mask.push_back(hit && hit->object.value == 0);
    }
  return mask;
}

std::size_t index(const Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
         static_cast<std::size_t>(x);
}

std::array<double, 3> rgb(const Image& image, int x, int y) {
  return {static_cast<double>(image.at(x, y, 0)), static_cast<double>(image.at(x, y, 1)),
          static_cast<double>(image.at(x, y, 2))};
}

double luminance(const std::array<double, 3>& c) {
  return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

Image mean_of(const RenderedTile& tile) {
  Image mean = tile.half[0];
  for (std::size_t i = 0; i < mean.pixels.size(); ++i)
    mean.pixels[i] = 0.5f * (mean.pixels[i] + tile.half[1].pixels[i]);
  return mean;
}

/// Per pixel, what `atrium compare` divides a difference by.
std::vector<double> scales(const Image& reference) {
  std::vector<double> Y, lit;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      Y.push_back(luminance(rgb(reference, x, y)));
      if (Y.back() > 0.0) lit.push_back(Y.back());
    }
  const auto middle = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2);
  if (!lit.empty()) std::nth_element(lit.begin(), middle, lit.end());
  const double floor = lit.empty() ? 1.0 : 0.05 * *middle;
  std::vector<double> scale;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      double sum = 0.0;
      int count = 0;
      for (int v = std::max(0, y - 2); v <= std::min(reference.height - 1, y + 2); ++v)
        for (int u = std::max(0, x - 2); u <= std::min(reference.width - 1, x + 2); ++u, ++count)
          sum += Y[index(reference, u, v)];
      scale.push_back(sum / count + floor);
    }
  return scale;
}

}  // namespace

RenderedTile render_tile(Stage stage, const material::Material& material, trace::Mode mode,
                         const material::SpectralBasis& basis, const TileOptions& o,
                         const scene::Control& control) {
  const scene::Scene scene =
      scene::build_scene(make_stage(stage, material), {.pane_detection = false, .view = {}});
  const scene::RayQuery query(scene);
  const bool paper = mode == trace::Mode::Paper;
  const scene::SurfaceField field =
      paper ? ambient_light(query, basis, o, control) : scene::SurfaceField{};
  trace::RenderOptions render;
  render.method = paper ? trace::Method::Hybrid : trace::Method::Path;
  render.mode = mode;
  render.indirect = trace::Indirect::Mesh;
  render.share_samples = false;
  render.width = o.width;
  render.height = o.height;
  render.samples = std::max(1, o.samples / 2);

  RenderedTile tile;
  tile.exposure = exposure_of(stage);
  tile.subject = pixels_of_subject(query, scene.cameras.at(0), o);
  for (std::uint64_t i = 0; i < 2; ++i) {
    render.seed = 2 * o.seed + i;
    trace::RenderResult result = trace::render(query, basis, scene.cameras.at(0), field, render,
                                               {.progress = {}, .stop = control.stop});
    tile.complete &= result.complete;
    tile.half[i] = scene::select_channels(result.image, {"R", "G", "B"});
  }
  return tile;
}

plot::Tile show(const RenderedTile& tile) {
  const Image mapped = trace::tone_map(mean_of(tile), {.ev = tile.exposure});
  plot::Tile out{mapped.width, mapped.height, {}};
  for (int y = 0; y < mapped.height; ++y)
    for (int x = 0; x < mapped.width; ++x)
      for (const double v : rgb(mapped, x, y))
        // Six bits, below the noise: files of half the size.
        out.rgb.push_back(static_cast<unsigned char>(std::lround(63.0 * v) * 255 / 63));
  return out;
}

ImageDifference difference(const RenderedTile& image, const RenderedTile& reference) {
  const Image mean = mean_of(reference);
  const std::vector<double> scale = scales(mean);
  double error2 = 0.0, error4 = 0.0, square = 0.0, noise2 = 0.0, sum = 0.0, Y_image = 0.0,
         Y_reference = 0.0;
  std::size_t count = 0;
  for (int y = 0; y < mean.height; ++y)
    for (int x = 0; x < mean.width; ++x) {
      const std::size_t pixel = index(mean, x, y);
      if (!reference.subject[pixel]) continue;
      const auto a = rgb(image.half[0], x, y), b = rgb(image.half[1], x, y);
      const auto ra = rgb(reference.half[0], x, y), rb = rgb(reference.half[1], x, y);
      double pixel_error = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double product = (a[c] - ra[c]) * (b[c] - rb[c]);
        square += product;
        pixel_error += product / (scale[pixel] * scale[pixel]) / 3.0;
        noise2 += 0.25 * (a[c] - b[c]) * (a[c] - b[c]) / (scale[pixel] * scale[pixel]);
        sum += 0.5 * (ra[c] + rb[c]);
      }
      error2 += pixel_error;
      error4 += pixel_error * pixel_error;
      Y_image += 0.5 * (luminance(a) + luminance(b));
      Y_reference += 0.5 * (luminance(ra) + luminance(rb));
      ++count;
    }
  const double pixels = static_cast<double>(std::max<std::size_t>(count, 1)), n = 3.0 * pixels;
  ImageDifference d;
  const double mean2 = error2 / pixels;  // of the square; pixels are independent
  const double deviation = std::sqrt(std::max(0.0, error4 / pixels - mean2 * mean2) / pixels);
  d.error = std::sqrt(std::max(0.0, mean2));
  d.low = std::sqrt(std::max(0.0, mean2 - 1.96 * deviation));
  d.high = std::sqrt(std::max(0.0, mean2) + 1.96 * deviation);
  d.rmse = std::sqrt(std::max(0.0, square / n)) * n / sum;
  d.bias = Y_image / Y_reference - 1.0;
  d.noise = std::sqrt(noise2 / n);
  return d;
}

}  // namespace atrium::study
