#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "import_util.h"
#include "material/error.h"
#include "scene/limits.h"
#include "scene/weather.h"

namespace atrium::scene {
namespace {

/// The fields of one line, separated by commas, with its place for messages.
class Fields {
 public:
  Fields(const std::string& file, int line, std::string_view text) : file_(file), line_(line) {
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      fields_.push_back(trimmed(text.substr(begin, end - begin)));
      begin = end + 1;
    }
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(file_ + ":" + std::to_string(line_) + ": " + message);
  }

  [[nodiscard]] std::string_view text(std::size_t i) const {
    return i < fields_.size() ? fields_[i] : std::string_view();
  }
  /// The i-th field from 0. \param missing  from here on it means that there is no value.
  [[nodiscard]] double number(std::size_t i, const char* what, double low, double high,
                              double missing) const {
    const std::string_view t = text(i);
    double value = 0.0;
    const auto [end, code] = std::from_chars(t.data(), t.data() + t.size(), value);
    if (t.empty() || code != std::errc() || end != t.data() + t.size() || !std::isfinite(value))
      fail("expected a number for " + std::string(what) + " (field " + std::to_string(i + 1) +
           "), found '" + std::string(t) + "'");
    if (value >= missing)
      fail(std::string(what) + " is marked as missing (" + std::string(t) + ")");
    if (!(value >= low && value <= high))
      fail(std::string(what) + " is out of range: " + std::string(t));
    return value;
  }
  [[nodiscard]] int integer(std::size_t i, const char* what, int low, int high) const {
    const double value = number(i, what, low, high, std::numeric_limits<double>::infinity());
    if (value != std::floor(value)) fail(std::string(what) + " must be a whole number");
    return static_cast<int>(value);
  }

 private:
  static std::string_view trimmed(std::string_view s) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!s.empty() && blank(s.front())) s.remove_prefix(1);
    while (!s.empty() && blank(s.back())) s.remove_suffix(1);
    return s;
  }

  const std::string& file_;
  int line_;
  std::vector<std::string_view> fields_;
};

constexpr double kNeverMissing = std::numeric_limits<double>::infinity();

void read_place(const Fields& f, WeatherHour& w) {
  if (f.text(0) != "LOCATION") f.fail("is no EPW weather file: it must begin with LOCATION");
  w.city = f.text(1);
  w.place.latitude_deg = f.number(6, "the latitude", -90.0, 90.0, kNeverMissing);
  w.place.longitude_deg = f.number(7, "the longitude", -180.0, 180.0, kNeverMissing);
  w.place.utc_offset = f.number(8, "the time zone", -12.0, 14.0, kNeverMissing);
}

void read_row(const Fields& f, WeatherHour& w) {
  w.middle = {f.integer(0, "the year", 1, 9999), f.integer(1, "the month", 1, 12),
              f.integer(2, "the day", 1, 31), f.integer(3, "the hour", 1, 24) - 0.5};
  w.dew_point_c = f.number(7, "the dew point", -90.0, 70.0, 99.9);
  w.direct_normal = f.number(14, "the direct normal irradiance", 0.0, 1500.0, 9999.0);
  w.diffuse_horizontal = f.number(15, "the diffuse horizontal irradiance", 0.0, 1500.0, 9999.0);
}

}  // namespace

WeatherHour read_epw(const std::filesystem::path& file, int month, int day, int hour) {
  const std::string name = file.string();
  const std::vector<std::uint8_t> bytes = read_file_bytes(file, limits::kTableBytes);
  std::istringstream in(std::string(bytes.begin(), bytes.end()));
  WeatherHour weather;
  std::string text;
  bool data = false;
  int line = 0;
  while (std::getline(in, text)) {
    const Fields f(name, ++line, text);
    if (line == 1) read_place(f, weather);
    if (data && f.integer(1, "the month", 1, 12) == month &&
        f.integer(2, "the day", 1, 31) == day && f.integer(3, "the hour", 1, 24) == hour) {
      read_row(f, weather);
      return weather;
    }
    data = data || f.text(0) == "DATA PERIODS";
  }
  if (!data) throw Error(name + ":" + std::to_string(line) + ": ends before DATA PERIODS");
  throw Error(name + ":" + std::to_string(line) + ": has no row for month " +
              std::to_string(month) + ", day " + std::to_string(day) + ", hour " +
              std::to_string(hour));
}

}  // namespace atrium::scene
