#include "contour_layer.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "callback.h"
#include "overlay.h"
#include "range.h"

namespace atrium::view {
namespace {

constexpr std::size_t kMostLabels = 60;
constexpr vtkIdType kWhileMoving = 30000;  // points of lines

vtkSmartPointer<vtkTextActor> make_text(vtkRenderer& renderer) {
  auto text = vtkSmartPointer<vtkTextActor>::New();
  vtkTextProperty* look = text->GetTextProperty();
  look->SetColor(1.0, 1.0, 1.0);
  look->SetBackgroundColor(0.0, 0.0, 0.0);
  look->SetBackgroundOpacity(0.65);
  look->SetJustificationToCentered();
  look->SetVerticalJustificationToCentered();
  text->GetPositionCoordinate()->SetCoordinateSystemToViewport();
  text->VisibilityOff();
  renderer.AddViewProp(text);
  return text;
}

/// Place in the picture [pixels]; nothing behind the camera.
std::optional<Vec2d> project(vtkRenderer& renderer, const Vec3d& p) {
  vtkCamera& camera = *renderer.GetActiveCamera();
  const Vec3d ahead(camera.GetDirectionOfProjection());
  if ((p - Vec3d(camera.GetPosition())).dot(ahead) <= 0.0) return std::nullopt;
  renderer.SetWorldPoint(p.x(), p.y(), p.z(), 1.0);
  renderer.WorldToDisplay();
  const double* d = renderer.GetDisplayPoint();
  return Vec2d(d[0], d[1]);
}

}  // namespace

ContourLayer::ContourLayer(vtkRenderer& renderer, Pick pick)
    : renderer_(renderer), pick_(std::move(pick)) {
  observer_ = renderer.AddObserver(vtkCommand::StartEvent, callback([this] { place(); }));
}
ContourLayer::~ContourLayer() { renderer_.RemoveObserver(observer_); }

void ContourLayer::add(const vtkSmartPointer<vtkPolyData>& lines, double size) {
  if (lines->GetNumberOfLines() == 0) return;
  size_ = size;
  add_actor(*lines, false);
  add_actor(*thinned(*lines, kWhileMoving), true);
  update_visibility();
  for (const ContourLabel& label : place_labels(*lines, 0.02 * size)) labels_.push_back(label);
}

void ContourLayer::add_actor(vtkPolyData& lines, bool coarse) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(&lines);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.0, 0.0, 0.0);
  actor->GetProperty()->SetLineWidth(coarse ? 1.0f : 1.5f);
  actor->GetProperty()->LightingOff();
  renderer_.AddActor(actor);
  lines_.push_back({std::move(actor), coarse});
}

void ContourLayer::moving(bool coarse) {
  coarse_ = coarse;
  update_visibility();
}

void ContourLayer::update_visibility() {
  for (const Lines& l : lines_) l.actor->SetVisibility(l.coarse == coarse_);
}

void ContourLayer::clear() {
  for (const Lines& l : lines_) renderer_.RemoveActor(l.actor);
  for (const auto& t : texts_) renderer_.RemoveViewProp(t);
  lines_.clear();
  texts_.clear();
  labels_.clear();
}

std::size_t ContourLayer::label_count() const {
  return static_cast<std::size_t>(std::count_if(
      texts_.begin(), texts_.end(), [](const auto& t) { return t->GetVisibility() != 0; }));
}

/// Where a line is seen and no other label stands.
void ContourLayer::place() {
  if (coarse_) {
    for (const auto& t : texts_) t->VisibilityOff();
    return;
  }
  const int* extent = renderer_.GetSize();
  if (labels_.empty() || extent[0] < 2 || extent[1] < 2) return;
  const double aspect = static_cast<double>(extent[0]) / extent[1];
  const int letters = std::max(7, letter_size(extent[1]) - 2);
  std::vector<Vec2d> used;
  for (const ContourLabel& label : labels_) {
    if (used.size() >= kMostLabels) break;
    const auto at = project(renderer_, label.position);
    if (!at || at->x() < 0.0 || at->y() < 0.0 || at->x() > extent[0] || at->y() > extent[1])
      continue;
    const bool crowded = std::any_of(used.begin(), used.end(), [&](const Vec2d& u) {
      return std::abs(u.x() - at->x()) < 4.5 * letters && std::abs(u.y() - at->y()) < 1.6 * letters;
    });
    if (crowded) continue;
    const ViewRay ray = view_ray(*renderer_.GetActiveCamera(), aspect,
                                 2.0 * at->x() / extent[0] - 1.0, 2.0 * at->y() / extent[1] - 1.0);
    const auto hit = pick_(ray.origin, ray.direction);
    if (!hit || (hit->position - label.position).norm() > 0.0015 * size_) continue;
    if (used.size() == texts_.size()) texts_.push_back(make_text(renderer_));
    vtkTextActor& text = *texts_[used.size()];
    char value[32];
    std::snprintf(value, sizeof value, level_format(), label.value);
    text.SetInput(value);
    text.GetTextProperty()->SetFontSize(letters);
    text.SetPosition(at->x(), at->y());
    text.VisibilityOn();
    used.push_back(*at);
  }
  for (std::size_t i = used.size(); i < texts_.size(); ++i) texts_[i]->VisibilityOff();
}

}  // namespace atrium::view
