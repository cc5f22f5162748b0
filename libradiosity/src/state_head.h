#pragma once

#include <cstdint>
#include <string>

#include "material/error.h"
#include "material/spectral_basis.h"
#include "radiosity/solve.h"

namespace atrium::radiosity {

/// What SolveResult::state belongs to; it stands in front of what the solver wrote.
struct StateHead {
  std::uint32_t version = 1;
  std::uint64_t scene = 0, but_reflectance = 0;
  std::string basis, options;
  double mesh_error = 0.0;

  template <class Archive>
  void archive(Archive& a) {
    a(version);
    if (version != 1) throw Error("radiosity: the solution's state is of another version");
    a(scene);
    a(but_reflectance);
    a(basis);
    a(options);
    a(mesh_error);
  }
};

[[nodiscard]] StateHead head_of(const scene::Scene& scene, const material::SpectralBasis& basis,
                                const SolveOptions& options);

/// \throws Error  if a solve cannot go on from there to here.
void check(const StateHead& was, const StateHead& is);

/// The elements of a field: those of level 0, divided as it says.
/// \throws Error  if that is not how they were made.
[[nodiscard]] Elements elements_of(const scene::Scene& scene, Elements elements,
                                   const scene::SurfaceField& field);

}  // namespace atrium::radiosity
