#include "sensor_file.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "material/error.h"

namespace atrium::app {

namespace {

bool separates(char c) { return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == ';'; }

/// The numbers of a line. False for anything that is none.
bool numbers_of(std::string_view line, std::vector<double>& numbers) {
  numbers.clear();
  for (std::size_t at = 0;;) {
    while (at < line.size() && separates(line[at])) ++at;
    if (at == line.size()) return true;
    if (line[at] == '+') ++at;
    double value = 0.0;
    const auto [next, code] = std::from_chars(line.data() + at, line.data() + line.size(), value);
    const auto end = static_cast<std::size_t>(next - line.data());
    if (code != std::errc() || !std::isfinite(value) ||
        (end < line.size() && !separates(line[end])))
      return false;
    numbers.push_back(value);
    at = end;
  }
}

}  // namespace

std::vector<radiosity::Sensor> read_sensors(const std::string& file) {
  std::error_code unknown;
  if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file, unknown))
    throw Error(file + ": not a file");
  std::ifstream in(file);
  if (!in) throw Error(file + ": cannot be read");
  std::vector<radiosity::Sensor> sensors;
  std::vector<double> n;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto fail = [&](const std::string& what) {
      throw Error(file + ":" + std::to_string(number) + ": " + what);
    };
    const bool good = numbers_of(std::string_view(line).substr(0, line.find('#')), n);
    if (good && n.empty()) continue;
    if (!good || n.size() != 6) fail("is not x y z nx ny nz, six numbers");
    const Vec3d normal(n[3], n[4], n[5]);
    const double length = normal.stableNorm();
    if (sensors.size() == kMostSensors) fail("more than ten million sensors");
    if (!(length > 0.0) || !std::isfinite(length)) fail("the normal has no direction");
    sensors.push_back({Vec3d(n[0], n[1], n[2]), (normal / length).normalized()});
  }
  if (in.bad()) throw Error(file + ": cannot be read");
  if (sensors.empty()) throw Error(file + ": has no sensors");
  return sensors;
}

}  // namespace atrium::app
