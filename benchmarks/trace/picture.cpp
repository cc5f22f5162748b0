#include "picture.h"

#include <ctime>

#include "material/error.h"
#include "radiosity/solve.h"
#include "scene/features.h"
#include "scene/image_io.h"
#include "scene/scene_io.h"

namespace atrium::bench {
namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

PictureScene::PictureScene(const std::filesystem::path& file, std::array<int, 2> size)
    : name_(file.stem().string()),
      size_(size),
      scene_(scene::build_scene(scene::read_model({file}))),
      query_(scene_),
      basis_(scene::choose_basis(scene_, scene::find_features(scene_), "auto").basis) {
  if (scene_.cameras.empty()) throw Error(file.string() + ": has no camera");
}

scene::SurfaceField PictureScene::solve(const SolveEffort& effort, std::uint64_t seed) const {
  radiosity::SolveOptions o;
  o.error = effort.error;
  o.mesh_error = effort.mesh_error;
  o.max_elements = effort.max_elements;
  o.seed = seed;
  o.views = {{scene_.cameras.front(), static_cast<double>(size_[0]) / size_[1]}};
  return radiosity::solve(query_, basis_, o).field;
}

trace::RenderResult PictureScene::render(trace::RenderOptions options,
                                         const scene::SurfaceField& field) const {
  options.width = size_[0];
  options.height = size_[1];
  return trace::render(query_, basis_, scene_.cameras.front(), field, options);
}

scene::Image PictureScene::reference(const std::filesystem::path& file, trace::Method method,
                                     int samples, const scene::SurfaceField& field) const {
  if (std::filesystem::exists(file)) return scene::read_image(file);
  trace::RenderOptions o;
  o.method = method;
  o.samples = samples;
  o.share_samples = false;
  o.seed = 0x5eed;
  scene::Image image = render(o, field).image;
  scene::write_image(image, file);
  return image;
}

Trial try_picture(const PictureScene& scene, const scene::SurfaceField& field,
                  const scene::Image& reference, const trace::RenderOptions& options) {
  const double before = cpu_seconds();
  const trace::RenderResult r = scene.render(options, field);
  Trial t;
  t.cpu = cpu_seconds() - before;
  t.rays = static_cast<double>(r.counters.rays());
  t.samples = r.samples_mean;
  t.estimate = r.error_estimate;
  t.block_estimate = r.block_error_estimate;
  t.found = trace::compare(r.image, reference);
  return t;
}

}  // namespace atrium::bench
