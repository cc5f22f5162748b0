#include <cstdio>
#include <numbers>

#include "commands.h"
#include "common/json.h"
#include "material/bsdf.h"
#include "material/error.h"
#include "radiosity_pass.h"
#include "scene/image_io.h"
#include "scene/luminaire.h"
#include "scene/mesh_io.h"
#include "scene/output_file.h"
#include "scene/portal.h"
#include "scene/scene_io.h"
#include "scene/solution_io.h"
#include "statistics.h"

namespace atrium::app {

namespace {

void print(const std::string& text) { std::fputs(text.c_str(), stdout); }

/// "name: value" lines or JSON members, whichever was asked for.
class Report {
 public:
  explicit Report(bool json) : json_(json) {
    if (json_) writer.begin_object();
  }
  template <class T>
  void add(const char* name, const T& value, const char* unit = "") {
    if (json_) {
      writer.member(name, value);
    } else {
      print(std::string(name) + ": " + printable(text(value)) + (*unit ? " " : "") + unit + "\n");
    }
  }
  void list(const char* name, const std::vector<std::string>& items) {
    if (json_) writer.begin_array(name);
    if (!json_ && !items.empty()) print(std::string(name) + ":\n");
    for (const std::string& item : items) {
      json_ ? writer.element(item) : print("  " + printable(item) + "\n");
    }
    if (json_) writer.end();
  }
  void finish() {
    if (!json_) return;
    writer.end();
    print(writer.text());
  }
  [[nodiscard]] bool json() const { return json_; }
  JsonWriter writer;

 private:
  static std::string text(const std::string& v) { return v; }
  static std::string text(std::uint64_t v) { return std::to_string(v); }
  static std::string text(int v) { return std::to_string(v); }
  static std::string text(double v) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", v);
    return buffer;
  }
  bool json_;
};

std::string opening_text(const Vec3d& size) {
  char text[96];
  if (size.y() > 0.0)
    std::snprintf(text, sizeof text, "%.4g x %.4g x %.4g", size.x(), size.y(), size.z());
  else
    std::snprintf(text, sizeof text, "diameter %.4g, height %.4g", size.x(), size.z());
  return text;
}

void info_luminaire(const std::string& file, Report& r) {
  const scene::Luminaire l = scene::read_luminaire(file);
  const scene::IntensityProfile& profile = l.profile;
  double largest = 0.0;
  for (const double c : profile.candela) largest = std::max(largest, c);
  r.add("luminaire", file);
  r.add("name", l.name);
  r.add("format", l.format);
  r.add("photometric type", std::string(1, l.type));
  r.add("flux", profile.flux(), "lm");
  if (l.stated_flux) r.add("flux as stated", *l.stated_flux, "lm");
  if (l.lamp_flux) r.add("flux of the lamps", *l.lamp_flux, "lm");
  r.add("largest intensity", largest, "cd");
  r.add("vertical angles", static_cast<std::uint64_t>(profile.theta_deg.size()));
  r.add("horizontal angles", static_cast<std::uint64_t>(profile.phi_deg.size()));
  r.add("symmetry", l.symmetry);
  for (const int plane : {0, 90}) {
    const std::string where = std::to_string(plane) + "-" + std::to_string(plane + 180);
    r.add(("beam angle, plane " + where).c_str(), scene::opening_angle(profile, plane, 0.5), "deg");
    r.add(("field angle, plane " + where).c_str(), scene::opening_angle(profile, plane, 0.1),
          "deg");
  }
  r.add("luminous opening", opening_text(l.opening), "m");
}

void info_image(const std::string& file, Report& r) {
  const scene::Image image = scene::read_image(file);
  r.add("image", file);
  r.add("width", image.width);
  r.add("height", image.height);
  r.list("channels", image.channels);
  std::vector<std::string> metadata;
  for (const auto& [key, value] : image.metadata) metadata.push_back(key + ": " + value);
  r.list("metadata", metadata);
}

void info_solution(const std::string& file, Report& r) {
  const scene::Solution s = scene::read_solution(file);
  r.add("radiosity solution", file);
  r.add("elements", static_cast<std::uint64_t>(s.field.element_count()));
  r.add("facets", static_cast<std::uint64_t>(s.field.facets.size()));
  r.add("spectrum", s.basis);
  r.add("unit", s.field.unit);
  r.add("made with", s.options);
  r.add("to go on from", static_cast<std::uint64_t>(s.state.size()), "bytes");
  std::vector<std::string> groups;
  for (const scene::GroupField& g : s.groups) {
    char factor[32];
    std::snprintf(factor, sizeof factor, "%.6g", g.factor);
    groups.push_back(g.name + (g.factor == 1.0 ? "" : std::string(" x ") + factor));
  }
  r.list("light groups", groups);
}

std::string size_text(const scene::Bounds& bounds) {
  if (bounds.isEmpty()) return "empty";
  const Vec3d s = bounds.sizes();
  char text[96];
  std::snprintf(text, sizeof text, "%.3f x %.3f x %.3f", s.x(), s.y(), s.z());
  return text;
}

std::string array_text(const scene::MeshFileSummary::Array& a) {
  char range[64];
  std::snprintf(range, sizeof range, ": %.6g to %.6g", a.low, a.high);
  std::string text = a.name + range + (a.unit.empty() || a.unit == "1" ? "" : " " + a.unit);
  return text + ", " + a.type + (a.components == 1 ? "" : " x " + std::to_string(a.components));
}

void add_arrays(const std::vector<scene::MeshFileSummary::Array>& arrays, const char* name,
                Report& r) {
  std::vector<std::string> texts;
  texts.reserve(arrays.size());
  for (const scene::MeshFileSummary::Array& a : arrays) texts.push_back(array_text(a));
  r.list(name, texts);
}

void info_mesh_file(const std::string& file, Report& r) {
  const scene::MeshFileSummary s = scene::summarise_mesh_file(file);
  r.add("mesh", file);
  r.add("polygons", s.polygons);
  r.add("points", s.points);
  r.add("size",
        size_text({Vec3d(s.bounds[0], s.bounds[2], s.bounds[4]),
                   Vec3d(s.bounds[1], s.bounds[3], s.bounds[5])}),
        "m");
  add_arrays(s.cell_arrays, "arrays of polygons (range; of colours that of their luminance)", r);
  add_arrays(s.point_arrays, "arrays of points", r);
  std::vector<std::string> words;
  for (const auto& [name, values] : s.field_data) {
    if (name == "array_names" || name == "array_units") continue;  // said with the arrays
    if (values.size() == 1)
      words.push_back(name + ": " + values[0]);
    else
      words.push_back(name + ": " + std::to_string(values.size()) + " values");
  }
  r.list("remarks", words);
}

void add_load_report(const scene::LoadReport& l, Report& r) {
  const std::pair<const char*, std::uint64_t> counts[] = {
      {"triangles read", l.triangles_read},
      {"degenerate triangles dropped", l.degenerate_dropped},
      {"duplicate triangles dropped", l.duplicate_dropped},
      {"non-finite triangles dropped", l.non_finite_dropped},
      {"vertices welded", l.vertices_welded},
      {"triangles flipped", l.triangles_flipped},
      {"non-manifold edges", l.non_manifold_edges},
      {"T-junctions", l.t_junctions},
      {"closed meshes", l.meshes_closed},
      {"shared meshes", l.meshes_shared},
      {"meshes without normals", l.normals_made},
      {"panes recognised", l.panes_recognised},
      {"triangles of subdivision surfaces", l.subdivision_triangles}};
  if (r.json()) r.writer.begin_object("load_report");
  for (const auto& [name, value] : counts) {
    if (r.json() || value != 0) r.add(name, value);
  }
  if (r.json()) r.writer.end();
}

std::string camera_text(const scene::Camera& camera, std::size_t index) {
  const char* kind = camera.kind == scene::Camera::Kind::Perspective    ? "perspective"
                     : camera.kind == scene::Camera::Kind::Orthographic ? "orthographic"
                                                                        : "panorama";
  return std::to_string(index) + (camera.name.empty() ? "" : " \"" + camera.name + "\"") + ", " +
         kind;
}

/// What lies around the scene, in words and in the scene's unit.
std::string environment_text(const scene::Scene& scene) {
  const scene::Environment& e = *scene.environment;
  const double level =
      static_cast<double>(material::SpectralBasis::grey().resolve<1>(e.radiance)[0]);
  const bool light = scene.unit == scene::RadianceUnit::Nit;
  const char* radiance = light ? "cd/m^2" : "W/(sr m^2)";
  char text[200];
  if (const auto* image = std::get_if<scene::Image>(&e.pattern)) {
    std::snprintf(text, sizeof text, "environment: image of %d x %d times %g", image->width,
                  image->height, level);
  } else if (const auto* dome = std::get_if<scene::SkyDome>(&e.pattern)) {
    std::snprintf(text, sizeof text,
                  "environment: sky of %.5g %s on the ground, zenith %.5g %s, ground %.5g %s",
                  level, light ? "lx" : "W/m^2", dome->zenith() * level, radiance,
                  dome->ground() * level, radiance);
  } else {
    std::snprintf(text, sizeof text, "environment: uniform, %.5g %s", level, radiance);
  }
  return text;
}

/// Per light kind and count, in words.
std::vector<std::string> light_list(const scene::Scene& scene, const scene::Features& f) {
  std::vector<std::string> list;
  const auto add = [&](std::uint64_t n, const char* what) {
    if (n != 0) list.push_back(std::to_string(n) + " " + what);
  };
  add(f.emissive_triangles, "emissive triangles");
  add(f.point_lights, "point lights");
  add(f.spot_lights, "spot lights");
  add(f.directional_lights, "directional lights");
  add(f.profile_lights, "luminaires with measured intensity");
  if (f.environment) list.push_back(environment_text(scene));
  return list;
}

/// Openings that sky and sun are sampled through, and why each was taken.
std::vector<std::string> opening_list(const scene::RayQuery& query) {
  std::vector<std::string> list;
  for (const scene::Opening& o : scene::find_openings(query)) {
    char text[200];
    std::snprintf(text, sizeof text,
                  ": %.3g m^2 at (%.3f, %.3f, %.3f), open sky %.0f %% outside, %.0f %% inside",
                  o.area, o.center.x(), o.center.y(), o.center.z(), 100.0 * o.outside,
                  100.0 * o.inside);
    list.push_back(o.reason + text);
  }
  return list;
}

/// Which form of F the materials' interfaces use, and how far it may be off.
std::vector<std::string> fresnel_list(const scene::Scene& scene,
                                      const material::SpectralBasis& basis) {
  std::vector<std::string> list;
  with_lanes(basis.lanes(), [&](auto lanes) {
    for (const material::Material& m : scene.materials) {
      const auto resolved = material::resolve_material<lanes()>(m, basis);
      if (!resolved.fresnel) continue;
      std::string text = (m.name.empty() ? "(unnamed)" : m.name) + ": ";
      const bool solid = m.medium == material::Material::Medium::Solid;
      for (std::size_t side = 0; side < (solid ? 2U : 1U); ++side) {
        const auto& term = (*resolved.fresnel)[side];
        char error[48];
        std::snprintf(error, sizeof error, " (error %.1e)", static_cast<double>(term.error()));
        text += (side == 1 ? ", inside " : "") + std::string(name(term.form())) + error;
      }
      list.push_back(std::move(text));
    }
  });
  return list;
}

void info_scene(const InfoCommand& c, std::stop_token stop, Report& r) {
  CommonOptions silent;
  silent.quiet = true;
  Session session(silent, std::move(stop));
  LoadSettings settings;
  settings.show_warnings = false;  // they are part of the report
  const LoadedScene loaded = load_scene(session, c.scene, settings);
  const scene::Scene& scene = *loaded.scene;
  r.add("triangles", scene.triangle_count());
  r.add("objects", static_cast<std::uint64_t>(scene.objects.size()));
  r.add("meshes", static_cast<std::uint64_t>(scene.meshes.size()));
  r.add("materials", static_cast<std::uint64_t>(scene.materials.size()));
  r.add("textures", static_cast<std::uint64_t>(scene.textures.size()));
  r.add("size", size_text(scene.bounds), "m");
  r.add("unit of radiance",
        std::string(scene.unit == scene::RadianceUnit::Nit ? "cd/m^2" : "W/(sr m^2)"));
  r.add("spectrum", loaded.basis.describe());
  r.add("reason for spectrum", loaded.basis_reason);
  r.list("forms of the Fresnel reflectance", fresnel_list(scene, loaded.basis.packs()[0]));
  r.list("lights", light_list(scene, loaded.features));
  r.list("openings", opening_list(*loaded.query));
  std::vector<std::string> cameras;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    cameras.push_back(camera_text(scene.cameras[i], i));
  }
  r.list("cameras", cameras);
  add_load_report(scene.report, r);
  if (const auto share = coplanar_share(scene); share && (r.json() || *share > 0.0))
    r.add("area under another surface in its plane", *share);
  const trace::PathStrategy reference = trace::choose_strategy(scene);
  if (r.json()) {
    add_features(r.writer, loaded.features);
    add_reference(r.writer, reference);
  } else {
    std::vector<std::string> needed, skipped;
    for (const scene::Decision& d : scene::decide(loaded.features)) {
      (d.needed ? needed : skipped).push_back(d.what + ": " + d.reason);
    }
    (reference.from_lights ? needed : skipped)
        .push_back("paths from lights (--method path): " + reference.reason);
    r.list("needed", needed);
    r.list("skipped", skipped);
    r.list("not found by --method path", reference.missing);
  }
  r.list("warnings", scene.report.warnings);
}

}  // namespace

int run_info(const InfoCommand& c, std::stop_token stop) {
  const std::string& first = c.scene.files.front();
  const std::string ending = scene::file_ending(first);
  const bool image = scene::is_image_ending(first);
  const bool luminaire = scene::is_luminaire_ending(first);
  const bool mesh = scene::is_mesh_ending(first);
  const bool single = image || luminaire || mesh || ending == ".atrium";
  if (single && c.scene.files.size() > 1) {
    throw Error(first + ": is no scene; one luminaire, image, mesh or solution at a time");
  }
  Report report(c.json);
  if (luminaire) {
    info_luminaire(first, report);
  } else if (ending == ".atrium") {
    info_solution(first, report);
  } else if (mesh) {
    info_mesh_file(first, report);
  } else if (image) {
    info_image(first, report);
  } else {
    info_scene(c, std::move(stop), report);
  }
  report.finish();
  return 0;
}

}  // namespace atrium::app
