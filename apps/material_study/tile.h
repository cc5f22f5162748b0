#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "material/spectral_basis.h"
#include "material_study/stage.h"
#include "material_study/subject.h"
#include "plot/plot.h"
#include "scene/control.h"
#include "scene/image.h"

namespace atrium::study {

struct TileOptions {
  int width = 80, height = 60;
  int samples = 64;  ///< of a pixel, even
  std::uint64_t seed = 1;
};

/// A small picture, computed twice with half of the samples each: what both halves of two pictures
/// agree on is difference, not noise.
struct RenderedTile {
  std::array<scene::Image, 2> half;  ///< linear R, G, B
  std::vector<bool> subject;         ///< pixels whose centre shows the object
  double exposure = 0.0;
  bool complete = true;  ///< false: interrupted
};

/// Path tracing with everything unbiased; paper mode, which is no BSDF, with radiosity for its
/// ambient terms.
[[nodiscard]] RenderedTile render_tile(Stage stage, const material::Material& material,
                                       trace::Mode mode, const material::SpectralBasis& basis,
                                       const TileOptions& options, const scene::Control& control);

/// For people: the mean of both halves, tone mapped with the exposure of the stage.
[[nodiscard]] plot::Tile show(const RenderedTile& tile);

/// How far a picture is from the reference, over the pixels of the object. Squares of differences
/// are products of those of independent halves: noise does not add to them.
struct ImageDifference {
  double error = 0.0;  ///< RMS of (I - R) / (Y5(R) + 0.05 median Y(R)), as `atrium compare`
  double low = 0.0, high = 0.0;  ///< its 95 % confidence interval
  double rmse = 0.0;             ///< RMS of I - R over the mean of R, all channels
  double bias = 0.0;             ///< mean Y(I) / mean Y(R) - 1
  double noise = 0.0;  ///< RMS noise of one picture as `error`: what a single one would add
};
[[nodiscard]] ImageDifference difference(const RenderedTile& image, const RenderedTile& reference);

}  // namespace atrium::study
