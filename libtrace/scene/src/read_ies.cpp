#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "import_util.h"
#include "luminaire_text.h"
#include "material/error.h"
#include "scene/limits.h"
#include "scene/luminaire.h"

namespace atrium::scene {

std::string read_luminaire_text(const std::filesystem::path& file) {
  std::error_code code;
  if (std::filesystem::is_empty(file, code)) return {};  // its first line is missing
  const std::vector<std::uint8_t> bytes = read_file_bytes(file, limits::kTableBytes);
  return {bytes.begin(), bytes.end()};
}

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr int kMaxAngles = 10000;

// The numbers of a file, separated by white space or commas, with the line for messages.
class NumberStream {
 public:
  NumberStream(std::string name, std::string_view text, int line)
      : name_(std::move(name)), text_(text), line_(line) {}

  double number(const char* what) {
    skip();
    if (position_ == text_.size()) fail(std::string("the file ends before ") + what);
    const char* begin = text_.data() + position_;
    const char* end = text_.data() + text_.size();
    if (*begin == '+') ++begin;
    double value = 0.0;
    const auto [next, code] = std::from_chars(begin, end, value);
    if (code != std::errc() || (next != end && !separator(*next)) || !std::isfinite(value)) {
      fail(std::string("expected a number for ") + what);
    }
    position_ = static_cast<std::size_t>(next - text_.data());
    return value;
  }

  int integer(const char* what, int low, int high) {
    const double value = number(what);
    if (!(value >= low && value <= high) || value != std::floor(value)) {
      fail(std::string(what) + " must be a whole number from " + std::to_string(low) + " to " +
           std::to_string(high));
    }
    return static_cast<int>(value);
  }

  double factor(const char* what) {
    const double value = number(what);
    if (!(value >= 0.0)) fail(std::string(what) + " must not be negative");
    return value;
  }

  std::vector<double> increasing(const char* what, int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
      values.push_back(number(what));
      if (i > 0 && !(values[values.size() - 1] >= values[values.size() - 2] + kLeastStep)) {
        fail(std::string(what) + " must increase");
      }
    }
    return values;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(name_ + ":" + std::to_string(line_) + ": " + message);
  }

 private:
  static bool separator(char c) {
    return c == ',' || std::isspace(static_cast<unsigned char>(c)) != 0;
  }
  void skip() {
    for (; position_ < text_.size() && separator(text_[position_]); ++position_) {
      if (text_[position_] == '\n') ++line_;
    }
  }

  std::string name_;
  std::string_view text_;
  std::size_t position_ = 0;
  int line_;
};

// LM-63 tilt table: how the lamp's flux depends on the angle that the luminaire is tilted by. A
// luminaire in the position it was measured in has tilt 0, which is what a scene describes.
double read_tilt_factor(NumberStream& in) {
  in.integer("lamp to luminaire geometry", 1, 3);
  const int count = in.integer("number of tilt angles", 1, kMaxAngles);
  const std::vector<double> angles = in.increasing("tilt angle", count);
  double at_zero = 1.0;
  for (const double angle : angles) {
    const double factor = in.factor("tilt factor");
    if (angle == 0.0) at_zero = factor;
  }
  return at_zero;
}

struct Header {
  int edition = 1986;  // which has no line of its own
  std::string name;
  std::string tilt;
  std::size_t data = 0;  // offset of what follows the TILT line
  int line = 1;          // of that offset
};

// The year of "IESNA91", "IESNA:LM-63-1995", "IES:LM-63-2019". Nothing: a free text, as the first
// line of the first edition is.
std::optional<int> edition_of(const std::string& line) {
  constexpr std::string_view kShort = "IESNA", kStandard = "LM-63-";
  const std::size_t standard = line.find(kStandard);
  if (!line.starts_with("IES")) return std::nullopt;
  const std::size_t begin =
      standard != std::string::npos ? standard + kStandard.size() : kShort.size();
  if (begin >= line.size()) return std::nullopt;
  int year = 0;
  const auto [next, code] = std::from_chars(line.data() + begin, line.data() + line.size(), year);
  if (code != std::errc() || next != line.data() + line.size()) return std::nullopt;
  if (year >= 0 && year < 100) year += year < 86 ? 2000 : 1900;
  return year >= 1986 && year < 2100 ? std::optional(year) : std::nullopt;
}

void read_label(const std::string& line, Header& header) {
  constexpr std::string_view kName = "[LUMINAIRE]";
  if (header.line == 1) header.edition = edition_of(line).value_or(header.edition);
  if (!line.starts_with(kName)) return;
  const std::size_t text = line.find_first_not_of(" \t", kName.size());
  if (text != std::string::npos) header.name = line.substr(text);
}

Header read_header(const std::string& name, const std::string& text) {
  Header header;
  std::size_t begin = 0;
  for (; begin < text.size(); ++header.line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    begin = std::min(end + 1, text.size());
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    line.erase(0, std::min(line.find_first_not_of(" \t\xef\xbb\xbf"), line.size()));
    read_label(line, header);
    if (line.size() < 5) continue;
    std::string start = line.substr(0, 5);
    for (char& c : start) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (start != "TILT=") continue;
    header.tilt = line.substr(5);
    header.tilt.erase(0, std::min(header.tilt.find_first_not_of(" \t"), header.tilt.size()));
    header.data = begin;
    ++header.line;
    return header;
  }
  throw Error(name + ":" + std::to_string(header.line) +
              ": no TILT= line, so this is no IES LM-63 file");
}

double tilt_factor(const Header& header, NumberStream& in, const std::filesystem::path& file) {
  std::string keyword = header.tilt;
  for (char& c : keyword) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (keyword == "NONE") return 1.0;
  if (keyword == "INCLUDE") return read_tilt_factor(in);
  const std::filesystem::path name(header.tilt);
  const std::string place = file.string() + ":" + std::to_string(header.line - 1) + ": ";
  if (name.empty() || name != name.filename() || name == "..")
    throw Error(place + "TILT must be NONE, INCLUDE or the name of a file beside this one");
  const std::filesystem::path tilt_file = file.parent_path() / name;
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(tilt_file, unreadable))
    throw Error(place + "there is no TILT file beside this one by that name");
  const std::string text = read_luminaire_text(tilt_file);
  NumberStream tilt(tilt_file.string(), text, 1);
  return read_tilt_factor(tilt);
}

// The table as measured: candela[h * vertical.size() + v].
struct Table {
  int type = 1;                // 1: C, 2: B, 3: A
  double lamp_flux = -1.0;     // of all lamps; below 0: absolute photometry
  Vec3d size = Vec3d::Zero();  // width, length, height [m]; negative: round
  std::vector<double> vertical;
  std::vector<double> horizontal;
  std::vector<double> candela;
};

// The number between ballast factor and watts. LM-63-1986 and 1991 call it the ballast-lamp
// photometric factor, 1995 and 2002 reserve it ("future use") and demand 1, so that what deviates
// there was meant as the older factor, as Radiance's ies2rad and Cycles read it, too. Since
// LM-63-2019, 5.13, it is the file generation type: digits after "1." say whether the table was
// measured, simulated, scaled. They scale nothing.
double photometric_factor(NumberStream& in, int edition) {
  if (edition < 2019) return in.factor("ballast-lamp photometric factor");
  in.number("file generation type");
  return 1.0;
}

Table read_table(NumberStream& in, double tilt, int edition) {
  Table table;
  const int lamps = in.integer("number of lamps", 0, 1000000);
  const double lumens = in.number("lumens per lamp");
  if (!(lumens <= kMostCandela)) in.fail("lumens per lamp: too large");
  table.lamp_flux = lumens < 0.0 ? -1.0 : lamps * lumens;
  const double multiplier = in.factor("candela multiplier");
  const int vertical = in.integer("number of vertical angles", 2, kMaxAngles);
  const int horizontal = in.integer("number of horizontal angles", 1, kMaxAngles);
  table.type = in.integer("photometric type", 1, 3);
  constexpr double kFoot = 0.3048;
  const double metres = in.integer("units type", 1, 2) == 1 ? kFoot : 1.0;
  const std::pair<const char*, int> sizes[] = {{"width", 0}, {"length", 1}, {"height", 2}};
  for (const auto& [name, axis] : sizes) table.size[axis] = in.number(name) * metres;
  const double ballast = in.factor("ballast factor");
  const double photometric = photometric_factor(in, edition);
  in.number("input watts");
  const double scale = multiplier * ballast * photometric * tilt;
  table.vertical = in.increasing("vertical angle", vertical);
  table.horizontal = in.increasing("horizontal angle", horizontal);
  for (int i = 0; i < vertical * horizontal; ++i) {
    table.candela.push_back(in.factor("candela value") * scale);
    if (!(table.candela.back() <= kMostCandela)) in.fail("candela value times factors: too large");
  }
  return table;
}

bool near(double a, double b) { return std::abs(a - b) < 0.01; }

// Type C planes over the whole circle from what symmetry left out.
IntensityProfile unfold_type_c(const Table& table, const NumberStream& in) {
  IntensityProfile profile;
  profile.theta_deg = table.vertical;
  const double first = table.horizontal.front();
  const double last = table.horizontal.back();
  if (!(profile.theta_deg.front() >= 0.0 && profile.theta_deg.back() <= 180.0)) {
    in.fail("vertical angles of type C must lie within 0 to 180");
  }
  const auto add = [&](double phi, std::size_t plane) {
    if (!profile.phi_deg.empty() && phi <= profile.phi_deg.back() + 1e-9) return;
    profile.phi_deg.push_back(phi);
    const auto row =
        table.candela.begin() + static_cast<std::ptrdiff_t>(plane * table.vertical.size());
    profile.candela.insert(profile.candela.end(), row,
                           row + static_cast<std::ptrdiff_t>(table.vertical.size()));
  };
  const std::size_t count = table.horizontal.size();
  const auto forward = [&](double offset) {
    for (std::size_t i = 0; i < count; ++i) add(offset + table.horizontal[i], i);
  };
  const auto mirrored = [&](double about) {  // phi -> about - phi, in increasing order
    for (std::size_t i = count; i-- > 0;) add(about - table.horizontal[i], i);
  };
  if (count == 1) {
    add(0.0, 0);
  } else if (near(first, 0.0) && near(last, 90.0)) {
    forward(0.0), mirrored(180.0), forward(180.0), mirrored(360.0);
  } else if (near(first, 0.0) && near(last, 180.0)) {
    forward(0.0), mirrored(360.0);
  } else if (near(first, 90.0) && near(last, 270.0)) {
    // Symmetric about the plane 90-270: the half around 0 is the mirror image of that around 180.
    for (std::size_t i = count; i-- > 0;) {
      if (table.horizontal[i] <= 180.0) add(180.0 - table.horizontal[i], i);
    }
    forward(0.0);
    for (std::size_t i = count; i-- > 0;) {
      if (table.horizontal[i] >= 180.0) add(540.0 - table.horizontal[i], i);
    }
  } else if (first >= 0.0 && first < 90.0 && last > 180.0 && last <= 360.0 + 0.01) {
    forward(0.0);  // the whole circle; 0 and 360 may be left out
    if (!near(first, 0.0) || !near(last, 360.0)) add(first + 360.0, 0);
  } else {
    in.fail("horizontal angles of type C must run 0, 0-90, 0-180, 90-270 or 0-360");
  }
  return profile;
}

// As the file leaves it out.
std::string symmetry_of(const Table& table) {
  const double first = table.horizontal.front();
  const double last = table.horizontal.back();
  if (table.type != 1) return first >= 0.0 ? "left-right" : "none";
  if (table.horizontal.size() == 1) return "round";
  if (near(first, 0.0) && near(last, 90.0)) return "planes 0-180 and 90-270";
  if (near(first, 0.0) && near(last, 180.0)) return "plane 0-180";
  if (near(first, 90.0) && near(last, 270.0)) return "plane 90-270";
  return "none";
}

double table_at(const Table& table, double v, double h) {
  if (table.horizontal.front() >= 0.0) h = std::abs(h);  // mirror symmetry
  if (table.vertical.front() >= 0.0) v = std::abs(v);
  const auto place = [](const std::vector<double>& grid, double x) {
    std::size_t i = 1;
    while (i + 1 < grid.size() && grid[i] < x) ++i;
    return i;
  };
  constexpr double slack = 1e-9;
  if (v < table.vertical.front() - slack || v > table.vertical.back() + slack) return 0.0;
  const std::size_t i = place(table.vertical, v);
  const double s = std::clamp(
      (v - table.vertical[i - 1]) / (table.vertical[i] - table.vertical[i - 1]), 0.0, 1.0);
  const auto row = [&](std::size_t plane) {
    const double* c = table.candela.data() + plane * table.vertical.size();
    return c[i - 1] + s * (c[i] - c[i - 1]);
  };
  if (table.horizontal.size() == 1) return row(0);
  if (h < table.horizontal.front() - slack || h > table.horizontal.back() + slack) return 0.0;
  const std::size_t j = place(table.horizontal, h);
  const double t = std::clamp(
      (h - table.horizontal[j - 1]) / (table.horizontal[j] - table.horizontal[j - 1]), 0.0, 1.0);
  return row(j - 1) + t * (row(j) - row(j - 1));
}

// Types A and B count from the beam's axis, which is the luminaire's -z here, with y up and x to
// the right. Type A has its poles on y (h is a longitude), type B on x (v is a longitude). The
// table is resampled on 1 degree by 3 degrees.
IntensityProfile convert_to_type_c(const Table& table) {
  IntensityProfile profile;
  for (int t = 0; t <= 180; ++t) profile.theta_deg.push_back(t);
  for (int p = 0; p <= 360; p += 3) profile.phi_deg.push_back(p);
  for (const double phi : profile.phi_deg) {
    for (const double theta : profile.theta_deg) {
      const double sine = std::sin(theta / kDegrees);
      const double x = sine * std::cos(phi / kDegrees);
      const double y = sine * std::sin(phi / kDegrees);
      const double forward = std::cos(theta / kDegrees);
      const double pole = std::clamp(table.type == 3 ? y : x, -1.0, 1.0);
      const double latitude = std::asin(pole) * kDegrees;
      const double longitude = std::atan2(table.type == 3 ? x : y, forward) * kDegrees;
      profile.candela.push_back(table.type == 3 ? table_at(table, latitude, longitude)
                                                : table_at(table, longitude, latitude));
    }
  }
  return profile;
}

}  // namespace

Luminaire read_ies(const std::filesystem::path& file) {
  const std::string text = read_luminaire_text(file);
  const Header header = read_header(file.string(), text);
  NumberStream in(file.string(), std::string_view(text).substr(header.data), header.line);
  const double tilt = tilt_factor(header, in, file);
  const Table table = read_table(in, tilt, header.edition);
  Luminaire l;
  l.format = "LM-63-" + std::to_string(header.edition);
  l.name = header.name;
  l.type = table.type == 1 ? 'C' : table.type == 2 ? 'B' : 'A';
  l.symmetry = symmetry_of(table);
  if (table.lamp_flux >= 0.0) l.lamp_flux = table.lamp_flux;
  const bool round = table.size.x() < 0.0 || table.size.y() < 0.0;
  l.opening = table.size.cwiseAbs();
  if (round) l.opening.y() = 0.0;
  l.profile = table.type == 1 ? unfold_type_c(table, in) : convert_to_type_c(table);
  return l;
}

}  // namespace atrium::scene
