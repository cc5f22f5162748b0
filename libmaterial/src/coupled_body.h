#pragma once

#include <memory>

#include "material/bsdf.h"

namespace atrium::material {

/// B(mu) of a coupled material, by quadrature with the Fresnel form and the masking that the lobe
/// itself is evaluated with, so that lobe and body together never exceed 1.
template <int N>
[[nodiscard]] std::shared_ptr<const CoupledBody<N>> tabulate_body(
    const ResolvedMaterial<N>& resolved);

}  // namespace atrium::material
