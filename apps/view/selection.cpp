#include "selection.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/suggest.h"
#include "material/error.h"

namespace atrium::view {
namespace {

const Array* id_array(const Mesh& mesh, const char* name) {
  const Array* a = find_array(mesh.polygons.cell_arrays, name);
  return a != nullptr && a->components == 1 ? a : nullptr;
}

std::optional<std::uint32_t> number(const std::string& text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// First polygon with a value, as texts and numbers of users name it.
std::optional<std::size_t> polygon_with(const Mesh& mesh, const char* array, std::uint32_t id) {
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k)
    if (id_at(mesh, array, k) == static_cast<std::int64_t>(id)) return k;
  return std::nullopt;
}

std::uint32_t find_id(const std::string& what, const std::string& text, const char* array,
                      const std::vector<std::string>& names, const Mesh& mesh) {
  const auto named = std::find(names.begin(), names.end(), text);
  if (named != names.end()) return static_cast<std::uint32_t>(named - names.begin());
  if (const auto id = number(text); id && polygon_with(mesh, array, *id)) return *id;
  if (id_array(mesh, array) == nullptr)
    throw Error(what + ": the mesh does not say which is which");
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw Error(what + ": there is none in the mesh" +
              (known.empty() ? "" : app::suggestion(text, known)));
}

/// Polygons that use each point.
struct Users {
  std::vector<std::uint32_t> first, polygon;

  explicit Users(const Mesh& mesh) : first(mesh.polygons.points.size() + 1, 0) {
    for (const std::uint32_t p : mesh.polygons.polygon_points) ++first[p + 1];
    for (std::size_t p = 1; p < first.size(); ++p) first[p] += first[p - 1];
    polygon.resize(mesh.polygons.polygon_points.size());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::size_t k = 0; k < mesh.polygon_count(); ++k)
      for (const std::uint32_t p : mesh.corners(k))
        polygon[next[p]++] = static_cast<std::uint32_t>(k);
  }
};

std::vector<std::uint8_t> facet_of(const Mesh& mesh, std::size_t start) {
  const Users users(mesh);
  const Vec3d normal = mesh.area_normal[start].cast<double>().normalized();
  const Vec3d origin = mesh.centre(start);
  const double slack = 1e-3 * mesh.diagonal;
  const double cone = std::cos(5.0 * std::numbers::pi / 180.0);
  const auto belongs = [&](std::size_t k) {
    if (id_at(mesh, "object_id", k) != id_at(mesh, "object_id", start)) return false;
    if (mesh.area_normal[k].cast<double>().dot(normal) < cone * static_cast<double>(mesh.area(k)))
      return false;
    return std::abs((mesh.centre(k) - origin).dot(normal)) <= slack;
  };
  std::vector<std::uint8_t> in(mesh.polygon_count(), 0);
  std::vector<std::size_t> open{start};
  in[start] = 1;
  while (!open.empty()) {
    const std::size_t k = open.back();
    open.pop_back();
    for (const std::uint32_t p : mesh.corners(k))
      for (std::uint32_t u = users.first[p]; u < users.first[p + 1]; ++u)
        if (const std::uint32_t next = users.polygon[u]; in[next] == 0 && belongs(next)) {
          in[next] = 1;
          open.push_back(next);
        }
  }
  return in;
}

}  // namespace

std::int64_t id_at(const Mesh& mesh, const char* array, std::size_t polygon) {
  const Array* a = id_array(mesh, array);
  return a != nullptr && a->values[polygon] >= 0.0f ? static_cast<std::int64_t>(a->values[polygon])
                                                    : -1;
}

Selection parse_selection(const std::string& option, const std::string& text, const Mesh& mesh) {
  using Kind = Selection::Kind;
  if (text == "all") return {};
  const std::size_t equals = text.find('=');
  const std::string kind = text.substr(0, equals);
  const std::string which = equals == std::string::npos ? "" : text.substr(equals + 1);
  const std::string what = option + " " + text;
  if (kind == "object" && !which.empty())
    return {Kind::Object, find_id(what, which, "object_id", mesh.objects, mesh)};
  if (kind == "material" && !which.empty())
    return {Kind::Material, find_id(what, which, "material_id", mesh.materials, mesh)};
  if (kind == "facet" && number(which)) {
    const auto polygon = polygon_with(mesh, "element_id", *number(which));
    if (!polygon) throw Error(what + ": there is no such element");
    return {Kind::Facet, static_cast<std::uint32_t>(*polygon)};
  }
  throw Error(what + ": is none of all, object=NAME, material=NAME, facet=ELEMENT");
}

std::vector<std::uint8_t> selected(const Mesh& mesh, const Selection& selection) {
  using Kind = Selection::Kind;
  if (selection.kind == Kind::All) return std::vector<std::uint8_t>(mesh.polygon_count(), 1);
  if (selection.kind == Kind::Facet) return facet_of(mesh, selection.id);
  const Array* ids = id_array(mesh, selection.kind == Kind::Object ? "object_id" : "material_id");
  std::vector<std::uint8_t> in(mesh.polygon_count(), 0);
  for (std::size_t k = 0; k < in.size() && ids != nullptr; ++k)
    in[k] = ids->values[k] == static_cast<float>(selection.id) ? 1 : 0;
  return in;
}

std::string name_of(const std::vector<std::string>& names, std::int64_t id) {
  const auto i = static_cast<std::size_t>(id);
  const bool named = id >= 0 && i < names.size() && !names[i].empty();
  return std::to_string(id) + (named ? " " + names[i] : "");
}

std::string describe(const Mesh& mesh, const Selection& selection) {
  switch (selection.kind) {
    case Selection::Kind::Object:
      return "object " + name_of(mesh.objects, selection.id);
    case Selection::Kind::Material:
      return "material " + name_of(mesh.materials, selection.id);
    case Selection::Kind::Facet:
      return "facet of object " + name_of(mesh.objects, id_at(mesh, "object_id", selection.id));
    case Selection::Kind::All:
      break;
  }
  return "all surfaces";
}

}  // namespace atrium::view
