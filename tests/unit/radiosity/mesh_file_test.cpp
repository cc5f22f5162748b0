// Mesh files as any program with VTK reads them: what is in them agrees with the solution.
#include <vtkCellData.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <map>

#include <gtest/gtest.h>

#include "material/error.h"
#include "physics/radiosity_support.h"
#include "radiosity/export_mesh.h"
#include "support/temp_folder.h"

namespace {

using namespace atrium;
using test::Solved;

template <class Reader>
vtkSmartPointer<vtkDataSet> read_with(const std::string& file) {
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0U);
  return reader->GetOutput();
}

vtkSmartPointer<vtkDataSet> read(const std::filesystem::path& file) {
  return file.extension() == ".vtp" ? read_with<vtkXMLPolyDataReader>(file.string())
                                    : read_with<vtkXMLUnstructuredGridReader>(file.string());
}

/// A room with a baffle that both sides are lit of, a panel and a point light: a graded mesh.
Solved lit_room() {
  test::SceneMaker maker;
  const auto wall = maker.material(test::diffuse(0.6));
  maker.room({0, 0, 0}, {4, 3, 3}, wall);
  maker.quad(wall, {2.0f, 0.0f, 0.5f}, {2.0f, 2.0f, 0.5f}, {2.0f, 2.0f, 2.5f}, {2.0f, 0.0f, 2.5f});
  maker.quad(maker.material(test::emitter(20.0, 0.5)), {0.5f, 2.9f, 1.0f}, {1.5f, 2.9f, 1.0f},
             {1.5f, 2.9f, 2.0f}, {0.5f, 2.9f, 2.0f});
  maker.point_light({3.0, 1.0, 1.5}, 5.0);
  scene::Scene s = maker.take();
  for (std::size_t i = 0; i < s.objects.size(); ++i)
    s.objects[i].name = "part " + std::to_string(i);
  s.objects.back().name = "a \"panel\" <b> & c";
  s.lights[0].name = "point";
  s.materials[0].name = "wall";
  scene::Camera camera;
  camera.name = "door";
  camera.to_scene = scene::look_at({1, 1, 1}, {3, 1, 2}, Vec3d::UnitY());
  s.cameras = {camera};
  radiosity::SolveOptions o;
  o.max_elements = 900;
  o.mesh_error = 0.01;
  o.direct_samples = 64;
  o.light_groups = scene::Grouping::ByName;
  return {std::move(s), o};
}

/// The scene and its files, solved once.
struct Files {
  Solved solved = lit_room();
  scene::PolygonMesh mesh =
      radiosity::to_polygon_mesh(solved.scene, solved.result.elements, solved.result.field,
                                 material::SpectralBasis::grey(), solved.result.groups);
};
const Files& files() {
  static const Files f;
  return f;
}

class MeshFile : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!scene::mesh_io_available()) GTEST_SKIP() << "built without VTK";
    scene::write_polygon_mesh(files().mesh, folder_ / GetParam());
    data_ = read(folder_ / GetParam());
  }
  [[nodiscard]] vtkDataArray& cells(const std::string& name) const {
    vtkDataArray* a = data_->GetCellData()->GetArray(name.c_str());
    if (a == nullptr) throw std::runtime_error("no cell array " + name);
    return *a;
  }
  [[nodiscard]] vtkDataArray& points(const std::string& name) const {
    vtkDataArray* a = data_->GetPointData()->GetArray(name.c_str());
    if (a == nullptr) throw std::runtime_error("no point array " + name);
    return *a;
  }
  [[nodiscard]] std::vector<std::string> strings(const std::string& name) const {
    std::vector<std::string> list;
    auto* a = vtkStringArray::SafeDownCast(data_->GetFieldData()->GetAbstractArray(name.c_str()));
    if (a == nullptr) return list;
    for (vtkIdType i = 0; i < a->GetNumberOfValues(); ++i) list.push_back(a->GetValue(i));
    return list;
  }
  [[nodiscard]] std::vector<Vec3d> corners(vtkIdType cell) const {
    vtkNew<vtkIdList> ids;
    data_->GetCellPoints(cell, ids);
    std::vector<Vec3d> list(static_cast<std::size_t>(ids->GetNumberOfIds()));
    for (std::size_t i = 0; i < list.size(); ++i)
      data_->GetPoint(ids->GetId(static_cast<vtkIdType>(i)), list[i].data());
    return list;
  }
  static Vec3d area_vector(const std::vector<Vec3d>& p) {
    Vec3d twice = Vec3d::Zero();
    for (std::size_t i = 1; i + 1 < p.size(); ++i) twice += (p[i] - p[0]).cross(p[i + 1] - p[0]);
    return 0.5 * twice;
  }

  test::TempFolder folder_;
  vtkSmartPointer<vtkDataSet> data_;
};

TEST_P(MeshFile, ArraysHaveTheirTypesSizesAndRanges) {
  const vtkIdType cell_count = data_->GetNumberOfCells();
  for (const char* name :
       {"irradiance_direct", "irradiance_caustic", "irradiance_indirect", "irradiance", "radiosity",
        "irradiance_direct_back", "irradiance_caustic_back", "irradiance_indirect_back",
        "irradiance_back", "radiosity_back"}) {
    SCOPED_TRACE(name);
    for (vtkDataArray* a : {&cells(name), &points(name)}) {
      EXPECT_EQ(a->GetDataType(), VTK_FLOAT);
      EXPECT_EQ(a->GetNumberOfComponents(), 3);
      EXPECT_GE(a->GetRange(-1)[0], 0.0);
      EXPECT_TRUE(std::isfinite(a->GetRange(-1)[1]));
    }
    EXPECT_EQ(cells(name).GetNumberOfTuples(), cell_count);
    EXPECT_EQ(points(name).GetNumberOfTuples(), data_->GetNumberOfPoints());
  }
  const std::map<std::string, int> scalars{{"stderr", VTK_FLOAT},
                                           {"illuminance_lux", VTK_FLOAT},
                                           {"element_id", VTK_INT},
                                           {"level", VTK_UNSIGNED_CHAR},
                                           {"material_id", VTK_INT},
                                           {"object_id", VTK_INT},
                                           {"front_valid", VTK_UNSIGNED_CHAR}};
  for (const auto& [name, type] : scalars) {
    SCOPED_TRACE(name);
    EXPECT_EQ(cells(name).GetDataType(), type);
    EXPECT_EQ(cells(name).GetNumberOfComponents(), 1);
    EXPECT_EQ(cells(name).GetNumberOfTuples(), cell_count);
  }
  EXPECT_LE(cells("reflectance").GetRange(0)[1], 0.6 + 1e-6);
  EXPECT_GT(cells("level").GetRange(0)[1], 0.0) << "a graded mesh is wanted";
  EXPECT_EQ(cells("object_id").GetRange(0)[1] + 1.0,
            static_cast<double>(files().solved.scene.objects.size()));
}

TEST_P(MeshFile, NamesUnitsAndCamerasAreThere) {
  const std::vector<std::string> objects = strings("object_names");
  const scene::Scene& scene = files().solved.scene;
  ASSERT_EQ(objects.size(), scene.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) EXPECT_EQ(objects[i], scene.objects[i].name);
  EXPECT_EQ(strings("material_names").at(0), "wall");
  EXPECT_EQ(strings("unit"), std::vector<std::string>{"W/m^2"});
  EXPECT_EQ(strings("camera_names"), std::vector<std::string>{"door"});
  vtkDataArray* position = data_->GetFieldData()->GetArray("camera_position");
  ASSERT_NE(position, nullptr);
  EXPECT_EQ(position->GetNumberOfComponents(), 3);
  EXPECT_NEAR(position->GetComponent(0, 2), 1.0, 1e-12);

  const std::vector<std::string> names = strings("array_names");
  const std::vector<std::string> units = strings("array_units");
  ASSERT_EQ(names.size(), units.size());
  std::map<std::string, std::string> unit_of;
  for (std::size_t i = 0; i < names.size(); ++i) unit_of[names[i]] = units[i];
  EXPECT_EQ(unit_of.at("irradiance"), "W/m^2");
  EXPECT_EQ(unit_of.at("illuminance_lux"), "lx");
  EXPECT_EQ(unit_of.at("reflectance"), "1");
  for (int i = 0; i < data_->GetPointData()->GetNumberOfArrays(); ++i)
    EXPECT_EQ(unit_of.count(data_->GetPointData()->GetArrayName(i)), 1U);
}

// Triangles of the scene against polygons; float coordinates leave 1e-6 of an edge.
TEST_P(MeshFile, AreasAreThoseOfTheObjects) {
  const scene::Scene& scene = files().solved.scene;
  std::vector<double> area(scene.objects.size(), 0.0);
  for (vtkIdType c = 0; c < data_->GetNumberOfCells(); ++c)
    area[static_cast<std::size_t>(cells("object_id").GetComponent(c, 0))] +=
        area_vector(corners(c)).norm();
  for (std::size_t o = 0; o < area.size(); ++o) {
    double expected = 0.0;
    const scene::ObjectId id(o);
    for (std::uint32_t t = 0; t < scene.mesh_of(id).triangles.size(); ++t) {
      const auto k = scene.corners(id, t);
      expected += 0.5 * static_cast<double>((k[1] - k[0]).cross(k[2] - k[0]).norm());
    }
    EXPECT_NEAR(area[o], expected, 2e-5 * expected) << o;
  }
}

// What the surfaces absorb of the irradiance, grey: the solver counts the same at its elements.
TEST_P(MeshFile, FluxIsTheSolvers) {
  double absorbed = 0.0;
  for (vtkIdType c = 0; c < data_->GetNumberOfCells(); ++c) {
    const double area = area_vector(corners(c)).norm();
    for (const char* side : {"", "_back"})
      absorbed += area * cells(std::string("irradiance") + side).GetComponent(c, 0) *
                  (1.0 - cells(std::string("reflectance") + side).GetComponent(c, 0));
  }
  const double expected = files().solved.result.flux.absorbed;
  EXPECT_NEAR(absorbed, expected, 1e-4 * expected);
}

// Every polygon is planar and wound like its object's triangles; in the closed room and within
// walls every edge is passed once each way. Places are compared as the file has them.
TEST_P(MeshFile, PolygonsArePlanarConsistentAndWithoutCracks) {
  using Place = std::array<double, 3>;
  std::map<std::tuple<int, Place, Place>, int> edges;
  double open = 0.0;
  for (vtkIdType c = 0; c < data_->GetNumberOfCells(); ++c) {
    const std::vector<Vec3d> p = corners(c);
    const Vec3d area = area_vector(p);
    ASSERT_GT(area.norm(), 0.0);
    const Vec3d n = area.normalized();
    for (std::size_t i = 0; i < p.size(); ++i) {
      EXPECT_NEAR((p[i] - p[0]).dot(n), 0.0, 2e-6);
      const Vec3d turn = (p[(i + 1) % p.size()] - p[i]).cross(p[(i + 2) % p.size()] - p[i]);
      EXPECT_GT(turn.dot(n), -1e-6);
    }
    const int object = static_cast<int>(cells("object_id").GetComponent(c, 0));
    const auto id = scene::ObjectId(static_cast<std::uint32_t>(object));
    const auto t = files().solved.scene.corners(id, 0);
    if (files().solved.scene.mesh_of(id).triangles.size() == 2) {
      EXPECT_GT((t[1] - t[0]).cross(t[2] - t[0]).cast<double>().normalized().dot(n), 0.999);
    }
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec3d& q = p[(i + 1) % p.size()];
      const Place a{p[i].x(), p[i].y(), p[i].z()}, b{q.x(), q.y(), q.z()};
      ++edges[{object, a, b}];
      --edges[{object, b, a}];
    }
  }
  for (const auto& [edge, balance] : edges)
    if (balance > 0)
      open += balance * (Vec3d(std::get<1>(edge).data()) - Vec3d(std::get<2>(edge).data())).norm();
  // What is open are the outlines: 14, 12 and 14 m twice for three pairs of walls, 8 and 4 m.
  double outline = 0.0;
  const scene::Scene& scene = files().solved.scene;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const auto a = scene.corners(scene::ObjectId(o), 0), b = scene.corners(scene::ObjectId(o), 1);
    outline += static_cast<double>((a[1] - a[0]).norm() + (a[2] - a[1]).norm() +
                                   (b[2] - b[1]).norm() + (b[0] - b[2]).norm());
  }
  EXPECT_NEAR(open, outline, 1e-4);
}

// Radiosity has the emission in the group of its object.
TEST_P(MeshFile, GroupsSumToTheTotal) {
  const std::vector<std::string> groups = strings("light_group_names");
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[1], "a \"panel\" <b> & c");
  const std::string panel = "a _panel_ _b_ _ c";  // VTK cannot write it in an array's name
  for (const char* name : {"irradiance", "radiosity", "irradiance_back", "radiosity_back"})
    for (const bool cell : {true, false}) {
      SCOPED_TRACE(name);
      const auto array = [&](const std::string& n) -> vtkDataArray& {
        return cell ? cells(n) : points(n);
      };
      vtkDataArray& total = array(name);
      vtkDataArray& a = array(std::string(name) + "." + groups[0]);
      vtkDataArray& b = array(std::string(name) + "." + panel);
      double largest = 0.0;
      for (vtkIdType i = 0; i < total.GetNumberOfTuples(); ++i) {
        const double t = total.GetComponent(i, 0);
        largest = std::max(largest, b.GetComponent(i, 0));
        ASSERT_NEAR(a.GetComponent(i, 0) + b.GetComponent(i, 0), t, 1e-5 * t + 1e-7);
      }
      EXPECT_GT(largest, 0.0);
    }
  // The panel emits pi * 20 on its front, all of it in its own group.
  const vtkIdType last = data_->GetNumberOfCells() - 1;
  EXPECT_NEAR(cells("emission").GetComponent(last, 0), 20.0 * M_PI, 1e-3);
  EXPECT_GT(cells("radiosity." + panel).GetComponent(last, 0), 20.0 * M_PI);
  EXPECT_LT(cells("radiosity." + groups[0]).GetComponent(last, 0), M_PI);
}

TEST_P(MeshFile, ASummaryTellsWhatIsThere) {
  const scene::MeshFileSummary s = scene::summarise_mesh_file(folder_ / GetParam());
  EXPECT_EQ(s.polygons, static_cast<std::uint64_t>(data_->GetNumberOfCells()));
  EXPECT_EQ(s.points, static_cast<std::uint64_t>(data_->GetNumberOfPoints()));
  EXPECT_NEAR(s.bounds[1], 4.0, 1e-6);
  const auto lux = std::find_if(s.point_arrays.begin(), s.point_arrays.end(),
                                [](const auto& a) { return a.name == "illuminance_lux"; });
  ASSERT_NE(lux, s.point_arrays.end());
  EXPECT_EQ(lux->unit, "lx");
  EXPECT_EQ(lux->type, "float");
  EXPECT_NEAR(lux->high, points("illuminance_lux").GetRange(0)[1], 1e-3 * lux->high);
  EXPECT_EQ(s.field_data.at("camera_names").at(0), "door");
}

// Whatever is cut off: one line, no crash. (A file without its last line break is whole.)
TEST_P(MeshFile, DamagedFilesAreRefused) {
  const std::filesystem::path whole = folder_ / GetParam();
  std::ifstream in(whole, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(in), {}};
  const std::filesystem::path bad = folder_ / (std::string("bad-") + GetParam());
  const auto expect_refused = [&](const std::string& bytes) {
    std::ofstream(bad, std::ios::binary) << bytes;
    try {
      (void)scene::summarise_mesh_file(bad);
      ADD_FAILURE() << "accepted " << bytes.size() << " of " << content.size() << " bytes";
    } catch (const Error& e) {
      const std::string what = e.what();
      EXPECT_EQ(what.find(bad.string()), 0U);
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    }
  };
  for (const double share : {0.0, 0.001, 0.01, 0.1, 0.5, 0.9, 0.9999})
    expect_refused(
        content.substr(0, static_cast<std::size_t>(share * static_cast<double>(content.size()))));
  expect_refused("solid x\nendsolid x\n");
  expect_refused(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\"></VTKFile>\n");
  std::string zeros = content;  // the head is whole, the data are not
  std::fill(zeros.begin() + static_cast<std::ptrdiff_t>(zeros.size() / 2), zeros.end() - 64, '\0');
  expect_refused(zeros);
  EXPECT_THROW((void)scene::summarise_mesh_file(folder_ / "none.vtp"), Error);
  EXPECT_THROW((void)scene::summarise_mesh_file(folder_ / "none.obj"), Error);
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshFile, ::testing::Values("a.vtp", "a.vtu"),
                         [](const auto& test) { return std::string(test.param).substr(2); });

}  // namespace
