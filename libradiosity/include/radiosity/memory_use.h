#pragma once

#include <cstdint>

namespace atrium::radiosity {

/// Counted bytes of what a solve held, each part at its largest. Stacks, code and what the
/// allocator adds are not in it.
struct MemoryUse {
  std::uint64_t scene = 0;     ///< triangles and textures
  std::uint64_t bvh = 0;       ///< the ray tracer's copy of them and its hierarchy
  std::uint64_t elements = 0;  ///< with what finds points on them
  std::uint64_t samples = 0;   ///< sums of samples
  std::uint64_t photons = 0;   ///< while they wait for their places
  std::uint64_t rows = 0;      ///< with the copy that a round of rays needs
  std::uint64_t fields = 0;    ///< irradiance and what solving takes
  std::uint64_t peak = 0;      ///< of all together
};

}  // namespace atrium::radiosity
