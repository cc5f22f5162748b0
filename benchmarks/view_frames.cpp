// Frames per second of the viewer on a building of about a million elements, by whatever draws
// OpenGL: xvfb-run -a build/release/bin/view_frames measures software.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "display.h"
#include "frames.h"
#include "scene/mesh_io.h"
#include "stage.h"
#include "support/grid_wall.h"

namespace {

using atrium::Vec3d;
using atrium::scene::PolygonMesh;
using namespace atrium::view;

/// Rooms of 4 x 3 x 4 m side by side: floors, ceilings and four walls each, in square elements.
class Building {
 public:
  /// \param rooms  along each side. \param cells  of an element's edge in 4 m.
  static PolygonMesh make(int rooms, int cells) {
    Building b;
    for (int i = 0; i < rooms; ++i)
      for (int j = 0; j < rooms; ++j) b.add_room({4.2 * i, 0.0, 4.2 * j}, cells);
    b.mesh_.field_data["unit"] = {"lx"};
    b.mesh_.cell_arrays = {b.element_, b.object_};
    b.mesh_.point_arrays = {b.irradiance_, b.radiosity_};
    return std::move(b.mesh_);
  }

 private:
  void add_room(const Vec3d& o, int n) {
    const Vec3d x(4, 0, 0), y(0, 3, 0), z(0, 0, 4);
    const int m = n * 3 / 4;
    add_wall(o + z, x, -z, n, n);
    add_wall(o + y, x, z, n, n);
    add_wall(o, x, y, n, m);
    add_wall(o + x + z, -x, y, n, m);
    add_wall(o + z, -z, y, n, m);
    add_wall(o + x, z, y, n, m);
  }

  void add_wall(const Vec3d& corner, const Vec3d& u, const Vec3d& v, int nu, int nv) {
    const std::size_t first = mesh_.points.size();
    atrium::test::add_grid_wall(mesh_, corner, u, v, nu, nv);
    for (int k = 0; k < nu * nv; ++k) {
      element_.values.push_back(static_cast<float>(element_.values.size()));
      object_.values.push_back(static_cast<float>(objects_));
    }
    for (std::size_t p = first; p < mesh_.points.size(); ++p) light(mesh_.points[p]);
    ++objects_;
  }

  void light(const Vec3d& p) {
    const double lux = 300.0 + 200.0 * std::sin(2.0 * p.x()) * std::cos(1.7 * p.z()) * p.y();
    for (const double paint : {0.7, 0.6, 0.5}) {
      irradiance_.values.push_back(static_cast<float>(lux));
      radiosity_.values.push_back(static_cast<float>(paint * lux));
    }
  }

  PolygonMesh mesh_;
  PolygonMesh::Array element_{"element_id", 1, {}}, object_{"object_id", 1, {}},
      irradiance_{"irradiance", 3, {}}, radiosity_{"radiosity", 3, {}};
  int objects_ = 0;
};

void measure(const PolygonMesh& mesh, const char* what, const LookOptions& look, int frames) {
  ViewCommand command;
  command.size = {1024, 768};
  command.look = look;
  Document document;
  document.mesh = make_mesh(mesh, "building");
  add_standard_views(document.mesh, 4.0 / 3.0, document.views);
  Stage stage(std::move(document), command, true);
  std::printf("%-28s %s", what, describe(measure_frames(stage, frames)).c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 30;
  try {
    const DisplayConnection display;
    const PolygonMesh mesh = Building::make(10, 45);
    LookOptions look;
    look.no_ceilings = true;
    look.field = "illuminance";
    measure(mesh, "illuminance, smooth", look, frames);
    look.flat = true;
    measure(mesh, "illuminance, flat", look, frames);
    look.flat = false;
    look.contours.count = 8;
    measure(mesh, "with contours", look, frames);
    look.contours = {};
    look.field = "radiosity";
    measure(mesh, "true colour", look, frames);
    look.camera = "21,1.6,22:23,1.4,20:60";
    measure(mesh, "true colour, inside a room", look, frames);
    look.camera.clear();
    look.field = "object";
    measure(mesh, "objects", look, frames);
    look.edges = true;
    measure(mesh, "objects, edges", look, frames);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "view_frames: error: %s\n", e.what());
    return 1;
  }
  std::_Exit(0);
}
