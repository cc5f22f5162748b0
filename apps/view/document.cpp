#include "document.h"

#include <algorithm>

#include "loaded_scene.h"
#include "material/error.h"
#include "scene/output_file.h"
#include "scene/solution_io.h"

#ifdef ATRIUM_WITH_RADIOSITY
#include "radiosity/export_mesh.h"
#include "solved_mesh.h"
#endif

namespace atrium::view {
namespace {

bool is_solution(const std::string& file) { return scene::file_ending(file) == ".atrium"; }

/// The mesh or the solution among the files, and the scene files.
struct Files {
  std::string mesh, solution;
  std::vector<std::string> scenes;

  explicit Files(const std::vector<std::string>& all) {
    for (const std::string& f : all)
      if (is_mesh_file(f))
        mesh = f;
      else if (is_solution(f))
        solution = f;
      else
        scenes.push_back(f);
  }
};

void name_things(const scene::Scene& scene, Mesh& mesh) {
  if (mesh.materials.empty())
    for (const material::Material& m : scene.materials) mesh.materials.push_back(m.name);
  if (mesh.objects.empty())
    for (const scene::Object& o : scene.objects) mesh.objects.push_back(o.name);
}

#ifdef ATRIUM_WITH_RADIOSITY

/// A mesh and what stands beside it.
void show(const LoadedScene& loaded, const radiosity::Elements& elements,
          const scene::SurfaceField& field, std::span<const scene::GroupField> groups,
          Document& document) {
  document.mesh = mesh_of(loaded, elements, field, groups);
  document.things = plain_things(loaded, document.mesh, groups);
}

void read_solution(const LoadedScene& loaded, const std::string& file, Document& document) {
  const scene::Solution solution = scene::read_solution(file);
  std::string basis = loaded.basis.describe();
  if (solution.basis == basis + ", paper mode") basis = solution.basis;
  scene::check_solution(solution, *loaded.scene, basis, file);
  const radiosity::Elements elements = radiosity::elements_of_field(*loaded.scene, solution.field);
  show(loaded, elements, solution.field, solution.groups, document);
}

void solve(const LoadedScene& loaded, const SolveChoice& choice, const scene::Control& control,
           const std::function<void(const std::string&)>& warn, Document& document) {
  require_light(loaded);
  const radiosity::SolveResult r =
      radiosity::solve(*loaded.query, loaded.basis, solve_options(choice), control);
  if (choice.error > 0.0 && r.stopped_by != "error")
    warn("the error asked for was not reached: stopped by " + r.stopped_by);
  show(loaded, r.elements, r.field, r.groups, document);
}

#endif

void make_mesh_of(const LoadedScene& loaded, const Files& files, const ViewCommand& command,
                  const scene::Control& control,
                  const std::function<void(const std::string&)>& warn, Document& document) {
#ifdef ATRIUM_WITH_RADIOSITY
  if (files.solution.empty())
    solve(loaded, command.solve, control, warn, document);
  else
    read_solution(loaded, files.solution, document);
#else
  static_cast<void>(loaded), static_cast<void>(files), static_cast<void>(command);
  static_cast<void>(control), static_cast<void>(warn), static_cast<void>(document);
  throw RuntimeFailure("radiosity is not part of this build (ATRIUM_WITH_OPENMESH was off)");
#endif
}

}  // namespace

void add_standard_views(const Mesh& mesh, double aspect, std::vector<ViewPoint>& views) {
  views.push_back(overview(mesh, aspect));
  views.push_back(plan(mesh, aspect));
}

Document load_document(const ViewCommand& command, const scene::Control& control,
                       const std::function<void(const std::string&)>& warn) {
  const Files files(command.files);
  Document document;
  document.title = command.files.front();
  if (!files.mesh.empty()) document.mesh = read_mesh(files.mesh);
  if (!files.scenes.empty()) {
    LoadedScene loaded = load_scene(files.scenes, command.solve);
    warn_of_scene(*loaded.scene, warn);
    if (files.mesh.empty()) {
      make_mesh_of(loaded, files, command, control, warn, document);
    } else {
      name_things(*loaded.scene, document.mesh);
      document.things =
          plain_things(loaded, document.mesh, groups_named(*loaded.scene, document.mesh.groups));
    }
    document.views = std::move(loaded.views);
  } else if (files.mesh.empty()) {
    throw Error(files.solution + ": a solution is shown together with its scene: atrium-view " +
                files.solution + " SCENE");
  }
  add_standard_views(document.mesh, static_cast<double>(command.size[0]) / command.size[1],
                     document.views);
  return document;
}

}  // namespace atrium::view
