#include "window.h"

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "callback.h"
#include "camera_rig.h"
#include "navigation.h"
#include "seen_light.h"

namespace atrium::view {
namespace {

constexpr unsigned long kTimerMs = 50;

/// What a mesh without a solution can show.
ViewCommand for_bare_mesh(ViewCommand c) {
  const LookOptions asked = c.look;
  c.look = {};
  c.look.camera = asked.camera;
  c.look.clips = asked.clips;
  c.look.no_ceilings = asked.no_ceilings;
  c.look.no_legend = true;
  return c;
}

}  // namespace

Window::Window(Document document, const ViewCommand& command, std::unique_ptr<MeshSource> source)
    : command_(command),
      source_(std::move(source)),
      bare_(source_ != nullptr),
      weights_pending_(bare_ && !command.look.weights.empty()),
      stage_(std::move(document), bare_ ? for_bare_mesh(command) : command, false),
      histogram_(stage_.renderer()),
      interactor_(vtkSmartPointer<vtkRenderWindowInteractor>::New()),
      navigation_(vtkSmartPointer<Navigation>::New()),
      view_(choose_view(command.look.camera, stage_.document().views)) {
  interactor_->SetRenderWindow(&stage_.window());
  interactor_->SetInteractorStyle(navigation_);
  navigation_->SetDefaultRenderer(&stage_.renderer());
  navigation_->hovered = [this] { hover(); };
  navigation_->stepped = [this] { step_coarsely(); };
  connect();
  sliders_ = std::make_unique<Sliders>(
      *interactor_, [this](std::size_t group, double factor) { set_weight(group, factor); });
  redraw();
  interactor_->Initialize();
  sliders_->set_groups(stage_.weights().groups(), stage_.weights().factors());
}

/// Window and interactor hold each other; later event loops would ask for this one's events.
Window::~Window() {
  sliders_.reset();
  interactor_->SetInteractorStyle(nullptr);
  stage_.window().SetInteractor(nullptr);
  interactor_->SetRenderWindow(nullptr);
}

void Window::connect() {
  // VTK would take the program down by itself on 'q' and 'e'.
  interactor_->RemoveObservers(vtkCommand::CharEvent);
  interactor_->AddObserver(vtkCommand::KeyPressEvent,
                           callback([this] { key(interactor_->GetKeySym()); }));
  interactor_->AddObserver(vtkCommand::TimerEvent, callback([this] { poll(); }));
  navigation_->AddObserver(vtkCommand::StartInteractionEvent, callback([this] {
                             coarse_since_.reset();
                             stage_.picture().moving(true);
                           }));
  navigation_->AddObserver(vtkCommand::EndInteractionEvent, callback([this] {
                             stage_.picture().moving(false);
                             stage_.window().Render();
                           }));
  interactor_->AddObserver(vtkCommand::ConfigureEvent, callback([this] {
                             stage_.overlay().fit(stage_.window().GetSize()[1]);
                           }));
}

void Window::run(std::stop_token stop) {
  stop_ = std::move(stop);
  interactor_->CreateRepeatingTimer(kTimerMs);
  interactor_->Start();
  if (failure_) std::rethrow_exception(failure_);
}

bool Window::walking() const { return navigation_->walking; }

void Window::poll() {
  if (stop_.stop_requested()) return interactor_->TerminateApp();
  settle();
  if (!source_) return;
  try {
    std::optional<Mesh> mesh = source_->take();
    const MeshSource::Status status = source_->status();
    const bool news = mesh || status.text != message_;
    message_ = status.text;
    if (mesh) take_mesh(std::move(*mesh));
    if (weights_pending_ && (status.finished || !stage_.weights().groups().empty())) {
      weights_pending_ = false;
      stage_.set_weights(command_.look.weights);
      sliders_->set_groups(stage_.weights().groups(), stage_.weights().factors());
    }
    if (status.finished) source_.reset();
    if (news) redraw();
  } catch (...) {
    failure_ = std::current_exception();
    source_.reset();
    interactor_->TerminateApp();
  }
}

void Window::take_mesh(Mesh mesh) {
  const std::vector<std::string> before = stage_.weights().groups();
  stage_.set_mesh(std::move(mesh));
  probe_.reset();
  if (bare_) {
    bare_ = false;
    LookOptions look = command_.look;
    look.weights.clear();
    stage_.start_again(look);
  }
  if (stage_.weights().groups() != before)
    sliders_->set_groups(stage_.weights().groups(), stage_.weights().factors());
}

void Window::redraw() {
  stage_.render_texts(message_);
  stage_.picture().show(stage_.state);
  if (histogram_.shown()) histogram_.show(stage_.picture().statistics(), stage_.picture().title());
  stage_.render();
}

void Window::key(const std::string& symbol) {
  const double step = std::min(0.3, 0.03 * stage_.mesh().diagonal);
  if (symbol == "Up") return walk_step(step, 0.0);
  if (symbol == "Down") return walk_step(-step, 0.0);
  if (symbol == "Right") return walk_step(0.0, step);
  if (symbol == "Left") return walk_step(0.0, -step);
  if (const Key* k = find_key(symbol)) act(k->action);
}

void Window::act(Action action) {
  PictureState& s = stage_.state;
  message_.clear();
  switch (action) {
    case Action::Help:
      stage_.overlay().set_help(stage_.overlay().help_shown() ? "" : key_help());
      break;
    case Action::NextField:
      change_field(1);
      break;
    case Action::PreviousField:
      change_field(stage_.picture().fields().size() - 1);
      break;
    case Action::NextSide:
      s.side = s.side == ShownSide::Seen    ? ShownSide::Front
               : s.side == ShownSide::Front ? ShownSide::Back
                                            : ShownSide::Seen;
      break;
    case Action::Logarithmic:
      s.logarithmic = !s.logarithmic;
      s.range.reset();
      break;
    case Action::AutomaticRange:
      s.range.reset();
      s.ev.reset();
      stage_.picture().look_again();
      break;
    case Action::RangeUp:
      change_range(1.25);
      break;
    case Action::RangeDown:
      change_range(0.8);
      break;
    case Action::MoreExposure:
      change_exposure(-0.5);
      break;
    case Action::LessExposure:
      change_exposure(0.5);
      break;
    case Action::Contours:
      toggle_contours();
      break;
    case Action::MoreContours:
      change_contours(1);
      break;
    case Action::FewerContours:
      change_contours(-1);
      break;
    case Action::Flat:
      s.flat = !s.flat;
      break;
    case Action::Edges:
      s.edges = !s.edges;
      break;
    case Action::Cull:
      s.cull = !s.cull;
      break;
    case Action::Ceilings:
      s.no_ceilings = !s.no_ceilings;
      break;
    case Action::Clip:
      toggle_clip();
      break;
    case Action::ClipUp:
      move_up(1.0);
      break;
    case Action::ClipDown:
      move_up(-1.0);
      break;
    case Action::SelectObject:
      select(Selection::Kind::Object);
      break;
    case Action::SelectFacet:
      select(Selection::Kind::Facet);
      break;
    case Action::SelectNothing:
      s.selection = {};
      break;
    case Action::Statistics:
      if (histogram_.shown())
        histogram_.hide();
      else if (!stage_.picture().fields().empty())
        histogram_.show(stage_.picture().statistics(), stage_.picture().title());
      break;
    case Action::Sliders:
      if (sliders_->size() == 0) message_ = "one light group only: nothing to dim";
      sliders_->show(!sliders_->shown() && sliders_->size() > 0);
      break;
    case Action::NextCamera:
      next_camera();
      break;
    case Action::ResetCamera:
      stage_.look_from(view_);
      break;
    case Action::Walk:
      navigation_->walking = !navigation_->walking;
      message_ = navigation_->walking ? "walking" : "orbiting";
      break;
    case Action::Legend:
      s.legend = !s.legend;
      break;
    case Action::Screenshot:
      return save_picture();
    case Action::Quit:
      return interactor_->TerminateApp();
  }
  redraw();
}

void Window::change_field(std::size_t step) {
  const std::size_t count = stage_.picture().fields().size();
  if (count == 0) return;
  stage_.state.field = (stage_.state.field + step) % count;
  stage_.state.range.reset();
}

void Window::change_range(double factor) {
  Range r = stage_.picture().range();
  r.high = r.low + factor * (r.high - r.low);
  if (r.high > r.low) stage_.state.range = r;
}

void Window::change_exposure(double stops) { stage_.state.ev = stage_.picture().ev() + stops; }

void Window::toggle_contours() {
  ContourChoice& c = stage_.state.contours;
  if (c.any()) last_contours_ = c;
  c = c.any() ? ContourChoice{} : last_contours_;
}

/// Until their number changes: values stay round.
void Window::change_contours(int more) {
  constexpr int kMost = 60;
  const std::size_t now = stage_.picture().contour_levels().size();
  for (int n = static_cast<int>(now) + more; n >= 1 && n <= kMost; n += more) {
    if (round_levels(stage_.picture().range(), n).size() == now) continue;
    stage_.state.contours = {n, {}};
    return;
  }
}

void Window::toggle_clip() {
  std::vector<Clip>& clips = stage_.state.clips;
  const auto level = std::find_if(clips.begin(), clips.end(),
                                  [](const Clip& c) { return c.normal == Vec3d::UnitY(); });
  if (level != clips.end()) {
    clips.erase(level);
    return;
  }
  const auto hit = under_cursor();
  if (!hit) {
    message_ = "nothing under the cursor to cut at";
    return;
  }
  clips.push_back({Vec3d::UnitY(), hit->position.y() - 1e-4 * stage_.mesh().diagonal});
}

void Window::move_up(double sign) {
  const double step = sign * std::min(0.1, 0.01 * stage_.mesh().diagonal);
  if (navigation_->walking) {
    step_coarsely();
    return walk(*stage_.renderer().GetActiveCamera(), 0.0, 0.0, step);
  }
  for (Clip& c : stage_.state.clips)
    if (c.normal == Vec3d::UnitY()) c.distance += step;
}

void Window::walk_step(double ahead, double right) {
  if (!navigation_->walking) return;
  step_coarsely();
  walk(*stage_.renderer().GetActiveCamera(), ahead, right, 0.0);
  redraw();
}

/// Wheel and arrow keys come one by one: until none has come for a while, as while the mouse is
/// held.
void Window::step_coarsely() {
  if (!stage_.picture().is_large()) return;
  stage_.picture().moving(true);
  coarse_since_ = Clock::now();
}

void Window::settle() {
  constexpr auto kRest = std::chrono::milliseconds(250);
  const auto rests = [&](const std::optional<Clock::time_point>& since) {
    return since && Clock::now() - *since >= kRest;
  };
  if (rests(coarse_since_)) {
    coarse_since_.reset();
    stage_.picture().moving(false);
    stage_.window().Render();
  }
  if (rests(hovered_since_)) {
    hovered_since_.reset();
    show_probe();
  }
}

void Window::hover() {
  if (stage_.picture().is_large())
    hovered_since_ = Clock::now();
  else
    show_probe();
}

std::optional<Picker::Hit> Window::under_cursor() {
  const ViewRay ray = cursor_ray();
  return stage_.picture().pick(ray.origin, ray.direction);
}

ViewRay Window::cursor_ray() {
  const int* at = interactor_->GetEventPosition();
  const int* extent = stage_.window().GetSize();
  const double x = 2.0 * (at[0] + 0.5) / extent[0] - 1.0;
  const double y = 2.0 * (at[1] + 0.5) / extent[1] - 1.0;
  return view_ray(*stage_.renderer().GetActiveCamera(), static_cast<double>(extent[0]) / extent[1],
                  x, y);
}

void Window::select(Selection::Kind kind) {
  const auto hit = under_cursor();
  if (!hit) {
    message_ = "nothing under the cursor";
    return;
  }
  const auto object = id_at(stage_.mesh(), "object_id", hit->polygon);
  if (kind == Selection::Kind::Object && object >= 0)
    stage_.state.selection = {kind, static_cast<std::uint32_t>(object)};
  else
    stage_.state.selection = {Selection::Kind::Facet, static_cast<std::uint32_t>(hit->polygon)};
}

void Window::show_probe() {
  if (stage_.picture().fields().empty()) return;
  const ViewRay ray = cursor_ray();
  const auto hit = stage_.picture().pick(ray.origin, ray.direction);
  std::string text;
  if (const auto thing = stage_.picture().thing_at(ray.origin, ray.direction))
    text = (thing->empty() ? "this" : *thing) + ": has no elements, so no values";
  if (hit) {
    if (!probe_) probe_.emplace(stage_.mesh());
    text = probe_->describe(stage_.mesh(), stage_.picture().field(), *hit,
                            stage_.picture().value_at(*hit));
  }
  if (text == stage_.overlay().probe()) return;
  stage_.overlay().set_probe(text);
  stage_.window().Render();
}

void Window::next_camera() {
  const auto& views = stage_.document().views;
  camera_ = (camera_ + 1) % views.size();
  view_ = views[camera_];
  stage_.look_from(view_);
  message_ = "camera " + view_.name;
}

void Window::save_picture() {
  for (int i = 0; i < 10000; ++i) {
    const std::string file = "atrium-view-" + std::to_string(i) + ".png";
    if (std::filesystem::exists(file)) continue;
    try {
      stage_.save(file);
      message_ = "wrote " + file;
    } catch (const std::exception& e) {
      message_ = e.what();
    }
    return redraw();
  }
}

void Window::set_weight(std::size_t group, double factor) {
  stage_.set_weight(group, factor);
  redraw();
}

}  // namespace atrium::view
