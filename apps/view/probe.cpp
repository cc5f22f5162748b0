#include "probe.h"

#include <cmath>
#include <cstdio>

#include "selection.h"

namespace atrium::view {
namespace {

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// One of the mesh's arrays of polygons; NaN: not there.
double cell_value(const Mesh& mesh, const std::string& name, std::size_t polygon) {
  const Array* a = find_array(mesh.polygons.cell_arrays, name);
  return a != nullptr && a->components == 1 ? static_cast<double>(a->values[polygon])
                                            : std::nan("");
}

}  // namespace

Probe::Probe(const Mesh& mesh) {
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k) {
    const auto id = id_at(mesh, "element_id", k);
    if (id < 0) continue;
    const auto element = static_cast<std::size_t>(id);
    if (element >= element_area_.size()) element_area_.resize(element + 1, 0.0f);
    element_area_[element] += mesh.area(k);
  }
}

std::string Probe::describe(const Mesh& mesh, const Field& field, const Picker::Hit& hit,
                            double value) const {
  std::string text =
      field.title + ": " + (std::isfinite(value) ? number("%.4g", value) : "unknown");
  if (field.sided && field.look != Look::Error)
    if (const double e = cell_value(mesh, hit.front ? "stderr" : "stderr_back", hit.polygon);
        std::isfinite(e) && std::isfinite(value) && e >= 0.0)
      text += " +- " + number("%.2g", field.lux ? e * mesh.lux_per_unit : e);
  text += hit.front ? " (front)" : " (back)";
  const auto element = id_at(mesh, "element_id", hit.polygon);
  if (element >= 0)
    text +=
        "\nelement " + std::to_string(element) + ", " +
        number("%.3g m^2", static_cast<double>(element_area_[static_cast<std::size_t>(element)]));
  else
    text += "\npolygon " + std::to_string(hit.polygon) + ", " +
            number("%.3g m^2", static_cast<double>(mesh.area(hit.polygon)));
  if (const auto id = id_at(mesh, "material_id", hit.polygon); id >= 0)
    text += ", material " + name_of(mesh.materials, id);
  if (const auto id = id_at(mesh, "object_id", hit.polygon); id >= 0)
    text += ", object " + name_of(mesh.objects, id);
  return text + ", at" + number(" %.3f", hit.position.x()) + number(" %.3f", hit.position.y()) +
         number(" %.3f", hit.position.z());
}

}  // namespace atrium::view
