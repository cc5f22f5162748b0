#include "sliders.h"

#include <vtkCommand.h>
#include <vtkCoordinate.h>
#include <vtkNew.h>
#include <vtkProperty2D.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSliderRepresentation2D.h>
#include <vtkSliderWidget.h>
#include <vtkTextProperty.h>

#include <algorithm>

namespace atrium::view {
namespace {

constexpr double kMost = 2.0;
constexpr std::size_t kRows = 8;  // then the next column

class Moved : public vtkCommand {
 public:
  static Moved* New() { return new Moved; }
  void Execute(vtkObject* caller, unsigned long, void*) override {
    auto* widget = static_cast<vtkSliderWidget*>(caller);
    act(static_cast<vtkSliderRepresentation*>(widget->GetRepresentation())->GetValue());
  }
  std::function<void(double)> act;
};

vtkSmartPointer<vtkSliderRepresentation2D> representation(const std::string& group, double factor,
                                                          std::size_t index) {
  auto r = vtkSmartPointer<vtkSliderRepresentation2D>::New();
  const std::size_t column = index / kRows, row = index % kRows;
  const double x = 0.02 + 0.2 * static_cast<double>(column);
  const double y = 0.78 - 0.085 * static_cast<double>(row);
  r->GetPoint1Coordinate()->SetCoordinateSystemToNormalizedDisplay();
  r->GetPoint1Coordinate()->SetValue(x, y);
  r->GetPoint2Coordinate()->SetCoordinateSystemToNormalizedDisplay();
  r->GetPoint2Coordinate()->SetValue(x + 0.17, y);
  r->SetMinimumValue(0.0);
  r->SetMaximumValue(kMost);
  r->SetValue(std::min(factor, kMost));
  r->SetTitleText(group.c_str());
  r->SetLabelFormat("%.2f");
  r->SetSliderLength(0.02);
  r->SetSliderWidth(0.025);
  r->SetTubeWidth(0.006);
  r->SetEndCapLength(0.003);
  r->SetEndCapWidth(0.02);
  r->SetTitleHeight(0.02);
  r->SetLabelHeight(0.018);
  r->GetSliderProperty()->SetColor(0.95, 0.75, 0.2);
  r->GetTitleProperty()->ShadowOff();
  r->GetTitleProperty()->ItalicOff();
  r->GetLabelProperty()->ShadowOff();
  r->GetLabelProperty()->ItalicOff();
  return r;
}

}  // namespace

Sliders::Sliders(vtkRenderWindowInteractor& interactor,
                 std::function<void(std::size_t, double)> changed)
    : interactor_(interactor), changed_(std::move(changed)) {}

Sliders::~Sliders() {
  for (const auto& w : widgets_) w->Off();
}

void Sliders::set_groups(const std::vector<std::string>& groups,
                         const std::vector<double>& factors) {
  const bool was = shown_;
  show(false);
  widgets_.clear();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    auto widget = vtkSmartPointer<vtkSliderWidget>::New();
    widget->SetInteractor(&interactor_);
    widget->SetRepresentation(representation(groups[g], factors[g], g));
    widget->SetAnimationModeToJump();
    vtkNew<Moved> moved;
    moved->act = [this, g](double factor) { changed_(g, factor); };
    widget->AddObserver(vtkCommand::InteractionEvent, moved);
    widgets_.push_back(std::move(widget));
  }
  show(was);
}

void Sliders::show(bool shown) {
  shown_ = shown;
  for (const auto& w : widgets_) shown ? w->On() : w->Off();
}

}  // namespace atrium::view
