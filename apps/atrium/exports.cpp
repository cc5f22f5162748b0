#include "exports.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>

#include "material/error.h"
#include "scene/image_io.h"
#include "scene/mesh_io.h"
#include "scene/output_file.h"
#include "trace/tone_map.h"

#ifdef ATRIUM_WITH_WEB
#include "web/web_page.h"
#endif
#ifdef ATRIUM_WITH_RADIOSITY
#include "radiosity/bake.h"
#include "radiosity/export_mesh.h"
#endif

namespace atrium::app {

namespace {

bool is_glb(const std::string& file) { return scene::file_ending(file) == ".glb"; }
bool is_page(const std::string& file) { return scene::file_ending(file) == ".html"; }

#ifdef ATRIUM_WITH_WEB
constexpr bool kWeb = true;
#else
constexpr bool kWeb = false;
[[maybe_unused]] std::vector<std::uint8_t> web_page(const std::vector<std::uint8_t>&,
                                                    const std::string&) {
  return {};  // check_export() has refused it
}
#endif

bool any(const std::vector<std::string>& files, bool (*is)(const std::string&)) {
  return std::any_of(files.begin(), files.end(), is);
}

}  // namespace

bool is_export(const std::string& file) {
  return scene::is_mesh_ending(file) || is_glb(file) || is_page(file);
}

void check_export(const std::string& file) {
  if (scene::is_mesh_ending(file) && !scene::mesh_io_available())
    throw RuntimeFailure(file +
                         ": mesh files cannot be written: atrium_mesh_io.so is missing, or "
                         "not part of this build (ATRIUM_WITH_VTK was off)");
  if (is_page(file) && !kWeb)
    throw RuntimeFailure(file +
                         ": web pages are not part of this build (ATRIUM_WITH_WEB was off, or npm "
                         "was missing)");
}

void check_export_options(const ExportSettings& settings, const std::vector<std::string>& files) {
  if (settings.ev && !any(files, is_glb) && !any(files, is_page))
    throw Error("--exposure: there is no .glb or .html output");
  if (settings.lightmap > 0 && !any(files, is_glb))
    throw Error("--lightmap: there is no .glb output");
  if (settings.group_colours && !any(files, is_glb))
    throw Error("--group-colours: there is no .glb output");
  if (settings.group_colours && settings.lightmap > 0)
    throw Error("--group-colours: not together with --lightmap, which has the sum of all groups");
  if (settings.lightmap > 0 && settings.lightmap < 16)
    throw Error("--lightmap " + std::to_string(settings.lightmap) + ": must be 0, or 16 to 16384");
  if (settings.lightmap > 0 && !scene::image_io_available())
    throw RuntimeFailure(
        "--lightmap: pictures cannot be written: atrium_image_io.so is "
        "missing, or not part of this build (no OpenImageIO)");
}

#ifdef ATRIUM_WITH_RADIOSITY

namespace {

using scene::BakedModel;

/// A triangle that carries light.
struct LitTriangle {
  std::uint32_t primitive = 0, first = 0;  ///< into its indices
  Vec3d centre = Vec3d::Zero();
  double weight_up_to = 0.0;  ///< of all until this one
};

Vec3d eye_of(const BakedModel& model) { return model.cameras.front().to_scene.translation(); }

/// The solid angle from the first camera, of what is near no more than its area; without a camera
/// the area. \param area  along the normal.
double weight_of(const Vec3d& centre, const Vec3d& area, const BakedModel& model) {
  if (model.cameras.empty()) return area.norm();
  const Vec3d d = eye_of(model) - centre;
  return std::max(0.0, area.dot(d)) / ((1.0 + d.squaredNorm()) * (1e-6 + d.norm()));
}

std::vector<LitTriangle> lit_triangles(const BakedModel& model) {
  std::vector<LitTriangle> list;
  double sum = 0.0;
  for (std::uint32_t k = 0; k < model.primitives.size(); ++k) {
    const BakedModel::Primitive& p = model.primitives[k];
    if ((p.radiance.empty() && !model.materials[p.material].atlas) || p.backdrop) continue;
    for (std::uint32_t i = 0; i + 2 < p.indices.size(); i += 3) {
      const auto corner = [&](std::uint32_t n) {
        return Vec3d(p.positions[p.indices[i + n]].cast<double>());
      };
      const Vec3d a = corner(0);
      LitTriangle t{k, i, (a + corner(1) + corner(2)) / 3.0};
      sum += weight_of(t.centre, 0.5 * (corner(1) - a).cross(corner(2) - a), model);
      t.weight_up_to = sum;
      list.push_back(t);
    }
  }
  return list;
}

/// Does the first camera see a triangle, through panes too?
bool visible(const LitTriangle& t, const BakedModel& model, const scene::RayQuery& query) {
  if (model.cameras.empty()) return true;
  const scene::Camera& camera = model.cameras.front();
  const Vec3d d = t.centre - eye_of(model);
  const double length = d.norm();
  if (!(length > 1e-3)) return true;
  if (camera.kind == scene::Camera::Kind::Perspective) {
    const Vec3d p = camera.to_scene.linear().transpose() * d;
    const double reach = -p.z() * std::tan(0.5 * camera.yfov);
    const double aspect = camera.aspect > 0.0 ? camera.aspect : 4.0 / 3.0;
    if (!(std::abs(p.y()) < reach && std::abs(p.x()) < reach * aspect)) return false;
  }
  scene::Counters counters;
  return !query.occluded({eye_of(model).cast<float>(), (d / length).cast<float>(), 0.0f,
                          static_cast<float>(length * (1.0 - 1e-3))},
                         counters, scene::Counter::RaysPrimary, scene::kOpaque);
}

Rgb radiance_of(const LitTriangle& t, const BakedModel& model) {
  const BakedModel::Primitive& p = model.primitives[t.primitive];
  if (model.materials[p.material].atlas) {
    Vec2f uv = Vec2f::Zero();
    for (std::uint32_t i = 0; i < 3; ++i) uv += p.uvs[p.indices[t.first + i]] / 3.0f;
    const auto texel = [](float share, int size) {
      return static_cast<std::size_t>(share * static_cast<float>(size));
    };
    return model.atlas
        .radiance[texel(uv.y(), model.atlas.height) * static_cast<std::size_t>(model.atlas.width) +
                  texel(uv.x(), model.atlas.width)];
  }
  Rgb mean;
  for (std::uint32_t i = 0; i < 3; ++i) mean += p.radiance[p.indices[t.first + i]] * (1.0f / 3.0f);
  const std::int32_t texture = model.materials[p.material].texture;
  if (texture >= 0) mean *= model.textures[static_cast<std::size_t>(texture)].mean_rgb();
  return mean;
}

/// What the first camera sees, as a picture of one line; empty if there is no light. Without a
/// camera all surfaces.
scene::Image seen_by_camera(const BakedModel& model, const scene::RayQuery& query) {
  constexpr std::size_t kSamples = 1 << 16;
  scene::Image image;
  image.channels = {"R", "G", "B"};
  const std::vector<LitTriangle> triangles = lit_triangles(model);
  if (triangles.empty()) return image;
  const double step = triangles.back().weight_up_to / static_cast<double>(kSamples);
  std::size_t at = 0;
  for (std::size_t s = 0; s < kSamples; ++s) {
    const double wanted = (static_cast<double>(s) + 0.5) * step;
    while (at + 1 < triangles.size() && triangles[at].weight_up_to < wanted) ++at;
    if (!visible(triangles[at], model, query)) continue;
    const Rgb radiance = radiance_of(triangles[at], model);
    image.pixels.insert(image.pixels.end(), radiance.lane.begin(), radiance.lane.end());
  }
  image.width = static_cast<int>(image.pixels.size() / 3);
  image.height = image.width > 0 ? 1 : 0;
  return image;
}

class Writer {
 public:
  Writer(Session& session, const ExportSource& source, const ExportSettings& settings)
      : session_(session),
        source_(source),
        scene_(*source.loaded.scene),
        settings_(settings),
        elements_(radiosity::elements_of_field(scene_, source.field)) {}

  void write(const std::string& file) {
    if (scene::is_mesh_ending(file))
      scene::write_polygon_mesh(mesh(), file);
    else if (is_glb(file))
      write_glb(file);
    else
      write_page(file);
    session_.progress.note("wrote " + file);
  }

 private:
  const scene::PolygonMesh& mesh() {
    if (!mesh_) {
      mesh_ = radiosity::to_polygon_mesh(scene_, elements_, source_.field, source_.loaded.basis,
                                         source_.groups);
      mesh_->field_data["version"] = {std::string("atrium ") + ATRIUM_VERSION};
      mesh_->field_data["command"] = {session_.options().command_line};
    }
    return *mesh_;
  }

  BakedModel bake(const radiosity::BakeOptions& options) {
    BakedModel model = radiosity::bake(scene_, elements_, source_.field, source_.loaded.basis,
                                       source_.groups, options);
    for (const std::string& warning : model.warnings) session_.progress.warning(warning);
    if (model.cameras.empty()) {
      model.cameras = {scene::choose_interior_view(scene_, *source_.loaded.query)};
      model.cameras[0].name = "inside";
    }
    return model;
  }

  scene::GlbOptions glb_options(const BakedModel& model) const {
    scene::GlbOptions o;
    if (settings_.ev) {
      o.ev = *settings_.ev;
    } else {
      const scene::Image samples = seen_by_camera(model, *source_.loaded.query);
      o.ev = samples.pixels.empty() ? 0.0 : trace::automatic_ev(samples);
    }
    o.white = trace::white_at(o.ev);
    o.generator = std::string("atrium ") + ATRIUM_VERSION;
    return o;
  }

  void write_glb(const std::string& file) {
    const BakedModel model =
        bake({.group_light = settings_.group_colours, .lightmap = settings_.lightmap});
    if (settings_.lightmap > 0) describe_lightmap(file, model);
    const scene::GlbOptions options = glb_options(model);
    scene::GlbStatistics statistics;
    scene::write_bytes(scene::encode_glb(model, options, &statistics), file);
    char text[200];
    std::snprintf(text, sizeof text, "%s: white is %.4g %s (EV %.2f), %.2g %% is brighter",
                  file.c_str(), options.white,
                  model.unit == scene::RadianceUnit::Nit ? "cd/m^2" : "W/(sr m^2)", options.ev,
                  100.0 * statistics.clipped_share);
    session_.progress.note(text);
  }

  /// Its texels, beside the elements that they stand for.
  void describe_lightmap(const std::string& file, const BakedModel& model) {
    double area = 0.0;
    for (const float a : source_.field.element_area) area += static_cast<double>(a);
    const double element = std::sqrt(area / static_cast<double>(source_.field.element_count()));
    const double texel = model.atlas.texel_size;
    char text[200];
    std::snprintf(text, sizeof text, "%s: texels of %.3g m, elements of %.3g m in the mean",
                  file.c_str(), texel, element);
    texel > element
        ? session_.progress.warning(std::string(text) + ": a larger --lightmap shows more")
        : session_.progress.note(text);
  }

  void write_page(const std::string& file) {
    const BakedModel model = bake({.group_light = true, .merge_objects = true, .backdrop = true});
    scene::GlbOptions options = glb_options(model);
    options.page = true;
    scene::write_bytes(web_page(scene::encode_glb(model, options), settings_.title), file);
  }

  Session& session_;
  const ExportSource& source_;
  const scene::Scene& scene_;
  const ExportSettings& settings_;
  radiosity::Elements elements_;
  std::optional<scene::PolygonMesh> mesh_;
};

}  // namespace

void write_exports(Session& session, const ExportSource& source,
                   const std::vector<std::string>& files, const ExportSettings& settings) {
  if (!any(files, is_export)) return;
  session.clock.enter("write");
  const auto count = static_cast<double>(std::count_if(files.begin(), files.end(), is_export));
  double done = 0.0;
  session.progress.report("write", 0.0, {});
  Writer writer(session, source, settings);
  for (const std::string& file : files) {
    if (!is_export(file)) continue;
    writer.write(file);
    session.progress.report("write", ++done / count, {});
  }
}

#else

void write_exports(Session&, const ExportSource&, const std::vector<std::string>&,
                   const ExportSettings&) {
  throw RuntimeFailure("radiosity is not part of this build (ATRIUM_WITH_OPENMESH was off)");
}

#endif

}  // namespace atrium::app
