#pragma once

#include "material/bsdf.h"

namespace atrium::material {

/// The comparison model of a material in the lanes of a scene; null for the paper's facets. Needs
/// the resolved n, k, F(0) and body reflectance.
template <int N>
[[nodiscard]] std::shared_ptr<const ComparisonLobe<N>> resolve_lobe(
    const ResolvedMaterial<N>& resolved, const Material& material, const SpectralBasis& basis);

}  // namespace atrium::material
