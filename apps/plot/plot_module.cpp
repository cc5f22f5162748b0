// The only code besides atrium-view that draws with VTK; a module of its own so that the program
// does not load VTK. No window is made, so no display is needed.
#include "plot/plot_module.h"

#include <vtkContext2D.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkObject.h>

#include <exception>

#include "plot/canvas.h"
#include "plot/chart_device.h"
#include "plot/panels.h"

namespace atrium::plot {
namespace {

void paint(vtkContextScene* scene, Canvas* canvas) {
  vtkNew<ChartDevice> device;
  device->set_canvas(canvas);
  vtkNew<vtkContext2D> painter;
  painter->Begin(device);
  scene->Paint(painter);
  painter->End();
}

class VtkPlotModule final : public PlotModule {
 public:
  // VTK would print to stderr; what goes wrong comes back as text instead.
  VtkPlotModule() { vtkObject::GlobalWarningDisplayOff(); }

  std::string write(const std::vector<Panel>& panels, const Picture& picture, Format format,
                    const std::string& file) const override try {
    vtkNew<vtkContextScene> scene;
    int size[2] = {picture.width, picture.height};
    scene->SetGeometry(size);
    add_panels(panels, picture, scene);
    const auto canvas = format == Format::Svg
                            ? make_svg_canvas(picture.width, picture.height)
                            : make_image_canvas(picture.width, picture.height, picture.pixel_ratio);
    // The first pass measures labels and legends; the layout is right in the second.
    paint(scene, nullptr);
    paint(scene, canvas.get());
    return canvas->write(file);
  } catch (const std::exception& e) {
    return e.what();
  }
};

}  // namespace
}  // namespace atrium::plot

extern "C" __attribute__((visibility("default"))) const atrium::plot::PlotModule* atrium_plot(
    int interface_version) {
  static const atrium::plot::VtkPlotModule module;
  return interface_version == atrium::plot::kPlotInterface ? &module : nullptr;
}
