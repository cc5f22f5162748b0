#pragma once

#include "trace/render.h"

namespace atrium::trace {

/// Adds the picture of one more pack of wavelength bands (SpectralBasis::packs()) to a picture of
/// the same view, size, samples and seed. Colours and terms add up; normal and depth stay. Packs
/// share their random numbers, so their errors are taken to agree: stderr.* add up too, which is an
/// upper bound.
void add_pack(RenderResult& sum, const RenderResult& pack);

}  // namespace atrium::trace
