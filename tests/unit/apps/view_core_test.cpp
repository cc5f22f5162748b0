// What the viewer computes before anything is drawn.
#include <vtkDataArray.h>
#include <vtkLookupTable.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "ceilings.h"
#include "coarse.h"
#include "colours.h"
#include "contour_lines.h"
#include "element_edges.h"
#include "fields.h"
#include "legend.h"
#include "look_text.h"
#include "material/error.h"
#include "mesh.h"
#include "picker.h"
#include "probe.h"
#include "range.h"
#include "selection.h"
#include "statistics.h"
#include "support/temp_folder.h"
#include "support/view_room.h"
#include "trace/tone_map.h"
#include "triangles.h"
#include "values.h"
#include "view_point.h"
#include "weighted_values.h"
#include "weights.h"

namespace atrium::view {
namespace {

using test::TempFolder;
using test::ViewRoom;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Mesh room() { return make_mesh(ViewRoom::mesh(), "room"); }

/// One polygon through these points.
scene::PolygonMesh one_polygon(const std::vector<Vec3d>& points) {
  scene::PolygonMesh m;
  m.points = points;
  m.polygon_sizes = {static_cast<std::uint32_t>(points.size())};
  for (std::uint32_t i = 0; i < points.size(); ++i) m.polygon_points.push_back(i);
  return m;
}

template <class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

double triangle_area(const Mesh& m, const std::array<std::uint32_t, 3>& t) {
  const auto& p = m.polygons.points;
  return 0.5 * (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm();
}

TEST(ViewMesh, RefusesWhatCannotBeDrawn) {
  EXPECT_NE(error_of([] { (void)make_mesh({}, "m.vtp"); }).find("m.vtp: holds no polygons"),
            std::string::npos);
  scene::PolygonMesh m = one_polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  m.polygon_points[1] = 7;
  EXPECT_NE(error_of([&] { (void)make_mesh(m, "m"); }).find("polygon 0"), std::string::npos);
  m = one_polygon({{0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0}});
  EXPECT_NE(error_of([&] { (void)make_mesh(m, "m"); }).find("point 2"), std::string::npos);
  m = one_polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  m.cell_arrays.push_back({"short", 3, {1.0f, 2.0f}});
  EXPECT_NE(error_of([&] { (void)make_mesh(m, "m"); }).find("'short'"), std::string::npos);
}

TEST(ViewMesh, FilesComeBackWithArraysAndNames) {
  const TempFolder folder;
  const scene::PolygonMesh original = ViewRoom::mesh();
  for (const char* name : {"room.vtp", "room.vtu"}) {
    SCOPED_TRACE(name);
    scene::write_polygon_mesh(original, folder / name);
    const Mesh read = read_mesh(folder / name);
    EXPECT_EQ(read.polygons.polygon_points, original.polygon_points);
    EXPECT_EQ(read.polygons.points, original.points);
    ASSERT_NE(find_array(read.polygons.cell_arrays, "irradiance"), nullptr);
    EXPECT_EQ(find_array(read.polygons.point_arrays, "radiosity.lamp")->values,
              find_array(original.point_arrays, "radiosity.lamp")->values);
    EXPECT_EQ(read.polygons.field_data.at("unit"), std::vector<std::string>{"lx"});
  }
}

// Cut anywhere, the file is refused or, in its last bytes, complete: never a crash.
TEST(ViewMesh, TruncatedFilesAreRefused) {
  const TempFolder folder;
  scene::write_polygon_mesh(ViewRoom::mesh(), folder / "room.vtp");
  std::ifstream in(folder / "room.vtp", std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  for (const double share : {0.0, 0.02, 0.1, 0.3, 0.6, 0.9, 0.99}) {
    SCOPED_TRACE(share);
    folder.write(
        "cut.vtp",
        whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    const std::string error = error_of([&] { (void)read_mesh(folder / "cut.vtp"); });
    EXPECT_NE(error.find("cut.vtp"), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
}

// VTK's reader writes the ones that are too many behind the end of their array.
TEST(ViewMesh, NoMoreTextsThanAnnounced) {
  const TempFolder folder;
  scene::PolygonMesh mesh = ViewRoom::mesh();
  mesh.field_data["object_names"] = std::vector<std::string>(300, "thing");
  scene::write_polygon_mesh(mesh, folder / "room.vtp");
  EXPECT_EQ(read_mesh(folder / "room.vtp").objects.size(), 300U);
  std::ifstream in(folder / "room.vtp", std::ios::binary);
  std::string whole{std::istreambuf_iterator<char>(in), {}};
  const std::string announced = "NumberOfTuples=\"300\"";
  const std::size_t at = whole.find(announced, whole.find("object_names"));
  ASSERT_NE(at, std::string::npos);
  whole.replace(at, announced.size(), "NumberOfTuples=\"200\"");
  folder.write("room.vtp", whole);
  EXPECT_NE(error_of([&] { (void)read_mesh(folder / "room.vtp"); }).find("texts"),
            std::string::npos);
  // Of points and cells they are not known at all.
  std::string text =
      "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"0\"><PointData>"
      "<Array type=\"String\" NumberOfTuples=\"1\" format=\"ascii\">0 0</Array>"
      "</PointData></Piece></PolyData></VTKFile>";
  folder.write("points.vtp", text);
  EXPECT_NE(error_of([&] { (void)read_mesh(folder / "points.vtp"); }).find("String"),
            std::string::npos);
}

const char* const kForeign =
    "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData>"
    "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points><DataArray type=\"Float32\" "
    "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points><Polys>"
    "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 CORNER</DataArray>"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3</DataArray></Polys>ARRAYS"
    "</Piece></PolyData></VTKFile>";

std::string foreign(const std::string& corner, const std::string& arrays) {
  std::string text = kForeign;
  text.replace(text.find("CORNER"), 6, corner);
  return text.replace(text.find("ARRAYS"), 6, arrays);
}

TEST(ViewMesh, ForeignFilesShowTheirOwnArraysOrNone) {
  const TempFolder folder;
  folder.write("bad.vtp", foreign("9", ""));
  EXPECT_NE(error_of([&] {
              (void)read_mesh(folder / "bad.vtp");
            }).find("corner 2 of the cells is point 9"),
            std::string::npos);
  folder.write("bare.vtp", foreign("2", ""));
  EXPECT_TRUE(fields_of(read_mesh(folder / "bare.vtp")).empty());
  folder.write("heat.vtp", foreign("2",
                                   "<CellData><DataArray type=\"Float64\" Name=\"heat\" "
                                   "format=\"ascii\">3.5</DataArray></CellData>"));
  const Mesh heat = read_mesh(folder / "heat.vtp");
  ASSERT_EQ(fields_of(heat).size(), 1u);
  EXPECT_EQ(fields_of(heat)[0].name, "heat");
  // At points it is the mean of the polygons that meet there.
  EXPECT_EQ(numbers_of(heat, fields_of(heat)[0], Side::Front, true).numbers,
            (std::vector<float>{3.5f, 3.5f, 3.5f}));
}

// Names of materials and objects are texts beside the arrays.
TEST(ViewMesh, NamesComeWithTheFile) {
  const TempFolder folder;
  std::string text = foreign("2", "");
  text.insert(text.find("<Piece"),
              "<FieldData><Array type=\"String\" Name=\"material_names\" NumberOfTuples=\"2\" "
              "format=\"ascii\">111 97 107 0 116 105 110 0</Array></FieldData>");
  folder.write("named.vtp", text);
  EXPECT_EQ(read_mesh(folder / "named.vtp").materials, (std::vector<std::string>{"oak", "tin"}));
}

// A corner in the middle of an edge keeps its value: it is a corner of a triangle with area.
TEST(ViewTriangles, CornersOnEdgesStayAndAreaIsKept) {
  const Mesh m = make_mesh(
      one_polygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {0, 2, 0}}), "m");
  const Triangles t = triangulate(m);
  double area = 0.0;
  std::array<bool, 6> used{};
  for (const auto& c : t.corners) {
    area += triangle_area(m, c);
    if (triangle_area(m, c) > 1e-9)
      for (const std::uint32_t i : c) used[i] = true;
  }
  EXPECT_NEAR(area, 4.0, 1e-12);
  for (const bool u : used) EXPECT_TRUE(u);
}

// An L: a fan from any corner but the inner ones covers what is outside.
TEST(ViewTriangles, ConcavePolygonsAreCutByEars) {
  const Mesh m = make_mesh(
      one_polygon({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}), "m");
  double area = 0.0;
  const Triangles t = triangulate(m);
  for (const auto& c : t.corners) area += triangle_area(m, c);
  EXPECT_EQ(t.size(), 4u);
  EXPECT_NEAR(area, 5.0, 1e-12);
}

// While it moves: fewer triangles of nearly the same area, in the same planes.
TEST(ViewTriangles, CoarseOnesKeepPlanesAndArea) {
  scene::PolygonMesh p;
  const int n = 100;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) p.points.emplace_back(0.04 * i, 1.0, 0.03 * j);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<std::uint32_t>(j * (n + 1) + i);
      for (const std::uint32_t k : {at, at + n + 1, at + n + 2, at + 1})
        p.polygon_points.push_back(k);
      p.polygon_sizes.push_back(4);
    }
  const Mesh m = make_mesh(std::move(p), "m");
  const Triangles all = triangulate(m);
  const Triangles coarse = coarsen(m, all, 1000);
  EXPECT_LT(coarse.size(), 1500u);
  EXPECT_GT(coarse.size(), 500u);
  double area = 0.0;
  for (const auto& c : coarse.corners) area += triangle_area(m, c);
  EXPECT_NEAR(area, 12.0, 1.0);  // without up to a cell of 0.15 m at two rims
  EXPECT_EQ(coarsen(m, all, all.size()).corners, all.corners);
}

TEST(ViewFields, KnownOnesInOrderAndByArrayName) {
  const Mesh m = room();
  const std::vector<Field> fields = fields_of(m);
  ASSERT_FALSE(fields.empty());
  EXPECT_EQ(fields[0].name, "radiosity");
  EXPECT_EQ(fields[0].title, "radiosity [lm/m^2]");
  EXPECT_EQ(find_field(fields, ""), 0u);
  EXPECT_EQ(fields[find_field(fields, "illuminance_lux")].title, "illuminance [lx]");
  EXPECT_EQ(find_field(fields, "stderr"), find_field(fields, "error"));
  for (const Field& f : fields) EXPECT_EQ(f.name.find('.'), std::string::npos) << f.name;
  const std::string error = error_of([&] { (void)find_field(fields, "iluminance"); });
  EXPECT_NE(error.find("did you mean illuminance"), std::string::npos) << error;
}

// Watts become lux by 179 lm/W, and an RGB array by its luminance.
TEST(ViewValues, IlluminanceIsLuminanceOfIrradianceInLux) {
  scene::PolygonMesh p = one_polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  p.cell_arrays.push_back({"irradiance", 3, {1.0f, 2.0f, 3.0f}});
  p.field_data["unit"] = {"W/m^2"};
  const Mesh m = make_mesh(std::move(p), "m");
  const std::vector<Field> fields = fields_of(m);
  const Values v = numbers_of(m, fields[find_field(fields, "illuminance")], Side::Front, false);
  EXPECT_NEAR(v.numbers[0], 179.0 * (0.2126 + 2.0 * 0.7152 + 3.0 * 0.0722), 1e-3);
  // There is no array of the back: it is unknown at every point or polygon.
  EXPECT_TRUE(std::isnan(numbers_of(m, fields[0], Side::Back, false).numbers.at(0)));
  EXPECT_EQ(numbers_of(m, fields[0], Side::Back, false).size(), 1u);
  EXPECT_EQ(numbers_of(m, fields[0], Side::Back, true).size(), 3u);
  EXPECT_EQ(numbers_of(m, fields[0], Side::Back, true).place, Place::Points);
}

TEST(ViewValues, SidesThatWereNotComputedAreUnknown) {
  scene::PolygonMesh p = ViewRoom::mesh();
  scene::PolygonMesh::Array valid{"front_valid", 1,
                                  std::vector<float>(p.polygon_sizes.size(), 1.0f)};
  for (std::size_t k = 0; k < 16; ++k) valid.values[k] = 0.0f;  // the first row of the floor
  p.cell_arrays.push_back(valid);
  const Mesh m = make_mesh(std::move(p), "m");
  const std::vector<Field> fields = fields_of(m);
  const Field& e = fields[find_field(fields, "irradiance")];
  const Values cells = numbers_of(m, e, Side::Front, false);
  EXPECT_TRUE(std::isnan(cells.numbers[3]));
  EXPECT_FALSE(std::isnan(cells.numbers[16]));
  const Values points = numbers_of(m, e, Side::Front, true);
  EXPECT_TRUE(std::isnan(points.numbers[3]));    // of unknown elements alone
  EXPECT_FALSE(std::isnan(points.numbers[20]));  // shared with the second row
}

TEST(ViewRange, IsRoundAndIgnoresTheBrightestPercent) {
  std::vector<Weighted> values;
  for (int i = 1; i <= 1000; ++i) values.push_back({i <= 995 ? 0.47 * i : 1e6, 1.0});
  EXPECT_EQ(automatic_range(values, false), (Range{0.0, 500.0, false}));
  const Range log = automatic_range(values, true);
  EXPECT_EQ(log, (Range{4.0, 500.0, true}));
  values.push_back({std::nan(""), 1e9});
  EXPECT_EQ(automatic_range(values, false), (Range{0.0, 500.0, false}));
  EXPECT_EQ(automatic_range({}, false), (Range{0.0, 1.0, false}));
  EXPECT_EQ(automatic_range({}, true), (Range{0.1, 1.0, true}));
  const std::vector<Weighted> dark{{0.0, 1.0}};
  EXPECT_EQ(automatic_range(dark, false), (Range{0.0, 1.0, false}));
  const std::vector<Weighted> same{{7.0, 1.0}};
  EXPECT_LT(automatic_range(same, true).low, automatic_range(same, true).high);
}

TEST(ViewRange, LevelsAreRoundAndInside) {
  EXPECT_EQ(round_levels({0.0, 500.0, false}, 4), (std::vector<double>{100, 200, 300, 400}));
  EXPECT_EQ(round_levels({10.0, 1000.0, true}, 5), (std::vector<double>{20, 50, 100, 200, 500}));
  EXPECT_TRUE(round_levels({0.0, 1.0, false}, 0).empty());
  for (const int n : {1, 3, 8, 20})
    for (const double v : round_levels({0.003, 0.7, false}, n)) EXPECT_TRUE(v > 0.003 && v < 0.7);
}

/// Colour that the table gives a value.
Colour mapped(vtkLookupTable& table, double value) {
  const unsigned char* c = table.MapValue(value);
  return {c[0], c[1], c[2]};
}

// The table that colours surfaces: ends, middle on linear and logarithmic ranges, beyond, unknown.
TEST(ViewColours, TableFollowsTheRange) {
  const auto linear = make_table(Look::Scale, {0.0, 1000.0, false});
  const auto log = make_table(Look::Scale, {1.0, 10000.0, true});
  EXPECT_EQ(mapped(*linear, 0.0), mapped(*log, 1.0));
  EXPECT_EQ(mapped(*linear, 1000.0), mapped(*log, 10000.0));
  EXPECT_EQ(mapped(*linear, 500.0), mapped(*log, 100.0));
  EXPECT_EQ(mapped(*linear, 250.0), mapped(*log, 10.0));
  EXPECT_EQ(mapped(*linear, 5000.0), mapped(*linear, 1000.0));
  EXPECT_EQ(mapped(*linear, -5.0), mapped(*linear, 0.0));
  EXPECT_EQ(mapped(*linear, std::nan("")), kGrey);
  const Colour low = mapped(*linear, 0.0), high = mapped(*linear, 1000.0);
  EXPECT_TRUE(low[2] > low[0] && high[0] > high[2]) << "blue to red";
  EXPECT_NE(mapped(*make_table(Look::Error, {0.0, 1000.0, false}), 500.0), mapped(*linear, 500.0));
}

TEST(ViewColours, LegendNamesTheEndsAndRoundValuesOrContours) {
  const auto texts = [](const Range& r, const std::vector<double>& contours) {
    std::vector<std::string> t;
    for (const auto& [value, text] : scale_marks(r, contours)) t.push_back(text);
    return t;
  };
  EXPECT_EQ(texts({0.0, 500.0, false}, {}),
            (std::vector<std::string>{"0", "100", "200", "300", "400", "500"}));
  EXPECT_EQ(texts({0.0, 500.0, false}, {150.0, 300.0, 900.0}),
            (std::vector<std::string>{"0", "150", "300", "500"}));
  EXPECT_EQ(
      texts({1.0, 10000.0, true}, {}),
      (std::vector<std::string>{"1", "3", "10", "30", "100", "300", "1000", "3000", "10000"}));
}

// The same curve and exposure as PNG pictures: radiance is radiosity / pi.
TEST(ViewColours, TrueColoursAreThoseOfPngPictures) {
  Values v{Place::Points, 3, {300.0f, 200.0f, 100.0f, kNan, kNan, kNan}};
  const std::vector<Colour> colours = tone_mapped(v, 6.0);
  scene::Image image;
  image.width = image.height = 1;
  image.channels = {"R", "G", "B"};
  for (const float x : {300.0f, 200.0f, 100.0f})
    image.pixels.push_back(x / static_cast<float>(M_PI));
  trace::ToneMapOptions how;
  how.ev = 6.0;
  const scene::Image expected = trace::tone_map(image, how);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(colours[0][c], 255.0f * expected.pixels[c], 0.51f);
  EXPECT_EQ(colours[1], kGrey);
  EXPECT_NEAR(automatic_ev({{300.0f, 200.0f, 100.0f}}), trace::automatic_ev(image), 1e-6);
}

TEST(ViewColours, ClassesDiffer) {
  for (std::uint32_t i = 0; i < 64; ++i)
    for (std::uint32_t j = 0; j < i; ++j) EXPECT_NE(class_colour(i), class_colour(j));
}

// Every array that depends on the groups becomes their weighted sum; 1 gives back what was there.
TEST(ViewWeights, ReweightWithoutRays) {
  const Mesh original = room();
  Mesh m = original;
  Weights w(m);
  EXPECT_EQ(w.groups(), (std::vector<std::string>{"lamp", "strip"}));
  w.apply(m);
  const auto& before = find_array(original.polygons.point_arrays, "irradiance")->values;
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_FLOAT_EQ(find_array(m.polygons.point_arrays, "irradiance")->values[i], before[i]);
  w.set("lamp", 0.25);
  w.set("strip", 2.0);
  w.apply(m);
  const std::vector<Field> fields = fields_of(m);
  const Values lux = numbers_of(m, fields[find_field(fields, "illuminance")], Side::Front, true);
  for (const std::size_t p : {0u, 40u, 111u}) {
    const Vec3d& at = m.polygons.points[p];
    EXPECT_NEAR(lux.numbers[p], 0.25 * ViewRoom::lamp(at) + 2.0 * ViewRoom::strip(at), 1e-2);
  }
  EXPECT_NE(error_of([&] { w.set("lmap", 1.0); }).find("did you mean lamp"), std::string::npos);
}

TEST(ViewStatistics, MeansAreByArea) {
  const Statistics s =
      make_statistics({{100.0, 3.0}, {500.0, 1.0}, {std::nan(""), 2.0}, {200.0, 4.0}});
  EXPECT_DOUBLE_EQ(s.mean, (300.0 + 500.0 + 800.0) / 8.0);
  EXPECT_DOUBLE_EQ(s.minimum, 100.0);
  EXPECT_DOUBLE_EQ(s.maximum, 500.0);
  EXPECT_DOUBLE_EQ(s.u0, 0.5);
  EXPECT_DOUBLE_EQ(s.ud, 0.2);
  EXPECT_DOUBLE_EQ(s.median, 200.0);
  EXPECT_DOUBLE_EQ(s.area, 8.0);
  EXPECT_DOUBLE_EQ(s.unknown_area, 2.0);
  EXPECT_DOUBLE_EQ(s.histogram.front(), 3.0);
  EXPECT_DOUBLE_EQ(s.histogram.back(), 1.0);
  EXPECT_NE(to_json(make_statistics({}), "f", "all").find("\"mean\": null"), std::string::npos);
}

TEST(ViewSelection, ObjectsMaterialsAndFacets) {
  Mesh m = room();
  m.objects = {"floor", "back wall", "left wall"};
  const auto count = [&](const std::string& text) {
    const auto in = selected(m, parse_selection("--hide", text, m));
    return std::count(in.begin(), in.end(), 1);
  };
  EXPECT_EQ(count("all"), 192 + 48 + 48);
  EXPECT_EQ(count("object=back wall"), 48);
  EXPECT_EQ(count("object=2"), 48);
  EXPECT_EQ(count("facet=5"), 192);
  EXPECT_EQ(count("material=0"), 192);
  EXPECT_NE(error_of([&] { (void)count("object=flor"); }).find("did you mean floor"),
            std::string::npos);
  for (const char* bad : {"", "object", "object=", "facet=x", "lamp=1", "facet=99999"})
    EXPECT_FALSE(error_of([&] { (void)count(bad); }).empty()) << bad;
}

TEST(ViewPicker, MeetsTheFirstThingThatIsThere) {
  const Mesh m = room();
  const Triangles t = triangulate(m);
  const Picker picker(m, t);
  const Vec3d down(0, -1, 0), eye(2.1, 2.0, 1.4);
  const auto hit = picker.pick(eye, down, {}, false);
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit->front);
  EXPECT_LT((hit->position - Vec3d(2.1, 0.0, 1.4)).norm(), 1e-6);
  EXPECT_NEAR(hit->weights[0] + hit->weights[1] + hit->weights[2], 1.0, 1e-9);
  EXPECT_FALSE(picker.pick(eye, down, {{Vec3d::UnitX(), 1.0}}, false)) << "the floor is cut away";
  const auto below = picker.pick({2.1, -1.0, 1.4}, -down, {}, false);
  ASSERT_TRUE(below);
  EXPECT_FALSE(below->front);
  EXPECT_FALSE(picker.pick({2.1, -1.0, 1.4}, -down, {}, true)) << "turned away";
}

TEST(ViewProbe, NamesWhatIsThere) {
  Mesh m = room();
  m.materials = {"oak"};
  const Triangles t = triangulate(m);
  const auto hit = Picker(m, t).pick({2.1, 2.0, 1.4}, {0, -1, 0}, {}, false);
  ASSERT_TRUE(hit);
  const std::vector<Field> fields = fields_of(m);
  const std::string text =
      Probe(m).describe(m, fields[find_field(fields, "illuminance")], *hit, 512.0);
  for (const char* part : {"512", "+- ", "0.0625 m^2", "material 0 oak", "object 0", "2.100"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
}

// The circles round the lamp: every point of the line of 300 lx has 300 lx, as far as 0.25 m cells
// tell (second derivative of the lamp's light below 1000 lx/m^2: 1000 * 0.25^2 / 8 = 8 lx).
TEST(ViewContours, LinesAreWhereTheValueIs) {
  const Mesh m = room();
  const std::vector<Field> fields = fields_of(m);
  const Values v = numbers_of(m, fields[find_field(fields, "illuminance")], Side::Front, true);
  const auto lines = find_contours(m, triangulate(m), Side::Front, v, {300.0, 400.0}, {});
  ASSERT_GT(lines->GetNumberOfPoints(), 20);
  for (vtkIdType i = 0; i < lines->GetNumberOfPoints(); ++i) {
    const Vec3d p(lines->GetPoint(i));
    const double value = lines->GetPointData()->GetScalars()->GetTuple1(i);
    EXPECT_NEAR(ViewRoom::lamp(p) + ViewRoom::strip(p), value, 12.0);
  }
  EXPECT_GE(place_labels(*lines, 0.3).size(), 2u);
  const auto cut =
      find_contours(m, triangulate(m), Side::Front, v, {300.0}, {{Vec3d::UnitX(), 2.0}});
  for (vtkIdType i = 0; i < cut->GetNumberOfPoints(); ++i)
    EXPECT_LE(cut->GetPoint(i)[0], 2.0 + 1e-6);
}

// Two halves of a quad are one element: their common edge is none.
TEST(ViewEdges, InsideAnElementThereAreNone) {
  scene::PolygonMesh p;
  p.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  p.polygon_sizes = {3, 3};
  p.polygon_points = {0, 1, 2, 0, 2, 3};
  p.cell_arrays.push_back({"element_id", 1, {5.0f, 5.0f}});
  EXPECT_EQ(element_edges(make_mesh(p, "m")).size(), 4u);
  p.cell_arrays[0].values[1] = 6.0f;
  EXPECT_EQ(element_edges(make_mesh(p, "m")).size(), 5u);
}

// A slab of 0.3 m over a room goes with both faces; floor and table stay.
TEST(ViewCeilings, SlabGoesTableStays) {
  scene::PolygonMesh p;
  for (const double y : {0.0, 0.75, 2.5, 2.8}) {
    const auto first = static_cast<std::uint32_t>(p.points.size());
    const double half = y == 0.75 ? 0.5 : 2.0;
    p.points.insert(p.points.end(),
                    {{-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half}});
    p.polygon_sizes.push_back(4);
    for (std::uint32_t i = 0; i < 4; ++i) p.polygon_points.push_back(first + i);
  }
  EXPECT_EQ(find_ceilings(make_mesh(p, "m")), (std::vector<std::uint8_t>{0, 0, 1, 1}));
}

TEST(ViewPoints, TextsNamesAndNumbers) {
  const Mesh m = room();
  std::vector<ViewPoint> known{overview(m, 1.5), plan(m, 1.5)};
  EXPECT_EQ(choose_view("", known).name, "overview");
  EXPECT_EQ(choose_view("1", known).name, "plan");
  const ViewPoint v = choose_view("1,2,3:4,5,6:0,0,1:35", known);
  EXPECT_EQ(v.eye, Vec3d(1, 2, 3));
  EXPECT_EQ(v.target, Vec3d(4, 5, 6));
  EXPECT_EQ(v.up, Vec3d(0, 0, 1));
  EXPECT_DOUBLE_EQ(v.yfov_deg, 35.0);
  EXPECT_DOUBLE_EQ(choose_view("0,0,9:0,0,0:20", known).yfov_deg, 20.0);
  for (const char* bad : {"kitchen", "7", "1,2,3", "1,2,3:1,2,3", "0,0,0:0,1,0", "0,0,9:0,0,0:400",
                          "0,0,9:0,0,0:nan", "0,0,9:0,0,0:0,1,0:40:9"})
    EXPECT_FALSE(error_of([&] { (void)choose_view(bad, known); }).empty()) << bad;
}

// A ground plane of a kilometre does not make the room a dot.
TEST(ViewPoints, OverviewIsOfWhatMostPolygonsAreIn) {
  scene::PolygonMesh p = ViewRoom::mesh();
  p.cell_arrays.clear();
  p.point_arrays.clear();
  const auto first = static_cast<std::uint32_t>(p.points.size());
  p.points.insert(p.points.end(), {{-500, 0, 500}, {500, 0, 500}, {500, 0, -500}, {-500, 0, -500}});
  p.polygon_sizes.push_back(4);
  for (std::uint32_t i = 0; i < 4; ++i) p.polygon_points.push_back(first + i);
  const ViewPoint v = overview(make_mesh(p, "m"), 1.0);
  EXPECT_LT((v.eye - Vec3d(2, 1.5, 1.5)).norm(), 20.0);
}

TEST(ViewTexts, RangesContoursClips) {
  EXPECT_EQ(parse_range("0.5,200", true), (std::array{0.5, 200.0}));
  for (const char* bad : {"5", "5,5", "9,1", "a,b", "0,inf", "1,2,3"})
    EXPECT_FALSE(error_of([&] { (void)parse_range(bad, false); }).empty()) << bad;
  EXPECT_FALSE(error_of([&] { (void)parse_range("0,5", true); }).empty());
  EXPECT_EQ(parse_contours("7").count, 7);
  EXPECT_EQ(parse_contours("300,100").levels, (std::vector<double>{100, 300}));
  EXPECT_EQ(parse_contours("300,").levels, (std::vector<double>{300}));
  for (const char* bad : {"0", "-3", "1.5", "x", "1,x", "1000", ","})
    EXPECT_FALSE(error_of([&] { (void)parse_contours(bad); }).empty()) << bad;
  const Clip above = parse_clip("y<2.4"), right = parse_clip("x>1"),
             slanted = parse_clip("0,0,2<4");
  EXPECT_EQ(above, (Clip{Vec3d(0, 1, 0), 2.4}));
  EXPECT_EQ(right, (Clip{Vec3d(-1, 0, 0), -1.0}));
  EXPECT_EQ(slanted, (Clip{Vec3d(0, 0, 1), 2.0}));
  for (const char* bad : {"y", "y<", "q<1", "<1", "0,0,0<1", "y<<1", "y=1"})
    EXPECT_FALSE(error_of([&] { (void)parse_clip(bad); }).empty()) << bad;
}

}  // namespace
}  // namespace atrium::view
