#include "overlay.h"

#include <vtkCoordinate.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>

namespace atrium::view {
namespace {

vtkSmartPointer<vtkTextActor> text_at(vtkRenderer& renderer, double x, double y) {
  auto actor = vtkSmartPointer<vtkTextActor>::New();
  actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  actor->GetPositionCoordinate()->SetValue(x, y);
  vtkTextProperty* look = actor->GetTextProperty();
  look->SetColor(1.0, 1.0, 1.0);
  look->SetBackgroundColor(0.1, 0.1, 0.1);
  look->SetBackgroundOpacity(0.6);
  actor->VisibilityOff();
  renderer.AddViewProp(actor);
  return actor;
}

void set(vtkTextActor& actor, const std::string& text) {
  actor.SetInput(text.c_str());
  actor.SetVisibility(!text.empty());
}

}  // namespace

/// Small pictures are shown as large as they are, so their letters are a larger part of them.
int letter_size(int height) { return std::clamp(height / 48, std::clamp(height / 30, 8, 11), 30); }

Overlay::Overlay(vtkRenderer& renderer)
    : status_(text_at(renderer, 0.01, 0.985)),
      probe_(text_at(renderer, 0.01, 0.015)),
      help_(text_at(renderer, 0.5, 0.5)) {
  status_->GetTextProperty()->SetVerticalJustificationToTop();
  vtkTextProperty* look = help_->GetTextProperty();
  look->SetFontFamilyToCourier();
  look->SetJustificationToCentered();
  look->SetVerticalJustificationToCentered();
  look->SetJustificationToLeft();
  look->SetBackgroundOpacity(0.85);
  help_->GetPositionCoordinate()->SetValue(0.2, 0.5);
}

void Overlay::set_status(const std::string& text) { set(*status_, text); }
void Overlay::set_probe(const std::string& text) { set(*probe_, text); }
void Overlay::set_help(const std::string& text) { set(*help_, text); }
std::string Overlay::status() const { return status_->GetInput(); }
std::string Overlay::probe() const {
  return probe_->GetVisibility() != 0 ? probe_->GetInput() : "";
}
bool Overlay::help_shown() const { return help_->GetVisibility() != 0; }

void Overlay::fit(int height) {
  for (const auto& actor : {status_, probe_})
    actor->GetTextProperty()->SetFontSize(letter_size(height));
  help_->GetTextProperty()->SetFontSize(std::clamp(height / 48, 6, 24));
}

}  // namespace atrium::view
