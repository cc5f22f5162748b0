#include "stage.h"

#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "camera_rig.h"
#include "material/error.h"
#include "scene/output_file.h"
#include "selection.h"
#include "statistics.h"

namespace atrium::view {
namespace {

vtkSmartPointer<vtkRenderer> make_renderer() {
  auto renderer = vtkSmartPointer<vtkRenderer>::New();
  renderer->SetBackground(0.12, 0.12, 0.12);
  return renderer;
}

/// An empty picture would leave people to guess. \throws Error.
void check_clips(const std::vector<Clip>& clips, const Mesh& mesh) {
  for (const Clip& c : clips) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3d& p : mesh.polygons.points) nearest = std::min(nearest, c.normal.dot(p));
    if (nearest <= c.distance) continue;
    char text[160];
    std::snprintf(text, sizeof text,
                  "--clip: leaves nothing: along (%.3g, %.3g, %.3g) the mesh begins at %.4g, not "
                  "below %.4g",
                  c.normal.x(), c.normal.y(), c.normal.z(), nearest, c.distance);
    throw Error(text);
  }
}

bool same_geometry(const scene::PolygonMesh& a, const scene::PolygonMesh& b) {
  return a.polygon_sizes == b.polygon_sizes && a.polygon_points == b.polygon_points &&
         a.points == b.points;
}

}  // namespace

PictureState initial_state(const LookOptions& look, const Mesh& mesh) {
  const std::vector<Field> fields = fields_of(mesh);
  PictureState s;
  s.field = fields.empty() && look.field.empty() ? 0 : find_field(fields, look.field);
  s.side = look.side;
  s.logarithmic = look.logarithmic;
  if (look.range) s.range = Range{(*look.range)[0], (*look.range)[1], look.logarithmic};
  s.ev = look.ev;
  s.contours = look.contours;
  check_clips(look.clips, mesh);
  s.clips = look.clips;
  s.flat = look.flat;
  s.edges = look.edges;
  s.cull = look.cull;
  s.no_ceilings = look.no_ceilings;
  s.legend = !look.no_legend;
  for (const std::string& text : look.hidden)
    s.hidden.push_back(parse_selection("--hide", text, mesh));
  return s;
}

Weights initial_weights(const LookOptions& look, const Mesh& mesh) {
  Weights weights(mesh);
  for (const auto& [group, factor] : look.weights) weights.set(group, factor);
  return weights;
}

Stage::Stage(Document document, const ViewCommand& command, bool off_screen)
    : document_(std::move(document)),
      weights_(initial_weights(command.look, document_.mesh)),
      window_(vtkSmartPointer<vtkRenderWindow>::New()),
      renderer_(make_renderer()),
      picture_(std::make_unique<Picture>(*renderer_)),
      overlay_(*renderer_) {
  state = initial_state(command.look, document_.mesh);
  if (!weights_.as_solved()) weights_.apply(document_.mesh);
  window_->SetWindowName(("atrium-view " + document_.title).c_str());
  window_->SetSize(command.size[0], command.size[1]);
  window_->SetOffScreenRendering(off_screen ? 1 : 0);
  // Software draws thin lines with gaps if a pixel has several samples.
  window_->SetMultiSamples(0);
  renderer_->SetUseFXAA(off_screen);
  window_->AddRenderer(renderer_);
  overlay_.fit(command.size[1]);
  picture_->set_things(document_.things);
  show_mesh(false);
  look_from(choose_view(command.look.camera, document_.views));
}

Stage::~Stage() = default;

void Stage::look_from(const ViewPoint& view) {
  set_camera(*renderer_->GetActiveCamera(), view);
  renderer_->ResetCameraClippingRange();
}

void Stage::set_weight(std::size_t group, double factor) {
  weights_.set(group, factor);
  weights_.apply(document_.mesh);
  show_mesh(true);
}

void Stage::set_weights(const std::vector<std::pair<std::string, double>>& factors) {
  for (const auto& [group, factor] : factors) weights_.set(group, factor);
  weights_.apply(document_.mesh);
  show_mesh(true);
}

void Stage::set_mesh(Mesh mesh) {
  const bool same = same_geometry(mesh.polygons, document_.mesh.polygons);
  Weights weights(mesh);
  if (weights.groups() == weights_.groups()) weights = weights_;
  weights_ = std::move(weights);
  document_.mesh = std::move(mesh);
  if (!weights_.as_solved()) weights_.apply(document_.mesh);
  show_mesh(same);
  if (!same) state.selection = {};
}

void Stage::start_again(const LookOptions& look) {
  const std::vector<Clip> clips = state.clips;
  state = initial_state(look, document_.mesh);
  state.clips = clips;
  show_mesh(true);
}

void Stage::show_mesh(bool same_geometry) {
  picture_->set_factors(weights_.factors());
  picture_->set_mesh(document_.mesh, same_geometry);
}

void Stage::render_texts(const std::string& message) {
  picture_->show(state);
  std::string text = picture_->title();
  if (!picture_->fields().empty() && picture_->field().look == Look::TrueColour) {
    char ev[32];
    std::snprintf(ev, sizeof ev, ", EV %.1f", picture_->ev());
    text += ev;
  }
  if (state.side != ShownSide::Seen) text += state.side == ShownSide::Front ? ", front" : ", back";
  for (std::size_t g = 0; g < weights_.groups().size(); ++g)
    if (weights_.factors()[g] != 1.0) {
      char factor[32];
      std::snprintf(factor, sizeof factor, " x %.2f", weights_.factors()[g]);
      text += "\n" + weights_.groups()[g] + factor;
    }
  if (state.selection != Selection{} && !picture_->fields().empty())
    text = to_text(picture_->statistics(), text, describe(document_.mesh, state.selection));
  overlay_.set_status(text + (message.empty() ? "" : "\n" + message));
}

void Stage::render() {
  picture_->show(state);
  renderer_->ResetCameraClippingRange();
  window_->Render();
}

void Stage::save(const std::string& file) {
  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window_);
  grab->ReadFrontBufferOff();
  grab->Update();
  scene::OutputFile output(file);
  vtkNew<vtkPNGWriter> writer;
  const std::string path = output.path().string();
  writer->SetFileName(path.c_str());
  writer->SetInputConnection(grab->GetOutputPort());
  writer->Write();
  if (writer->GetErrorCode() != 0) throw RuntimeFailure(file + ": cannot be written");
  output.commit();
}

}  // namespace atrium::view
