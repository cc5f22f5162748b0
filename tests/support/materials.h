#pragma once

#include "material/material.h"

namespace atrium::testing {

/// A diffuse body under a glossy interface.
inline material::Material plastic() {
  material::Material m;
  m.combination = material::Material::Combination::Coupled;
  m.body_reflectance = 0.6;
  m.k_rg = 1.0;
  m.c = 8.0;
  return m;
}
inline material::Material mirror() {
  material::Material m;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  m.n = 0.2;
  m.kappa = 20.0;
  return m;
}
inline material::Material glass(material::Material::Medium medium) {
  material::Material m;
  m.medium = medium;
  m.k_df = 0.0;
  m.k_rg = m.k_tp_rg = 1.0;
  return m;
}

}  // namespace atrium::testing
