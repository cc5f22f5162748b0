// What the programs keep to go on from: read, then gone on from, in a small room.
#include <fstream>
#include <stop_token>

#include "fuzz/edits.h"
#include "fuzz/readers.h"
#include "radiosity/solve.h"
#include "scene/checkpoint_io.h"
#include "support/materials.h"
#include "trace/render.h"
#include "unit/radiosity/box_scene.h"

namespace atrium::fuzz {
namespace {

/// A lamp, a table and a mirror; the narrow spot makes patches that are sampled like lamps.
scene::Scene small_room() {
  test::SceneMaker maker;
  const auto wall = maker.material(test::diffuse(0.6));
  const auto shiny = maker.material(testing::mirror());
  const auto lamp = maker.material(test::emitter(2.0, 0.5));
  maker.room({0, 0, 0}, {4, 3, 3}, {wall, shiny, wall, wall, wall, wall});
  maker.quad(lamp, {0.5f, 2.9f, 1.0f}, {1.5f, 2.9f, 1.0f}, {1.5f, 2.9f, 2.0f}, {0.5f, 2.9f, 2.0f});
  maker.quad(wall, {1.0f, 0.8f, 0.5f}, {1.0f, 0.8f, 2.0f}, {2.5f, 0.8f, 2.0f}, {2.5f, 0.8f, 0.5f});
  scene::Scene s = maker.take();
  scene::Light light;
  light.kind = scene::SpotLight{
      .intensity = 2000.0, .inner_angle = 0.1f, .outer_angle = 0.12f, .falloff = {}};
  light.to_scene.translation() = Vec3d(3.2, 2.5, 1.5);
  light.to_scene.linear() = Eigen::AngleAxisd(-1.5707963, Vec3d::UnitX()).toRotationMatrix();
  s.lights.push_back(light);
  return s;
}

struct Room {
  scene::Scene scene = small_room();
  scene::RayQuery query{scene};
  material::SpectralBasis basis = material::SpectralBasis::grey();
};
const Room& room() {
  static const Room r;
  return r;
}

radiosity::SolveOptions few_samples(radiosity::Keep keep, double error) {
  radiosity::SolveOptions o;
  o.max_elements = 40;
  o.max_level = 1;
  o.row_rays = 4;
  o.gather_rays = 64;
  o.direct_samples = 4;
  o.caustic_photons = 200;
  o.error = error;
  o.keep = keep;
  return o;
}

/// A solve that left something to go on from.
struct Solved {
  radiosity::SolveOptions options;
  radiosity::SolveResult result;
};
Solved solved(radiosity::Keep keep, double error, int stop_at) {
  Solved s{few_samples(keep, error), {}};
  std::stop_source stop;
  int reports = 0;
  scene::Control control;
  control.stop = stop.get_token();
  control.progress = [&](std::string_view, double, std::string_view) {
    if (++reports == stop_at) stop.request_stop();
  };
  s.result = radiosity::solve(room().query, room().basis, s.options, control);
  return s;
}

/// Finished ones, and some that were interrupted on the way.
const std::vector<Solved>& solves() {
  static const std::vector<Solved> all = [] {
    std::vector<Solved> made;
    for (const auto keep : {radiosity::Keep::Samples, radiosity::Keep::Rows})
      for (const double error : {0.0, 0.2})
        for (const int stop_at : {0, 3, 5, 7, 9, 12}) {
          Solved s = solved(keep, error, stop_at);
          if (!s.result.state.empty()) made.push_back(std::move(s));
        }
    return made;
  }();
  return all;
}

/// Sees all of the room.
scene::Camera camera() {
  scene::Camera c;
  c.kind = scene::Camera::Kind::Panorama;
  c.to_scene.translation() = Vec3d(1.5, 1.3, 2.5);
  return c;
}

trace::RenderOptions small_picture(trace::PathKind paths) {
  trace::RenderOptions o;
  o.method = trace::Method::Path;
  o.paths = paths;
  o.width = 6;
  o.height = 4;
  o.samples = 4;
  return o;
}

scene::Checkpoint kept_picture(trace::PathKind paths) {
  scene::Checkpoint kept;
  kept.made_with = {{"seed", "1"}};
  trace::RenderOptions o = small_picture(paths);
  o.save_state = [&](const std::vector<char>& state) { kept.state = state; };
  static_cast<void>(trace::render(room().query, room().basis, camera(), {}, o));
  return kept;
}

/// What write_checkpoint() writes, but for the checksum.
std::vector<char> file_of(const scene::Checkpoint& kept, const std::filesystem::path& folder) {
  scene::write_checkpoint(kept, folder / "kept");
  std::ifstream in(folder / "kept", std::ios::binary);
  std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  bytes.resize(bytes.size() - sizeof(std::uint64_t));
  return bytes;
}

Bytes without_first(Bytes input) { return input.subspan(std::min<std::size_t>(1, input.size())); }

}  // namespace

void read_state(const std::filesystem::path&, Bytes input) {
  const std::size_t which = input.empty() ? 0 : input[0] % solves().size();
  const Solved& from = solves()[which];
  const std::vector<char> state = edited(from.result.state, without_first(input));
  radiosity::SolveOptions options = from.options;
  options.time_limit = 2.0;  // a state says how many samples are still to be drawn
  static_cast<void>(radiosity::solve(room().query, room().basis, options, {},
                                     radiosity::Previous{from.result.field, state}));
}

void read_checkpoint(const std::filesystem::path& folder, Bytes input) {
  const bool both = !input.empty() && input[0] % 2 == 1;
  const auto paths = both ? trace::PathKind::BothEnds : trace::PathKind::FromEye;
  static const std::array<std::vector<char>, 2> files = {
      file_of(kept_picture(trace::PathKind::FromEye), folder),
      file_of(kept_picture(trace::PathKind::BothEnds), folder)};
  const std::vector<char> file = edited(files[both ? 1 : 0], without_first(input));
  const scene::Checkpoint kept =
      scene::read_checkpoint(put(folder, "input.kept", with_checksum({file.begin(), file.end()})));
  trace::RenderOptions o = small_picture(paths);
  o.samples = 8;
  o.state = &kept.state;
  static_cast<void>(trace::render(room().query, room().basis, camera(), {}, o));
}

}  // namespace atrium::fuzz
