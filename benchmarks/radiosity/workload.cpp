#include "workload.h"

#include <algorithm>

#include "scene/scene_io.h"

namespace atrium::bench {

Workload::Workload(std::string name, scene::Model model)
    : name_(std::move(name)),
      scene_(scene::build_scene(std::move(model))),
      query_(scene_),
      shading_(query_, basis()) {}

Workload::Workload(const std::filesystem::path& file)
    : Workload(file.stem().string(), scene::read_model({file})) {}

bool Workload::specular() const {
  return std::any_of(scene_.objects.begin(), scene_.objects.end(), [&](const scene::Object& o) {
    const material::MaterialTraits t = material::traits(scene_.materials[o.material.value]);
    return t.mirror || t.rough || t.transmits || t.pane || t.coupled;
  });
}

scene::Model darkened(scene::Model model) {
  for (material::Material& m : model.materials) m.body_reflectance = 1e-6;
  return model;
}

}  // namespace atrium::bench
