#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "material/error.h"
#include "scene/sky.h"
#include "scene/weather.h"
#include "support/temp_folder.h"

namespace atrium::scene {
namespace {

constexpr const char* kHead =
    "LOCATION,Somewhere,XX,YYY,TMY3,1,41.98,-87.92,-6.0,201.0\n"
    "DESIGN CONDITIONS,0\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n";

std::string row(int hour, const std::string& direct, const std::string& diffuse) {
  return "1986,6,21," + std::to_string(hour) + ",0,?9?9,25.0,14.5,51,99000,920,1322,387,649," +
         direct + "," + diffuse + ",68400,69100,20200\n";
}

TEST(Epw, OneRow) {
  const test::TempFolder folder;
  folder.write("a.epw", kHead + row(9, "682", "172") + row(10, "740", "193.5"));
  const WeatherHour w = read_epw(folder / "a.epw", 6, 21, 10);
  EXPECT_EQ(w.city, "Somewhere");
  EXPECT_EQ(w.place.latitude_deg, 41.98);
  EXPECT_EQ(w.place.longitude_deg, -87.92);
  EXPECT_EQ(w.place.utc_offset, -6.0);
  EXPECT_EQ(w.middle.year, 1986);
  EXPECT_EQ(w.middle.hour, 9.5) << "the middle of the hour that ends at 10";
  EXPECT_EQ(w.dew_point_c, 14.5);
  EXPECT_EQ(w.direct_normal, 740.0);
  EXPECT_EQ(w.diffuse_horizontal, 193.5);
}

TEST(Epw, ErrorsNameTheLine) {
  const test::TempFolder folder;
  const auto message = [&](const std::string& text, int hour = 9) -> std::string {
    folder.write("a.epw", text);
    try {
      (void)read_epw(folder / "a.epw", 6, 21, hour);
    } catch (const Error& e) {
      return std::string(e.what()).substr((folder / "a.epw").string().size());
    }
    return "no error";
  };
  EXPECT_EQ(message(""), ": the file is empty");
  EXPECT_EQ(message("hello\n"), ":1: is no EPW weather file: it must begin with LOCATION");
  EXPECT_EQ(message("LOCATION,a,b,c,d,1,north\n"),
            ":1: expected a number for the latitude (field 7), found 'north'");
  EXPECT_EQ(message("LOCATION,a,b,c,d,1,95,0,0\n"), ":1: the latitude is out of range: 95");
  EXPECT_EQ(message("LOCATION,a,b,c,d,1,nan,0,0\n"),
            ":1: expected a number for the latitude (field 7), found 'nan'");
  EXPECT_EQ(message("LOCATION,a,b,c,d,1,41,0,0\n"), ":1: ends before DATA PERIODS");
  EXPECT_EQ(message(kHead + row(9, "682", "")),
            ":4: expected a number for the diffuse horizontal irradiance (field 16), found ''");
  EXPECT_EQ(message(kHead + row(9, "9999", "172")),
            ":4: the direct normal irradiance is marked as missing (9999)");
  EXPECT_EQ(message(kHead + row(9, "-3", "172")),
            ":4: the direct normal irradiance is out of range: -3");
  EXPECT_EQ(message(kHead + row(9, "682", "172"), 11),
            ":4: has no row for month 6, day 21, hour 11");
  EXPECT_EQ(message(kHead + std::string("1986,6\n")),
            ":4: expected a number for the day (field 3), found ''");
  EXPECT_THROW((void)read_epw(folder / "none.epw", 1, 1, 1), Error);
}

// A row of the TMY3 file of Chicago O'Hare (NREL 2008): the sun stands where the row's global
// irradiance needs it, and the row's own illuminances, modelled by others from more data (their
// diffuse is global minus direct), are those of our efficacies within what two such models differ.
TEST(Epw, ChicagoAgreesWithItsOwnIlluminances) {
  const test::TempFolder folder;
  folder.write(
      "a.epw",
      "LOCATION,Chicago Ohare Intl Ap,IL,USA,TMY3,725300,41.98,-87.92,-6.0,201.0\r\n"
      "DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\r\n"
      "1979,6,21,12,0,?9?9?9?9E0?9?9?9?9?9?9?9?9?9?9?9?9?9?9?9*9*9*9*9*9,30.6,13.3,35,99000,"
      "1247,1322,405,876,703,211,94400,72200,26100,14700,270,10.3,1,1,24.1,77777,9,999999999,"
      "240,0.2220,0,88,999.000,999.0,99.0\r\n");
  const WeatherHour noon = read_epw(folder / "a.epw", 6, 21, 12);
  EXPECT_EQ(noon.direct_normal, 703.0);
  EXPECT_EQ(noon.diffuse_horizontal, 211.0);
  const SunPosition sun = sun_position(noon.place, noon.middle);
  EXPECT_NEAR(sun.elevation * 180.0 / std::numbers::pi, 71.0, 1.0);
  // Global irradiance of the file: 876 = diffuse + direct sin(elevation).
  EXPECT_NEAR(211.0 + 703.0 * std::sin(sun.elevation), 876.0, 10.0);
  const PerezState s = perez_state(noon.direct_normal, noon.diffuse_horizontal,
                                   0.5 * std::numbers::pi - sun.elevation, sun.distance_au);
  EXPECT_NEAR(perez_direct_efficacy(s, noon.dew_point_c) * 703.0, 72200.0, 0.05 * 72200.0);
  EXPECT_NEAR(perez_diffuse_efficacy(s, noon.dew_point_c) * 211.0, 26100.0, 0.10 * 26100.0);
}

}  // namespace
}  // namespace atrium::scene
