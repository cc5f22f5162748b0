#include "picture.h"

#include <vtkCamera.h>
#include <vtkLookupTable.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ceilings.h"
#include "coarse.h"
#include "colours.h"
#include "contour_layer.h"
#include "contour_lines.h"
#include "legend.h"
#include "line_layer.h"
#include "plain_layer.h"
#include "seen_light.h"
#include "sky_layer.h"
#include "surface.h"
#include "weighted_values.h"

namespace atrium::view {
namespace {

constexpr std::size_t kClassesListed = 14;
constexpr std::size_t kWhileMoving = 100000;  // triangles

bool shows(ShownSide shown, Side side) {
  return shown == ShownSide::Seen || (shown == ShownSide::Front) == (side == Side::Front);
}

std::vector<Legend::Entry> class_entries(const Mesh& mesh, const Field& field,
                                         const std::vector<std::uint8_t>& shown) {
  const Values ids = numbers_of(mesh, field, Side::Front, false);
  std::map<std::int64_t, double> area;
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k)
    if (shown[k] != 0 && ids.numbers[k] >= 0.0f)
      area[static_cast<std::int64_t>(ids.numbers[k])] += static_cast<double>(mesh.area(k));
  std::vector<std::pair<std::int64_t, double>> largest(area.begin(), area.end());
  std::stable_sort(largest.begin(), largest.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  largest.resize(std::min(largest.size(), kClassesListed));
  if (field.array == "level") std::sort(largest.begin(), largest.end());
  const auto& names = field.array == "material_id" ? mesh.materials : mesh.objects;
  const bool named = field.array == "material_id" || field.array == "object_id";
  std::vector<Legend::Entry> entries;
  entries.reserve(largest.size());
  for (const auto& [id, a] : largest)
    entries.push_back({named ? name_of(names, id) : field.name + " " + std::to_string(id),
                       class_colour(static_cast<std::uint32_t>(id))});
  return entries;
}

}  // namespace

struct Picture::Impl {
  explicit Impl(vtkRenderer& r)
      : renderer(r),
        surface(r),
        edges(r, {20, 20, 20}, 1.0),
        outline(r, {255, 60, 220}, 2.5),
        contours(r, [this](const Vec3d& origin,
                           const Vec3d& direction) { return pick(origin, direction); }),
        plain(r),
        legend(r) {}

  vtkRenderer& renderer;
  Surface surface;
  LineLayer edges, outline;
  ContourLayer contours;
  PlainLayer plain;
  std::optional<SkyLayer> sky;
  Legend legend;

  const PlainThings* things = nullptr;
  std::vector<double> factors;             // of light groups
  std::vector<std::uint8_t> hidden_thing;  // by thing
  Triangles thing_triangles;               // that hide what is behind them
  mutable std::unique_ptr<Picker> thing_picker;

  const Mesh* mesh = nullptr;
  std::vector<Field> fields;
  std::optional<PictureState> state;  ///< shown now; absent: everything is to be made again
  bool geometry_changed = true;
  bool moving = false;
  std::vector<Selection> built_hidden;
  bool built_no_ceilings = false;
  std::vector<std::uint8_t> shown;  ///< by polygon
  Triangles triangles;
  mutable std::unique_ptr<Picker> picker;
  std::array<std::optional<Values>, 2> values;  ///< by side, as coloured
  vtkSmartPointer<vtkLookupTable> table;
  Range range;
  std::optional<std::vector<SeenPlace>> seen;  ///< by the camera when last asked
  std::optional<double> automatic_ev;
  std::vector<double> levels;

  [[nodiscard]] const Field& field() const { return fields[state->field]; }
  [[nodiscard]] bool has(Side side) const { return shows(state->side, side); }

  void update_geometry(const PictureState& next) {
    shown.assign(mesh->polygon_count(), 1);
    for (const Selection& s : next.hidden) hide(selected(*mesh, s));
    if (next.no_ceilings) hide(find_ceilings(*mesh));
    triangles = triangulate(*mesh, shown);
    surface.set_geometry(*mesh, triangles, coarsen(*mesh, triangles, kWhileMoving));
    picker.reset();
    update_things(next);
    seen.reset();
    update_moving();
    geometry_changed = false;
    built_hidden = next.hidden;
    built_no_ceilings = next.no_ceilings;
  }
  void update_things(const PictureState& next) {
    if (things == nullptr) return;
    hidden_thing = hidden_things(*things, *mesh, next.hidden, next.no_ceilings);
    std::vector<std::uint8_t> hides(things->shapes.polygon_count());
    for (std::size_t k = 0; k < hides.size(); ++k) {
      const auto thing = static_cast<std::size_t>(id_at(things->shapes, "object_id", k));
      hides[k] = hidden_thing[thing] == 0 && !things->is_glass(thing) ? 1 : 0;
    }
    thing_triangles = hides.empty() ? Triangles{} : triangulate(things->shapes, hides);
    thing_picker.reset();
  }
  [[nodiscard]] bool is_large() const { return triangles.size() > kWhileMoving; }
  void update_moving() {
    surface.moving(moving && is_large());
    edges.hide(moving && is_large());
    contours.moving(moving && is_large());
  }
  void hide(const std::vector<std::uint8_t>& polygons) {
    for (std::size_t k = 0; k < shown.size(); ++k) shown[k] = polygons[k] != 0 ? 0 : shown[k];
  }

  const Picker& get_picker() const {
    if (!picker) picker = std::make_unique<Picker>(*mesh, triangles);
    return *picker;
  }

  [[nodiscard]] std::optional<Picker::Hit> thing_hit(const Vec3d& origin,
                                                     const Vec3d& direction) const {
    if (thing_triangles.size() == 0) return std::nullopt;
    if (!thing_picker) thing_picker = std::make_unique<Picker>(things->shapes, thing_triangles);
    return thing_picker->pick(origin, direction, state->clips, false);
  }
  /// First thing along a ray: of the mesh, or without values.
  struct First {
    std::optional<Picker::Hit> mesh, thing;
  };
  [[nodiscard]] First first_hit(const Vec3d& origin, const Vec3d& direction) const {
    First f{get_picker().pick(origin, direction, state->clips, state->cull),
            thing_hit(origin, direction)};
    if (f.mesh && f.thing)
      (f.thing->position - origin).norm() < (f.mesh->position - origin).norm() ? f.mesh.reset()
                                                                               : f.thing.reset();
    return f;
  }
  [[nodiscard]] std::optional<Picker::Hit> pick(const Vec3d& origin, const Vec3d& direction) const {
    return first_hit(origin, direction).mesh;
  }

  const std::vector<SeenPlace>& get_seen() {
    if (!seen)
      seen = seen_places([this](const Vec3d& o, const Vec3d& d) { return pick(o, d); },
                         *renderer.GetActiveCamera(), renderer.GetTiledAspectRatio());
    return *seen;
  }

  /// Everything that depends on field and values.
  void update_values() {
    for (const Side side : {Side::Front, Side::Back})
      values[static_cast<std::size_t>(side)] =
          has(side) ? std::optional(values_of(*mesh, field(), side, !state->flat)) : std::nullopt;
  }

  /// Suits what the camera saw when it was last asked for; everything if it saw nothing.
  [[nodiscard]] Range suitable_range(const Field& f) {
    const std::vector<Weighted> of_view = seen_values(*mesh, f, get_seen(), state->side);
    return automatic_range(
        of_view.empty() ? weighted_values(*mesh, f, state->side, true, shown) : of_view,
        state->logarithmic);
  }

  void update_range() {
    const bool scale = field().look == Look::Scale || field().look == Look::Error;
    if (!scale) return;
    range = state->range ? *state->range : suitable_range(field());
    table = make_table(field().look, range);
  }

  void update_colours() {
    for (const Side side : {Side::Front, Side::Back}) {
      const auto& v = values[static_cast<std::size_t>(side)];
      if (!v) continue;
      switch (field().look) {
        case Look::Scale:
        case Look::Error:
          surface.colour(side, *v, table);
          break;
        case Look::TrueColour:
          surface.colour(side, v->place, tone_mapped(*v, exposure()));
          break;
        case Look::Surface:
          surface.colour(side, v->place, surface_colours(*v));
          break;
        case Look::Classes:
          surface.colour(side, v->place, class_colours(*v));
          break;
      }
    }
  }

  void update_plain() {
    if (things == nullptr || things->model.primitives.empty()) return;
    const bool true_colour = !fields.empty() && field().look == Look::TrueColour;
    const std::optional<double> ev = true_colour ? std::optional(exposure()) : std::nullopt;
    plain.show(*things, {ev, factors, hidden_thing});
    if (sky) ev ? sky->show(*things, factors, *ev) : sky->hide();
  }

  double exposure() {
    if (state->ev) return *state->ev;
    if (!automatic_ev)
      automatic_ev =
          exposure_of(*mesh, fields[find_field(fields, "radiosity")], get_seen(), state->side);
    return *automatic_ev;
  }

  void update_contours() {
    levels.clear();
    contours.clear();
    if (!state->contours.any() || field().look == Look::Classes) return;
    Field numbers = field();
    if (numbers.look == Look::TrueColour)
      if (const auto lux = std::find_if(fields.begin(), fields.end(),
                                        [](const Field& f) { return f.name == "illuminance"; });
          lux != fields.end())
        numbers = *lux;
    const bool scale = numbers.look == Look::Scale || numbers.look == Look::Error;
    const Range span = scale && numbers.name == field().name ? range : suitable_range(numbers);
    levels = state->contours.levels.empty() ? round_levels(span, state->contours.count)
                                            : state->contours.levels;
    for (const Side side : {Side::Front, Side::Back})
      if (has(side) && (side == Side::Front || numbers.sided))
        contours.add(find_contours(*mesh, triangles, side, numbers_of(*mesh, numbers, side, true),
                                   levels, state->clips),
                     mesh->diagonal);
  }

  void update_legend() {
    if (!state->legend) {
      legend.hide();
      return;
    }
    if (field().look == Look::Classes)
      legend.show_classes(field().array == "element_id" ? std::vector<Legend::Entry>{}
                                                        : class_entries(*mesh, field(), shown));
    else if (field().look == Look::Scale || field().look == Look::Error)
      legend.show_scale(field().title, table, range, levels);
    else
      legend.hide();
  }

  void update_surface() {
    Surface::Shown s;
    s.front = has(Side::Front);
    s.back = has(Side::Back) && !(state->cull && state->side == ShownSide::Seen);
    s.only_facing = state->side == ShownSide::Seen || state->cull;
    s.lit = field().look == Look::Classes || field().look == Look::Surface;
    s.behind_lines = state->edges || !levels.empty() || state->selection != Selection{};
    surface.show(s);
  }
};

Picture::Picture(vtkRenderer& renderer) : impl_(std::make_unique<Impl>(renderer)) {}
Picture::~Picture() = default;

void Picture::set_mesh(const Mesh& mesh, bool same_geometry) {
  impl_->mesh = &mesh;
  impl_->fields = fields_of(mesh);
  impl_->state.reset();
  impl_->geometry_changed = impl_->geometry_changed || !same_geometry;
}

void Picture::set_things(const PlainThings& things) {
  impl_->things = &things;
  if (things.has_sky()) impl_->sky.emplace(*impl_->renderer.GetRenderWindow(), impl_->renderer);
  impl_->geometry_changed = true;
}
void Picture::set_factors(const std::vector<double>& factors) { impl_->factors = factors; }

void Picture::show(const PictureState& next) {
  Impl& p = *impl_;
  const PictureState* old = p.state ? &*p.state : nullptr;
  const bool geometry = p.geometry_changed || p.built_hidden != next.hidden ||
                        p.built_no_ceilings != next.no_ceilings;
  const bool values = geometry || old == nullptr || old->field != next.field ||
                      old->side != next.side || old->flat != next.flat;
  const bool range = values || old->range != next.range || old->logarithmic != next.logarithmic;
  const bool colours = range || old->ev != next.ev;
  const bool contours = range || old->contours != next.contours || old->clips != next.clips;
  const bool lines = geometry || old == nullptr || old->edges != next.edges;
  const bool clips = old == nullptr || old->clips != next.clips;
  const bool legend = old == nullptr || old->legend != next.legend;
  const bool outline = geometry || old == nullptr || old->selection != next.selection;
  if (geometry) p.update_geometry(next);
  p.state = next;
  if (clips) {
    p.surface.clip(next.clips);
    p.edges.clip(next.clips);
    p.outline.clip(next.clips);
    p.plain.clip(next.clips);
  }
  if (colours) p.update_plain();
  if (p.fields.empty()) return p.surface.show({true, true, false, true, next.edges});
  if (values) p.update_values();
  if (range) p.update_range();
  if (colours) p.update_colours();
  if (contours) p.update_contours();
  if (contours || legend) p.update_legend();
  p.update_surface();
  if (lines) next.edges ? p.edges.show_edges(*p.mesh, p.shown) : p.edges.clear();
  if (outline) {
    if (next.selection == Selection{})
      p.outline.clear();
    else
      p.outline.show_outline(*p.mesh, selected(*p.mesh, next.selection));
  }
}

bool Picture::is_large() const { return impl_->is_large(); }

void Picture::moving(bool coarse) {
  impl_->moving = coarse;
  impl_->update_moving();
}

const Field& Picture::field() const { return impl_->field(); }
const std::vector<Field>& Picture::fields() const { return impl_->fields; }
std::string Picture::title() const {
  return impl_->fields.empty() ? "no arrays" : impl_->field().title;
}
std::size_t Picture::triangle_count() const { return impl_->triangles.size(); }
const Range& Picture::range() const { return impl_->range; }
const std::vector<double>& Picture::contour_levels() const { return impl_->levels; }
std::size_t Picture::label_count() const { return impl_->contours.label_count(); }
double Picture::ev() const { return impl_->state->ev.value_or(impl_->automatic_ev.value_or(0.0)); }
void Picture::look_again() {
  impl_->seen.reset();
  impl_->automatic_ev.reset();
  impl_->state.reset();
}

double Picture::value_at(const Picker::Hit& hit) const {
  const Impl& p = *impl_;
  const Side side = p.state->side == ShownSide::Seen    ? (hit.front ? Side::Front : Side::Back)
                    : p.state->side == ShownSide::Front ? Side::Front
                                                        : Side::Back;
  const auto& shown = p.values[static_cast<std::size_t>(side)];
  if (!shown) return std::nan("");
  const auto number = [&](std::size_t i) {
    const float* v = &shown->numbers[i * static_cast<std::size_t>(shown->components)];
    return static_cast<double>(shown->components == 3 ? luminance_at(v) : v[0]);
  };
  if (shown->place == Place::Polygons) return number(hit.polygon);
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) sum += hit.weights[c] * number(hit.corners[c]);
  return sum;
}

std::optional<Picker::Hit> Picture::pick(const Vec3d& origin, const Vec3d& direction) const {
  return impl_->pick(origin, direction);
}

std::optional<std::string> Picture::thing_at(const Vec3d& origin, const Vec3d& direction) const {
  const auto hit = impl_->first_hit(origin, direction).thing;
  if (!hit) return std::nullopt;
  const PlainThings& things = *impl_->things;
  return things.name(static_cast<std::size_t>(id_at(things.shapes, "object_id", hit->polygon)));
}

Statistics Picture::statistics() const {
  const Impl& p = *impl_;
  return make_statistics(weighted_values(*p.mesh, p.field(), p.state->side, false,
                                         selected(*p.mesh, p.state->selection)));
}

}  // namespace atrium::view
