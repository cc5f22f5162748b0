#pragma once

#include <span>

#include "radiosity/elements.h"
#include "scene/baked_model.h"
#include "scene/light_groups.h"

namespace atrium::radiosity {

struct BakeOptions {
  bool group_light = false;  ///< radiance and illuminance by group at the vertices: for the page
  /// One primitive for all objects of a look; materials have no names, but "plain" if they belong
  /// to surfaces without elements. Else one per object and side, with its name.
  bool merge_objects = false;
  bool backdrop = false;  ///< the environment as a dome, named "sky"
  /// Edge of an atlas in texels, at least 16: surfaces with elements look their radiance up there,
  /// textures included, instead of having it at their vertices. 0: none. Not with group_light.
  std::uint32_t lightmap = 0;
};

/// The solved scene as viewers without light show it: triangles with their radiance.
///
/// Each side is a surface of its own, seen from that side only; sides of objects that no light
/// reaches are left out. Where both sides are there the back lies a little behind the front, for
/// viewers that see both sides of triangles. Corners have the values of mesh files' points.
///
/// What a surface reflects diffusely and emits is its radiance from everywhere; its gloss is not
/// kept. A colour texture is kept as a picture that multiplies (so is a picture that is emitted;
/// the other of the two terms is then divided by the picture's mean). Surfaces without elements are
/// emission (black lamps), black, a metal (mirrors) or glass.
///
/// \param groups  of the field, or empty: then it is one group, "all".
/// \throws std::invalid_argument  as to_polygon_mesh().
/// \throws Error  if an atlas is too small for the charts; says which size is not.
[[nodiscard]] scene::BakedModel bake(const scene::Scene& scene, const Elements& elements,
                                     const scene::SurfaceField& field,
                                     const material::SpectralBasis& basis,
                                     std::span<const scene::GroupField> groups = {},
                                     const BakeOptions& options = {});

/// What bake() would show beside the surfaces with elements: for every object without any, in their
/// order, one primitive (lamps that reflect nothing, black things, mirrors, metals, glass), and
/// last the environment as a dome named "sky", if the scene has one. Light is by group, too.
///
/// \param with_elements  by object: is there a baked surface of it already?
/// \param groups  names and factors count; empty: one group, "all".
/// \throws std::invalid_argument  if with_elements is of another scene.
/// \throws Error  if the scene's groups have other names.
[[nodiscard]] scene::BakedModel bake_plain(const scene::Scene& scene,
                                           const material::SpectralBasis& basis,
                                           const std::vector<std::uint8_t>& with_elements,
                                           std::span<const scene::GroupField> groups = {});

}  // namespace atrium::radiosity
