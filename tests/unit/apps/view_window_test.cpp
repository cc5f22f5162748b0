// Keys, mouse and sliders of the viewer's window, driven by the events that a user causes.
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <unistd.h>

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "camera_rig.h"
#include "material/error.h"
#include "support/grid_wall.h"
#include "support/lit_floor.h"
#include "support/temp_folder.h"
#include "support/view_room.h"
#include "support/virtual_display.h"
#include "window.h"

#ifdef ATRIUM_WITH_RADIOSITY
#include "live_solve.h"
#endif

namespace atrium::view {
namespace {

using test::ViewRoom;

constexpr int kWidth = 320, kHeight = 240;

Document document() {
  Document d;
  d.mesh = make_mesh(ViewRoom::mesh(), "room");
  d.mesh.objects = {"floor", "back wall", "left wall"};
  d.views.push_back(choose_view("5.5,4,6:2,0,1.5:45", {overview(d.mesh, 4.0 / 3.0)}));
  add_standard_views(d.mesh, 4.0 / 3.0, d.views);
  return d;
}

ViewCommand command(const std::string& field) {
  ViewCommand c;
  c.size = {kWidth, kHeight};
  c.look.field = field;
  return c;
}

/// A window and the hands of its user.
class User {
 public:
  explicit User(const std::string& field = "illuminance") : window(document(), command(field)) {}

  void key(const char* symbol) {
    window.interactor().SetKeySym(symbol);
    window.interactor().InvokeEvent(vtkCommand::KeyPressEvent);
    window.interactor().InvokeEvent(vtkCommand::CharEvent);
  }
  void move(int x, int y) {
    window.interactor().SetEventInformation(x, y);
    window.interactor().InvokeEvent(vtkCommand::MouseMoveEvent);
  }
  void drag(int x0, int y0, int x1, int y1) {
    move(x0, y0);
    window.interactor().InvokeEvent(vtkCommand::LeftButtonPressEvent);
    move((x0 + x1) / 2, (y0 + y1) / 2);
    move(x1, y1);
    window.interactor().InvokeEvent(vtkCommand::LeftButtonReleaseEvent);
  }
  /// Puts the cursor where a place of the room is seen.
  void point_at(const Vec3d& p) {
    vtkRenderer& r = window.stage().renderer();
    r.SetWorldPoint(p.x(), p.y(), p.z(), 1.0);
    r.WorldToDisplay();
    move(static_cast<int>(r.GetDisplayPoint()[0]), static_cast<int>(r.GetDisplayPoint()[1]));
  }
  [[nodiscard]] PictureState& state() { return window.stage().state; }
  [[nodiscard]] std::string status() { return window.stage().overlay().status(); }
  [[nodiscard]] std::string probe() { return window.stage().overlay().probe(); }
  [[nodiscard]] vtkCamera& camera() { return *window.stage().renderer().GetActiveCamera(); }

  Window window;
};

const Vec3d kOnFloor(3.1, 0.0, 2.1);

TEST(ViewWindow, KeysChangeWhatTheySay) {
  ATRIUM_NEEDS_DISPLAY();
  User user;
  const std::size_t field = user.state().field;
  user.key("f");
  EXPECT_EQ(user.state().field, field + 1);
  EXPECT_NE(user.status().find("irradiance"), std::string::npos) << user.status();
  user.key("F");
  EXPECT_EQ(user.state().field, field);
  user.key("b");
  EXPECT_EQ(user.state().side, ShownSide::Front);
  user.key("b");
  user.key("b");
  EXPECT_EQ(user.state().side, ShownSide::Seen);
  user.key("l");
  EXPECT_TRUE(user.window.stage().picture().range().logarithmic);
  user.key("l");
  const Range before = user.window.stage().picture().range();
  user.key("bracketright");
  EXPECT_DOUBLE_EQ(user.window.stage().picture().range().high, 1.25 * before.high);
  user.key("a");
  EXPECT_EQ(user.window.stage().picture().range(), before);
  for (const auto& [symbol, flag] :
       {std::pair("m", &PictureState::flat), std::pair("e", &PictureState::edges),
        std::pair("c", &PictureState::cull), std::pair("x", &PictureState::no_ceilings)}) {
    user.key(symbol);
    EXPECT_TRUE(user.state().*flag) << symbol;
    user.key(symbol);
    EXPECT_FALSE(user.state().*flag) << symbol;
  }
  user.key("n");
  EXPECT_FALSE(user.state().legend);
  user.key("question");
  EXPECT_TRUE(user.window.stage().overlay().help_shown());
  user.key("question");
  EXPECT_FALSE(user.window.stage().overlay().help_shown());
}

TEST(ViewWindow, EveryKeyIsListedOnceAndDoesNoHarm) {
  ATRIUM_NEEDS_DISPLAY();
  User user;
  for (const Key& k : keys()) {
    EXPECT_EQ(find_key(k.symbol), &k);
    if (k.action == Action::Quit || k.action == Action::Screenshot) continue;
    user.key(k.symbol);
  }
  user.key("nonsense");
}

/// 250,000 triangles: enough to be drawn with fewer while it moves.
Document large_document() {
  scene::PolygonMesh polygons;
  test::add_grid_wall(polygons, {0, 0, 4}, {4, 0, 0}, {0, 0, -4}, 360, 350);
  Array lux{"irradiance", 3, {}};
  for (const Vec3d& p : polygons.points)
    for (int c = 0; c < 3; ++c) lux.values.push_back(static_cast<float>(100.0 + 50.0 * p.x()));
  polygons.point_arrays = {std::move(lux)};
  Document d;
  d.mesh = make_mesh(std::move(polygons), "floor");
  add_standard_views(d.mesh, 4.0 / 3.0, d.views);
  return d;
}

// A full picture of a large mesh takes its time: wheel and arrows are followed by few triangles at
// once, and the rest comes when they have stopped; the probe when the cursor rests.
TEST(ViewWindow, LargeMeshesAnswerAtOnceAndSettle) {
  ATRIUM_NEEDS_DISPLAY();
  ViewCommand c = command("illuminance");
  c.look.contours.count = 5;
  Window window(large_document(), c);
  window.stage().look_from(choose_view("2,3,6:2,0,2:50", {}));
  window.stage().render();
  ASSERT_TRUE(window.stage().picture().is_large());
  EXPECT_TRUE(window.at_rest());
  EXPECT_GT(window.stage().picture().label_count(), 0U);
  window.interactor().SetEventInformation(kWidth / 2, kHeight / 2);
  const auto before = std::chrono::steady_clock::now();
  window.interactor().InvokeEvent(vtkCommand::MouseWheelForwardEvent);
  EXPECT_FALSE(window.at_rest());
  EXPECT_EQ(window.stage().picture().label_count(), 0U);
  window.poll();
  const auto taken = std::chrono::steady_clock::now() - before;
  EXPECT_TRUE(!window.at_rest() || taken > std::chrono::milliseconds(240));  // a slow machine
  std::this_thread::sleep_for(std::chrono::milliseconds(260));
  window.poll();
  EXPECT_TRUE(window.at_rest());
  EXPECT_GT(window.stage().picture().label_count(), 0U);
  window.interactor().InvokeEvent(vtkCommand::MouseMoveEvent);
  EXPECT_EQ(window.stage().overlay().probe(), "");
  std::this_thread::sleep_for(std::chrono::milliseconds(260));
  window.poll();
  EXPECT_NE(window.stage().overlay().probe().find("illuminance [lx]: "), std::string::npos);
}

TEST(ViewWindow, ContoursComeWithLabels) {
  ATRIUM_NEEDS_DISPLAY();
  User user;
  EXPECT_TRUE(user.window.stage().picture().contour_levels().empty());
  user.key("i");
  const std::size_t levels = user.window.stage().picture().contour_levels().size();
  EXPECT_GE(levels, 3u);
  EXPECT_GE(user.window.stage().picture().label_count(), 2u);
  user.key("period");
  user.key("period");
  EXPECT_GT(user.window.stage().picture().contour_levels().size(), levels);
  user.key("i");
  EXPECT_EQ(user.window.stage().picture().label_count(), 0u);
}

// What the probe says is what the field has there: linear between points 0.25 m apart.
TEST(ViewWindow, ProbeReadsTheFieldUnderTheCursor) {
  ATRIUM_NEEDS_DISPLAY();
  User user;
  user.point_at(kOnFloor);
  const std::string text = user.probe();
  const std::size_t colon = text.find("]: ");
  ASSERT_NE(colon, std::string::npos) << text;
  // A pixel is 4 cm, light changes by less than 400 lx/m.
  EXPECT_NEAR(std::stod(text.substr(colon + 3)),
              ViewRoom::lamp(kOnFloor) + ViewRoom::strip(kOnFloor), 20.0);
  EXPECT_NE(text.find("object 0 floor"), std::string::npos) << text;
  EXPECT_NE(text.find("(front)"), std::string::npos) << text;
  user.move(2, 2);  // beside the room
  EXPECT_TRUE(user.probe().empty()) << user.probe();
}

TEST(ViewWindow, SelectionHasStatistics) {
  ATRIUM_NEEDS_DISPLAY();
  User user;
  user.point_at(kOnFloor);
  user.key("p");
  EXPECT_EQ(user.state().selection, (Selection{Selection::Kind::Object, 0}));
  EXPECT_NE(user.status().find("object 0 floor"), std::string::npos) << user.status();
  EXPECT_NE(user.status().find("U0"), std::string::npos);
  EXPECT_NEAR(user.window.stage().picture().statistics().area, 12.0, 1e-4);
  user.key("P");
  EXPECT_EQ(user.state().selection.kind, Selection::Kind::Facet);
  EXPECT_NEAR(user.window.stage().picture().statistics().area, 12.0, 1e-4);
  user.key("h");
  EXPECT_TRUE(user.window.histogram().shown());
  user.key("h");
  EXPECT_FALSE(user.window.histogram().shown());
  user.key("u");
  EXPECT_EQ(user.state().selection, Selection{});
}

TEST(ViewWindow, CutFollowsCursorAndKeys) {
  ATRIUM_NEEDS_DISPLAY();
  User user;
  user.point_at({0.0, 2.0, 1.0});
  user.key("k");
  ASSERT_EQ(user.state().clips.size(), 1u);
  EXPECT_NEAR(user.state().clips[0].distance, 2.0, 0.05);
  EXPECT_EQ(user.state().clips[0].normal, Vec3d(0, 1, 0));
  const double before = user.state().clips[0].distance;
  user.key("Next");
  EXPECT_LT(user.state().clips[0].distance, before);
  EXPECT_FALSE(user.window.stage().picture().pick({1.0, 2.5, 1.0}, {-1, 0, 0}));
  user.key("k");
  EXPECT_TRUE(user.state().clips.empty());
  EXPECT_TRUE(user.window.stage().picture().pick({1.0, 2.5, 1.0}, {-1, 0, 0}));
}

TEST(ViewWindow, MouseOrbitsRoundTheTarget) {
  ATRIUM_NEEDS_DISPLAY();
  User user;
  const Vec3d target(user.camera().GetFocalPoint());
  const double distance = user.camera().GetDistance();
  const Vec3d eye(user.camera().GetPosition());
  user.drag(200, 120, 140, 120);
  EXPECT_LT((Vec3d(user.camera().GetFocalPoint()) - target).norm(), 1e-9);
  EXPECT_NEAR(user.camera().GetDistance(), distance, 1e-9);
  EXPECT_NEAR(user.camera().GetPosition()[1], eye.y(), 1e-9) << "sideways only";
  // 60 of 240 pixels are 45 degrees.
  const Vec3d a = eye - target, b = Vec3d(user.camera().GetPosition()) - target;
  const double angle = std::atan2(a.x() * b.z() - a.z() * b.x(), a.x() * b.x() + a.z() * b.z());
  EXPECT_NEAR(std::abs(angle), M_PI / 4, 1e-6);
  user.drag(200, 20, 200, 230);  // far beyond the pole
  EXPECT_GT(user.camera().GetViewUp()[1], 0.9);
  user.key("r");
  EXPECT_LT((Vec3d(user.camera().GetPosition()) - eye).norm(), 1e-9);
}

TEST(ViewWindow, WalkingKeepsTheEyeOrItsHeight) {
  ATRIUM_NEEDS_DISPLAY();
  User user;
  user.key("Up");  // orbiting: arrows do nothing
  const Vec3d eye(user.camera().GetPosition());
  EXPECT_LT((eye - Vec3d(5.5, 4, 6)).norm(), 1e-9);
  user.key("w");
  EXPECT_TRUE(user.window.walking());
  user.drag(100, 100, 160, 130);
  EXPECT_LT((Vec3d(user.camera().GetPosition()) - eye).norm(), 1e-9) << "turns the head";
  user.key("Up");
  EXPECT_NEAR(user.camera().GetPosition()[1], eye.y(), 1e-9);
  EXPECT_GT((Vec3d(user.camera().GetPosition()) - eye).norm(), 0.1);
  user.key("Prior");
  EXPECT_GT(user.camera().GetPosition()[1], eye.y());
}

TEST(ViewWindow, CamerasFollowEachOther) {
  ATRIUM_NEEDS_DISPLAY();
  User user;
  user.key("v");
  EXPECT_NE(user.status().find("camera overview"), std::string::npos) << user.status();
  user.key("v");
  EXPECT_TRUE(user.camera().GetParallelProjection());
  user.key("v");
  EXPECT_LT((Vec3d(user.camera().GetPosition()) - Vec3d(5.5, 4, 6)).norm(), 1e-9);
}

// The slider of the first group is pulled to its left end: the lamp goes out at once.
TEST(ViewWindow, SlidersDimAtOnce) {
  ATRIUM_NEEDS_DISPLAY();
  User user;
  user.key("g");
  ASSERT_TRUE(user.window.sliders().shown());
  ASSERT_EQ(user.window.sliders().size(), 2u);
  user.point_at(kOnFloor);
  // From 1 (the middle of x = 0.02 .. 0.19) at y = 0.78.
  const int y = static_cast<int>(0.78 * kHeight);
  user.drag(static_cast<int>(0.105 * kWidth), y, static_cast<int>(0.01 * kWidth), y);
  EXPECT_LT(user.window.stage().weights().factors()[0], 0.05);
  EXPECT_EQ(user.window.stage().weights().factors()[1], 1.0);
  EXPECT_NE(user.status().find("lamp x 0.0"), std::string::npos) << user.status();
  user.point_at(kOnFloor);
  const std::string text = user.probe();
  const std::size_t colon = text.find("]: ");
  ASSERT_NE(colon, std::string::npos) << text;
  EXPECT_NEAR(std::stod(text.substr(colon + 3)), ViewRoom::strip(kOnFloor), 10.0);
}

TEST(ViewWindow, ExposureKeysChangeTrueColours) {
  ATRIUM_NEEDS_DISPLAY();
  User user("radiosity");
  const double ev = user.window.stage().picture().ev();
  user.key("plus");
  EXPECT_DOUBLE_EQ(user.window.stage().picture().ev(), ev - 0.5);
  user.key("a");
  EXPECT_NEAR(user.window.stage().picture().ev(), ev, 1e-9);
}

TEST(ViewCamera, OrbitAndTurnKeepTheHorizon) {
  vtkNew<vtkCamera> camera;
  set_camera(*camera, choose_view("0,0,5:0,0,0", {{"x"}}));
  orbit(*camera, 90.0, 0.0);
  EXPECT_LT((Vec3d(camera->GetPosition()) - Vec3d(5, 0, 0)).norm(), 1e-9);
  orbit(*camera, 0.0, 30.0);
  EXPECT_NEAR(camera->GetPosition()[1], 2.5, 1e-9);
  turn(*camera, 90.0, 30.0);  // level again, to the right of -x: to -z
  const Vec3d ahead(camera->GetDirectionOfProjection());
  EXPECT_LT((ahead - Vec3d(0, 0, -1)).norm(), 1e-9);
}

/// A source that gives states one by one.
class Script : public MeshSource {
 public:
  std::vector<Mesh> states;
  std::string error;
  std::optional<Mesh> take() override {
    if (!error.empty()) throw Error(error);
    if (states.empty()) return std::nullopt;
    Mesh m = std::move(states.front());
    states.erase(states.begin());
    return m;
  }
  [[nodiscard]] Status status() const override {
    return {std::to_string(states.size()) + " to come", states.empty()};
  }
};

Document bare_document() {
  Document d = document();
  d.mesh.polygons.cell_arrays.clear();
  d.mesh.polygons.point_arrays.clear();
  return d;
}

TEST(ViewWindow, NewerStatesAreShownAsTheyCome) {
  ATRIUM_NEEDS_DISPLAY();
  auto script = std::make_unique<Script>();
  Mesh dim = document().mesh;
  Weights half(dim);
  half.set("lamp", 0.5);
  half.apply(dim);
  script->states = {dim, document().mesh};
  Window window(bare_document(), command("illuminance"), std::move(script));
  const auto brightest = [&] { return window.stage().picture().statistics().maximum; };
  window.poll();
  EXPECT_EQ(window.stage().picture().title(), "illuminance [lx]");
  EXPECT_NE(window.stage().overlay().status().find("1 to come"), std::string::npos);
  const double first = brightest();
  window.poll();
  EXPECT_GT(brightest(), 1.5 * first);
  window.poll();
}

// Weights wait for the first state that has light groups.
TEST(ViewWindow, WeightsWaitForLightGroups) {
  ATRIUM_NEEDS_DISPLAY();
  auto script = std::make_unique<Script>();
  Mesh without = document().mesh;
  for (auto* arrays : {&without.polygons.cell_arrays, &without.polygons.point_arrays})
    std::erase_if(*arrays, [](const Array& a) { return a.name.find('.') != std::string::npos; });
  script->states = {without, document().mesh};
  ViewCommand c = command("illuminance");
  c.look.weights = {{"lamp", 0.0}};
  Window window(bare_document(), c, std::move(script));
  window.poll();
  EXPECT_GT(window.stage().picture().statistics().maximum, 400.0);
  window.poll();
  EXPECT_LE(window.stage().picture().statistics().maximum, 200.0);  // the strip alone
  EXPECT_EQ(window.sliders().size(), 2u);
}

/// Leaves with 7 for an error, 0 if the window was closed.
[[noreturn]] void run_until_closed(const std::string& field, std::stop_token stop) {
  auto script = std::make_unique<Script>();
  script->states = {document().mesh};
  Window window(bare_document(), command(field), std::move(script));
  try {
    window.run(std::move(stop));
  } catch (const Error&) {
    _exit(7);
  }
  _exit(0);
}

// In processes of their own: VTK's event loop asks for events of all windows that there ever were.
TEST(ViewLoop, WhatAnOptionNamesMustBeInTheFirstState) {
  ATRIUM_NEEDS_DISPLAY();
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(run_until_closed("nonsense", {}), testing::ExitedWithCode(7), "");
}

TEST(ViewLoop, AnInterruptClosesTheWindow) {
  ATRIUM_NEEDS_DISPLAY();
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EXIT(run_until_closed("illuminance", stop.get_token()), testing::ExitedWithCode(0), "");
}

#ifdef ATRIUM_WITH_RADIOSITY

LoadedScene lit_floor(const test::TempFolder& folder) {
  folder.write("lit.yaml", test::kLitFloor);
  return load_scene({(folder / "lit.yaml").string()}, {});
}

constexpr const char* kThings = R"(atrium: 1
materials:
  white: {body: 0.5}
  lamp: {body: 0, emission: {radiance: 100}}
  silver: {ior: Ag}
  glass: {ior: 1.5, medium: pane}
objects:
  - {name: floor, material: white, polygon: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]}
  - {name: lamp, light_group: lamp, material: lamp,
     polygon: [[-0.2, 2, -0.2], [0.2, 2, -0.2], [0.2, 2, 0.2], [-0.2, 2, 0.2]]}
  - {name: mirror, material: silver, polygon: [[0.2, 0.5, -1], [1, 0.5, -1], [1, 0.5, 1], [0.2, 0.5, 1]]}
  - {name: pane, material: glass, polygon: [[-1, 0.5, -1], [-0.2, 0.5, -1], [-0.2, 0.5, 1], [-1, 0.5, 1]]}
environment: {radiance: 3, color: [0.2, 0.5, 1], light_group: sky}
)";

struct Picked {
  std::uint8_t r, g, b;
};
/// The middle of the window, or near it.
Picked pixel(Window& window, int dx = 0, int dy = 0) {
  vtkNew<vtkUnsignedCharArray> rgb;
  const int x = kWidth / 2 + dx, y = kHeight / 2 + dy;
  window.stage().window().GetPixelData(x, y, x, y, 0, rgb);
  return {rgb->GetValue(0), rgb->GetValue(1), rgb->GetValue(2)};
}

/// What has no elements is there: it can be seen, hides what is behind it, dims with its group and
/// has no values.
TEST(ViewWindow, ThingsWithoutElementsAreDrawnPlainly) {
  ATRIUM_NEEDS_DISPLAY();
  const test::TempFolder folder;
  folder.write("things.yaml", kThings);
  ViewCommand c = command("radiosity");
  c.files = {(folder / "things.yaml").string()};
  c.look.camera = "0,6,0.01:0,0,0:30";
  c.look.ev = 3.0;
  Document d = load_document(c, {}, [](const std::string&) {});
  ASSERT_EQ(d.things.size(), 3U);
  EXPECT_EQ(d.things.object, (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_TRUE(d.things.has_sky());
  EXPECT_TRUE(d.things.is_glass(2));
  Window window(std::move(d), c);
  const auto look = [&](const std::string& camera) {
    window.stage().look_from(choose_view(camera, window.stage().document().views));
    window.stage().render();
  };
  const auto thing = [&](const std::string& camera) {
    look(camera);
    const ViewRay ray = view_ray(*window.stage().renderer().GetActiveCamera(),
                                 static_cast<double>(kWidth) / kHeight, 0.0, 0.0);
    const bool values = window.stage().picture().pick(ray.origin, ray.direction).has_value();
    return window.stage().picture().thing_at(ray.origin, ray.direction).value_or("") +
           (values ? " and values" : "");
  };
  EXPECT_EQ(thing("0,6,0.01:0,0,0:30"), "lamp");
  EXPECT_EQ(thing("0.6,6,0.01:0.6,0,0:30"), "mirror");
  EXPECT_EQ(thing("-0.6,6,0.01:-0.6,0,0:30"), " and values");  // through glass
  look("0.6,6,0.01:0.6,0,0:30");
  const Picked mirror = pixel(window);
  EXPECT_NEAR(mirror.r, mirror.b, 30);
  EXPECT_GT(mirror.r, 60);
  look("0,1,0:0,2,0.01:50");  // up to the lamp, and past it to the sky
  EXPECT_GT(pixel(window).g, 240);
  const Picked sky = pixel(window, -kWidth / 2 + 10);
  EXPECT_GT(sky.b, sky.r + 40);
  window.stage().set_weights({{"lamp", 0.0}});
  window.stage().render();
  EXPECT_LT(pixel(window).g, 5);
  // False colours mean values: a lamp is white, the sky is gone.
  for (int i = 0; window.stage().picture().title() != "illuminance [lx]" && i < 20; ++i)
    window.act(Action::NextField);
  const Picked background = pixel(window, -kWidth / 2 + 10);
  EXPECT_EQ(background.r, background.b);
  window.stage().set_weights({{"lamp", 1.0}});
  window.stage().render();
  EXPECT_GT(pixel(window).b, 220);
  window.stage().state.hidden = {{Selection::Kind::Object, 1}};
  EXPECT_EQ(thing("0,6,0.01:0,0,0:30"), " and values");
}

// The window shows the scene before any light, then every state of the solve until it is done.
TEST(ViewWindow, ShowsASceneWhileItIsSolved) {
  ATRIUM_NEEDS_DISPLAY();
  const test::TempFolder folder;
  LoadedScene loaded = lit_floor(folder);
  Document d{bare_mesh(loaded), {}, "floor", {}};
  add_standard_views(d.mesh, 1.0, d.views);
  SolveChoice choice;
  choice.error = 0.05;
  Window window(std::move(d), command("illuminance"),
                std::make_unique<LiveSolve>(std::move(loaded), choice));
  std::string status;
  while (status.find("solved in") == std::string::npos) {
    window.poll();
    status = window.stage().overlay().status();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_NE(status.find("error"), std::string::npos) << status;
  EXPECT_EQ(window.stage().picture().title(), "illuminance [lx]");
  EXPECT_GT(window.stage().picture().statistics().maximum, 50.0);
}

// Whoever closes the window does not wait for the end of the solve: asked for an error that takes
// hours, it ends as soon as it is asked to.
TEST(ViewLive, DestructionStopsTheSolve) {
  const test::TempFolder folder;
  SolveChoice choice;
  choice.error = 1e-6;
  choice.quality = app::Quality::Normal;
  auto solve = std::make_unique<LiveSolve>(lit_floor(folder), choice);
  while (!solve->take()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_FALSE(solve->status().finished);
  solve.reset();
}

TEST(ViewLive, StatusSaysWhatIsKnown) {
  EXPECT_EQ(live_text(false, "rows", 0.43, 12.04, 0.0), "solving: rows, 43 %, 12.0 s");
  EXPECT_EQ(live_text(true, "rows", 1.0, 3.0, 0.051), "solved in 3.0 s, error 5.1 %");
}

#endif

}  // namespace
}  // namespace atrium::view
