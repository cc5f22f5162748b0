#include "state_head.h"

#include <cstdio>

namespace atrium::radiosity {

using scene::SurfaceField;

namespace {

/// The options that decide which samples are drawn.
std::string describe(const SolveOptions& o) {
  std::string text = "seed " + std::to_string(o.seed);
  const auto add = [&](const char* name, double value) {
    char number[40];
    std::snprintf(number, sizeof number, "%.17g", value);
    text += std::string(", ") + name + " " + number;
  };
  add("element_size", o.element_size);
  add("max_elements", o.max_elements);
  add("max_level", o.max_level);
  add("mesh_error", o.mesh_error);
  add("row_rays", o.row_rays);
  add("gather_rays", o.gather_rays);
  add("direct_samples", o.direct_samples);
  add("caustic_photons", static_cast<double>(o.caustic_photons));
  add("paper_weights", o.paper_weights ? 1 : 0);
  return text;
}

std::string names_of(const scene::LightGroups& groups) {
  std::string text;
  for (const std::string& name : groups.names) text += " '" + name + "'";
  return text;
}

/// FNV-1a.
std::uint64_t members_of(const scene::LightGroups& groups) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const std::uint32_t g : groups.group) hash = (hash ^ g) * 0x100000001b3U;
  return hash;
}

}  // namespace

StateHead head_of(const scene::Scene& scene, const material::SpectralBasis& basis,
                  const SolveOptions& options) {
  const scene::LightGroups groups = scene::find_light_groups(scene, options.light_groups);
  return {.scene = scene::hash_parts(scene),
          .basis = basis.describe(),
          .options = describe(options),
          .group_names = names_of(groups),
          .group_members = members_of(groups),
          .lights = scene.lights};
}

Changed check(const StateHead& was, const StateHead& is) {
  const std::string solution = "radiosity: the solution to go on from ";
  if (was.scene.geometry != is.scene.geometry)
    throw Error(solution + "is of other geometry: surfaces were moved, added or removed");
  if (was.scene.materials != is.scene.materials)
    throw Error(solution + "is of other materials: more than reflectances and emission differs");
  if (was.basis != is.basis) throw Error(solution + "has " + was.basis + ", not " + is.basis);
  if (was.options != is.options)
    throw Error(solution + "was made with " + was.options + "; not " + is.options);
  if (was.group_names != is.group_names)
    throw Error(solution + "has the light groups" + was.group_names + ", not" + is.group_names);
  const Changed changed{.reflectance = was.scene.reflectance != is.scene.reflectance,
                        .lights = was.scene.lights != is.scene.lights,
                        .emission = was.scene.emission != is.scene.emission};
  if (!changed.light() && was.group_members != is.group_members)
    throw Error(solution + "has the same lights in other groups");
  return changed;
}

Elements elements_of(const scene::Scene& scene, Elements elements, const SurfaceField& field) {
  const auto differs = [&] {
    return Error("radiosity: the elements to go on with are not of this scene");
  };
  if (elements.layout.facets.size() != field.facets.size()) throw differs();
  for (int level = 0; level <= SurfaceField::kMaxLevel; ++level) {
    const SurfaceField& now = elements.layout;
    std::vector<std::uint8_t> split(now.element_count(), 0);
    bool any = false;
    for (std::uint32_t e = 0; e < now.element_count(); ++e) {
      const SurfaceField::Facet& facet = field.facets[now.element_facet[e]];
      const SurfaceField::Cell cell =
          field.cell(facet, now.element_level[e], now.element_x[e], now.element_y[e]);
      split[e] = SurfaceField::is_inner(cell.node) ? 1 : 0;
      any = any || split[e] != 0;
    }
    if (!any) break;
    elements = refine(scene, elements, split).elements;
  }
  const SurfaceField& now = elements.layout;
  if (now.nodes != field.nodes || now.cuts.size() != field.cuts.size() ||
      now.element_area != field.element_area || now.triangle_facet != field.triangle_facet)
    throw differs();
  return elements;
}

}  // namespace atrium::radiosity
