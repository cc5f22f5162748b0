#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "mesh.h"
#include "options.h"
#include "plain_things.h"
#include "scene/control.h"
#include "view_point.h"

namespace atrium::view {

struct LoadedScene;

/// What is looked at: a mesh, and from where.
struct Document {
  Mesh mesh;
  std::vector<ViewPoint> views;  ///< of the scene, then overview and plan
  std::string title;
  PlainThings things;  ///< of the scene, beside the mesh
};

/// Adds overview and plan to views of a scene.
void add_standard_views(const Mesh& mesh, double aspect, std::vector<ViewPoint>& views);

/// Reads a mesh, with a scene for cameras and names or without; or reads a solution with its
/// scene; or solves a scene.
/// \param warn  is given lines for people.
/// \throws Error, RuntimeFailure.
[[nodiscard]] Document load_document(const ViewCommand& command, const scene::Control& control,
                                     const std::function<void(const std::string&)>& warn);

}  // namespace atrium::view
