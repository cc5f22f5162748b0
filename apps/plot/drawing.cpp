#include "plot/drawing.h"

#include <vtkContext2D.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>

#include <utility>

#include "plot/font.h"

namespace atrium::plot {
namespace {

constexpr double kTitleHeight = 30.0;

class Drawing final : public vtkContextItem {
 public:
  static Drawing* New();
  vtkTypeMacro(Drawing, vtkContextItem);
  Drawing(const Drawing&) = delete;
  void operator=(const Drawing&) = delete;
  bool Paint(vtkContext2D* painter) override {
    paint(painter);
    return true;
  }
  std::function<void(vtkContext2D*)> paint;

 private:
  Drawing() = default;
  ~Drawing() override = default;
};
vtkStandardNewMacro(Drawing);

}  // namespace

void add_drawing(vtkContextScene* scene, std::function<void(vtkContext2D*)> paint) {
  vtkNew<Drawing> drawing;
  drawing->paint = std::move(paint);
  scene->AddItem(drawing);
}

void set_text(vtkTextProperty* style, int size, bool bold) {
  set_font(style, bold);
  style->SetFontSize(size);
  style->SetColor(0.13, 0.13, 0.13);
}

void draw_text(vtkContext2D* painter, double x, double y, const std::string& text, int size,
               bool bold) {
  vtkNew<vtkTextProperty> style;
  set_text(style, size, bold);
  style->SetJustificationToCentered();
  style->SetVerticalJustificationToCentered();
  painter->ApplyTextProp(style);
  painter->DrawString(static_cast<float>(x), static_cast<float>(y), text);
}

void add_title(const std::string& title, Box& box, vtkContextScene* scene) {
  if (title.empty()) return;
  box.y1 -= kTitleHeight;
  add_drawing(
      scene, [x = 0.5 * (box.x0 + box.x1), y = box.y1 + 0.5 * kTitleHeight,
              title](vtkContext2D* painter) { draw_text(painter, x, y, title, kTitleSize, true); });
}

}  // namespace atrium::plot
