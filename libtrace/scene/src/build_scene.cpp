#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "material/error.h"
#include "mesh_repair.h"
#include "model_budget.h"
#include "pane_detection.h"
#include "scene/limits.h"
#include "scene/parallel.h"
#include "scene/scene.h"
#include "subdivision.h"

namespace atrium::scene {
namespace {

using material::Material;

constexpr std::size_t kSmallMesh = 64;          // triangles; below, sharing costs more than copies
constexpr std::size_t kLargestSlabMesh = 4096;  // shared solids above are not searched for panes

std::string name_of(const Material& m, std::size_t index) {
  return m.name.empty() ? "material " + std::to_string(index) : "material '" + m.name + "'";
}

// ---- what is checked before any work ----

void check_mesh(MeshData& mesh, LoadReport& report) {
  const std::size_t size = mesh.positions.size();
  for (const Triangle& t : mesh.triangles) {
    if (t[0] >= size || t[1] >= size || t[2] >= size) {
      throw Error("mesh '" + mesh.name + "': a triangle's vertex index is out of range (" +
                  std::to_string(size) + " vertices)");
    }
  }
  const auto fit = [&](auto& values, const char* what) {
    if (values.empty() || values.size() == size) return;
    report.warnings.push_back("mesh '" + mesh.name + "': " + what +
                              " do not match the vertices and are left out");
    values.clear();
  };
  fit(mesh.normals, "normals");
  fit(mesh.uvs, "texture coordinates");
  fit(mesh.colors, "colours");
}

/// Nodes that can be shown; the others are dropped with a warning.
std::vector<const Model::Node*> usable_nodes(const Model& model, LoadReport& report) {
  std::vector<const Model::Node*> out;
  for (const Model::Node& node : model.nodes) {
    if (node.mesh.value >= model.meshes.size() || node.material.value >= model.materials.size()) {
      throw Error("node '" + node.name + "': its mesh or material does not exist");
    }
    if (node.to_world.matrix().allFinite()) {
      out.push_back(&node);
    } else {
      report.warnings.push_back("node '" + node.name + "': transform is not finite, left out");
    }
  }
  return out;
}

void check_triangles(std::uint64_t triangles) {
  if (triangles > limits::kSceneTriangles)
    throw Error("the scene has more than " + std::to_string(limits::kSceneTriangles) +
                " triangles, those of every copy counted");
}

void tessellate_cages(Model& model, const BuildOptions& options, LoadReport& report) {
  std::vector<const Model::Node*> user(model.meshes.size(), nullptr);
  for (const Model::Node& node : model.nodes) {
    if (node.mesh.value < user.size() && user[node.mesh.value] == nullptr)
      user[node.mesh.value] = &node;
  }
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    MeshData& mesh = model.meshes[i];
    if (!mesh.cage || user[i] == nullptr) continue;
    mesh = tessellate(mesh, options.subdivision_error, user[i]->to_world, options.view);
    mesh.cage.reset();
    report.subdivision_triangles += mesh.triangles.size();
    check_triangles(report.subdivision_triangles);
  }
}

/// Copies share a mesh, but not all that is computed for a triangle.
void check_copies(const Model& model, const std::vector<const Model::Node*>& nodes) {
  std::uint64_t triangles = 0;
  for (const Model::Node* node : nodes) {
    triangles += model.meshes[node->mesh.value].triangles.size();
    check_triangles(triangles);
  }
}

// ---- where the scene's origin is ----

Bounds world_bounds(const Model& model, const std::vector<const Model::Node*>& nodes) {
  std::map<std::uint32_t, Bounds> local;  // exact boxes would need every vertex of every instance
  Bounds bounds;
  for (const Model::Node* node : nodes) {
    const auto [it, added] = local.try_emplace(node->mesh.value);
    if (added) {
      const MeshData& mesh = model.meshes[node->mesh.value];
      for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t) {
          if (mesh.positions[v].allFinite()) it->second.extend(mesh.positions[v]);
        }
      }
    }
    if (!it->second.isEmpty()) bounds.extend(it->second.transformed(node->to_world));
  }
  return bounds;
}

/// The centre, rounded to a coarse power of two: subtracting it is then exact for most coordinates
/// that a file gives in single precision, and round numbers stay round.
Vec3d scene_origin(const Bounds& bounds) {
  const double size = bounds.diagonal().norm();
  if (!(size > 0.0) || !std::isfinite(size)) return bounds.center();
  const double step = std::exp2(std::floor(std::log2(size)) - 4.0);
  return (bounds.center() / step).array().round() * step;
}

// ---- one mesh at one place (or local, if shared) ----

Mesh place(const MeshData& source, const Eigen::Affine3d& t) {
  Mesh out;
  out.name = source.name;
  out.positions.resize(source.positions.size());
  for (std::size_t i = 0; i < out.positions.size(); ++i) {
    out.positions[i] = (t * source.positions[i]).cast<float>();
  }
  out.uvs = source.uvs;
  out.colors = source.colors;
  out.triangles = source.triangles;
  const double determinant = t.linear().determinant();
  if (determinant != 0.0) {
    const Eigen::Matrix3d normal_matrix = t.linear().inverse().transpose();
    out.normals.resize(source.normals.size());
    for (std::size_t i = 0; i < out.normals.size(); ++i) {
      out.normals[i] =
          (normal_matrix * source.normals[i].cast<double>()).normalized().cast<float>();
    }
  }
  // A mirrored copy runs round the other way; its front stays the author's front.
  if (determinant < 0.0) {
    for (Triangle& triangle : out.triangles) std::swap(triangle[1], triangle[2]);
  }
  return out;
}

/// A mesh to make, for one node or for several that share it.
struct Job {
  MeshId source;
  MaterialId material;
  std::vector<std::size_t> nodes;  ///< indices into the usable nodes
  bool mirrored = false;
  bool shared = false;
  Vec3d local_origin = Vec3d::Zero();  ///< subtracted from shared meshes, so that floats suffice
  // Results
  Mesh mesh;
  std::vector<PaneSplit::Pane> panes;
  LoadReport report;
};

std::vector<Job> plan_jobs(const Model& model, const std::vector<const Model::Node*>& nodes,
                           const BuildOptions& options) {
  std::map<std::tuple<std::uint32_t, std::uint32_t, bool>, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool mirrored = nodes[i]->to_world.linear().determinant() < 0.0;
    groups[{nodes[i]->mesh.value, nodes[i]->material.value, mirrored}].push_back(i);
  }
  std::vector<Job> jobs;
  for (const auto& [key, members] : groups) {
    Job job;
    job.source = MeshId(std::get<0>(key));
    job.material = MaterialId(std::get<1>(key));
    job.mirrored = std::get<2>(key);
    const std::size_t triangles = model.meshes[job.source.value].triangles.size();
    const bool solid = model.materials[job.material.value].medium == Material::Medium::Solid;
    const bool search_panes = solid && options.pane_detection && triangles <= kLargestSlabMesh;
    bool regular = true;  // a flattened instance has no inverse
    for (const std::size_t i : members)
      regular = regular && nodes[i]->to_world.linear().determinant() != 0.0;
    if (members.size() > 1 && triangles > kSmallMesh && regular && !search_panes) {
      job.shared = true;
      job.nodes = members;
      jobs.push_back(std::move(job));
      continue;
    }
    for (const std::size_t i : members) {
      job.nodes = {i};
      jobs.push_back(job);
    }
  }
  return jobs;
}

/// Do the meshes fit that the jobs make, beside the model?
void check_memory(const std::vector<Job>& jobs, const Model& model, std::uint64_t limit) {
  if (limit == 0) return;
  std::uint64_t bytes = 0;
  for (const MeshData& mesh : model.meshes) bytes += bytes_of(mesh);
  for (const material::Texture& texture : model.textures) bytes += texture.pixels.size();
  for (const Job& job : jobs) bytes += bytes_of(model.meshes[job.source.value]);
  if (bytes > limit)
    throw RuntimeFailure("the scene needs " + megabytes(bytes) +
                         " while it is built; a memory limit of " + megabytes(limit) +
                         " does not hold it");
}

Vec3d centre_of(const MeshData& mesh) {
  Bounds bounds;
  for (const Vec3d& p : mesh.positions) {
    if (p.allFinite()) bounds.extend(p);
  }
  return bounds.isEmpty() ? Vec3d(Vec3d::Zero()) : Vec3d(bounds.center());
}

void run_job(Job& job, const Model& model, const std::vector<const Model::Node*>& nodes,
             const Vec3d& origin, const BuildOptions& options) {
  const MeshData& source = model.meshes[job.source.value];
  const Material& material = model.materials[job.material.value];
  const bool solid = material.medium == Material::Medium::Solid;
  if (job.shared) {
    job.local_origin = centre_of(source);
    job.mesh = place(source, Eigen::Affine3d(Eigen::Translation3d(-job.local_origin)));
    if (job.mirrored) {
      for (Triangle& t : job.mesh.triangles) std::swap(t[1], t[2]);
    }
    job.report.meshes_shared = 1;
  } else {
    const Eigen::Affine3d to_scene = Eigen::Translation3d(-origin) * nodes[job.nodes[0]]->to_world;
    job.mesh = place(source, to_scene);
  }
  job.report.triangles_read = source.triangles.size();
  const RepairRules rules{options.repair, material.emissive() && !material.emits_both_sides, solid};
  repair_mesh(job.mesh, rules, job.report);
  if (solid && options.pane_detection && !job.shared && material.smooth() && !material.emissive()) {
    PaneSplit split = split_panes(job.mesh);
    if (!split.panes.empty()) {
      job.mesh = std::move(split.rest);
      job.panes = std::move(split.panes);
      job.report.panes_recognised = job.panes.size();
    }
  }
}

// ---- panes made of solids ----

material::SpectralValue squared(const material::SpectralValue& value) {
  return std::visit(
      [](auto v) -> material::SpectralValue {
        using T = decltype(v);
        if constexpr (std::is_same_v<T, material::SampledSpectrum>) {
          for (double& x : v.value) x *= x;
          return v;
        } else {
          return v * v;
        }
      },
      value);
}

/// The sheet's material: a body's tint counts at both faces, a pane's once.
Material pane_material(const Material& solid, double thickness) {
  Material m = solid;
  m.medium = Material::Medium::Pane;
  m.pane_thickness = thickness;
  m.transmission_tint = squared(solid.transmission_tint);
  return m;
}

/// Scene under construction.
class Builder {
 public:
  explicit Builder(Scene& scene) : scene_(scene) {}
  void add(Job& job, const std::vector<const Model::Node*>& nodes);
  void number_triangles();
  void find_bounds();

 private:
  void add_object(const std::string& name, MeshId mesh, MaterialId material, const Job* shared,
                  const Model::Node& node);
  MaterialId pane_material_id(MaterialId solid, double thickness);

  Scene& scene_;
  std::map<std::pair<std::uint32_t, std::int64_t>, MaterialId> pane_materials_;
};

MaterialId Builder::pane_material_id(MaterialId solid, double thickness) {
  const auto steps = static_cast<std::int64_t>(std::llround(thickness * 1e5));  // hundredths of mm
  const auto [it, added] =
      pane_materials_.try_emplace({solid.value, steps}, MaterialId(scene_.materials.size()));
  if (added) scene_.materials.push_back(pane_material(scene_.materials[solid.value], thickness));
  return it->second;
}

void Builder::add_object(const std::string& name, MeshId mesh, MaterialId material,
                         const Job* shared, const Model::Node& node) {
  Object object;
  object.name = name;
  object.light_group = node.light_group;
  object.mesh = mesh;
  object.material = material;
  if (shared != nullptr) {
    object.instanced = true;
    const Eigen::Affine3d t = Eigen::Translation3d(-scene_.origin) * node.to_world *
                              Eigen::Translation3d(shared->local_origin);
    object.to_scene = t.cast<float>();
  }
  scene_.objects.push_back(std::move(object));
}

void Builder::add(Job& job, const std::vector<const Model::Node*>& nodes) {
  add_report(scene_.report, job.report);
  for (PaneSplit::Pane& pane : job.panes) {
    const MeshId id(scene_.meshes.size());
    scene_.meshes.push_back(std::move(pane.sheet));
    add_object(nodes[job.nodes[0]]->name, id, pane_material_id(job.material, pane.thickness),
               nullptr, *nodes[job.nodes[0]]);
  }
  if (job.mesh.triangles.empty()) return;
  const MeshId id(scene_.meshes.size());
  scene_.meshes.push_back(std::move(job.mesh));
  for (const std::size_t i : job.nodes) {
    add_object(nodes[i]->name, id, job.material, job.shared ? &job : nullptr, *nodes[i]);
  }
}

void Builder::number_triangles() {
  std::uint64_t first = 0;
  for (Object& object : scene_.objects) {
    object.first_triangle = first;
    first += scene_.meshes[object.mesh.value].triangles.size();
  }
}

void Builder::find_bounds() {
  scene_.bounds.setEmpty();
  for (const Object& object : scene_.objects) {
    const Mesh& mesh = scene_.meshes[object.mesh.value];
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) {
        const Vec3f p =
            object.instanced ? Vec3f(object.to_scene * mesh.positions[v]) : mesh.positions[v];
        scene_.bounds.extend(p.cast<double>());
      }
    }
  }
}

/// Triangles that lie at exactly the same three places as one of another object. By 64-bit hash of
/// the positions: an estimate that errs once in 1e19 pairs.
std::uint64_t count_twins(const Scene& scene) {
  struct Place {
    std::uint64_t hash;
    std::uint32_t object;
  };
  std::vector<Place> all;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (scene.objects[o].instanced) continue;
    const Mesh& mesh = scene.meshes[scene.objects[o].mesh.value];
    for (const Triangle& t : mesh.triangles) {
      std::uint64_t sum = 0;  // the same for any order of the corners
      for (const std::uint32_t v : t) {
        std::uint64_t h = 0x9E3779B97F4A7C15u;
        for (int k = 0; k < 3; ++k) {
          h = (h ^ std::bit_cast<std::uint32_t>(mesh.positions[v][k] + 0.0f)) * 0xBF58476D1CE4E5B9u;
          h ^= h >> 29;
        }
        sum += h * 0x94D049BB133111EBu;
      }
      all.push_back({sum, static_cast<std::uint32_t>(o)});
    }
  }
  std::sort(all.begin(), all.end(), [](const Place& a, const Place& b) {
    return a.hash != b.hash ? a.hash < b.hash : a.object < b.object;
  });
  std::uint64_t twins = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].hash == all[i - 1].hash && all[i].object != all[i - 1].object) ++twins;
  }
  return twins;
}

void move_to_origin(Scene& scene) {
  const Eigen::Affine3d shift(Eigen::Translation3d(-scene.origin));
  for (Light& light : scene.lights) light.to_scene = shift * light.to_scene;
  for (Camera& camera : scene.cameras) camera.to_scene = shift * camera.to_scene;
  for (std::vector<Vec3d>& polygon : scene.portals.polygons)
    for (Vec3d& corner : polygon) corner -= scene.origin;
}

}  // namespace

Scene build_scene(Model model, const BuildOptions& options) {
  Scene scene;
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    material::validate(model.materials[i], name_of(model.materials[i], i));
  }
  scene.report.warnings = model.warnings;
  tessellate_cages(model, options, scene.report);
  for (MeshData& mesh : model.meshes) check_mesh(mesh, scene.report);

  const std::vector<const Model::Node*> nodes = usable_nodes(model, scene.report);
  check_copies(model, nodes);
  const Bounds bounds = world_bounds(model, nodes);
  if (bounds.isEmpty()) throw Error("no geometry: the scene has no triangles");
  scene.origin = scene_origin(bounds);
  if (!scene.origin.allFinite()) throw Error("no usable geometry: its coordinates are too large");

  std::vector<Job> jobs = plan_jobs(model, nodes, options);
  check_memory(jobs, model, options.memory_limit);
  parallel_for(jobs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) run_job(jobs[i], model, nodes, scene.origin, options);
  });
  // Objects in the order of the nodes, whatever the order of the work.
  std::stable_sort(jobs.begin(), jobs.end(),
                   [](const Job& a, const Job& b) { return a.nodes[0] < b.nodes[0]; });

  scene.materials = std::move(model.materials);
  scene.textures = std::move(model.textures);
  scene.lights = std::move(model.lights);
  scene.cameras = std::move(model.cameras);
  scene.environment = std::move(model.environment);
  scene.portals = std::move(model.portals);
  scene.medium_extinction = std::move(model.medium_extinction);
  scene.unit = model.unit;
  Builder builder(scene);
  for (Job& job : jobs) builder.add(job, nodes);
  if (scene.objects.empty()) throw Error("no geometry: no triangle has an area");
  builder.number_triangles();
  builder.find_bounds();
  scene.report.coplanar_twins = count_twins(scene);
  move_to_origin(scene);
  return scene;
}

}  // namespace atrium::scene
