#include <algorithm>
#include <charconv>
#include <cmath>

#include "luminaire_text.h"
#include "material/error.h"
#include "scene/luminaire.h"

namespace atrium::scene {
namespace {

constexpr int kMaxPlanes = 3601;
constexpr int kMaxAngles = 18001;
constexpr int kMaxLampSets = 20;
constexpr double kSameAngle = 0.01;  // [deg]

/// The file as lines: one value each.
class Lines {
 public:
  Lines(std::string name, std::string_view text) : name_(std::move(name)), text_(text) {}

  std::string text(const char* what) {
    if (at_ >= text_.size()) fail_after(std::string("the file ends before ") + what);
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string line(text_.substr(at_, end - at_));
    at_ = end + 1;
    ++line_;
    const auto first = line.find_first_not_of(" \t\r\xef\xbb\xbf");
    if (first == std::string::npos) return "";
    return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
  }
  /// Some writers put a decimal comma.
  double number(const char* what) {
    std::string line = text(what);
    std::replace(line.begin(), line.end(), ',', '.');
    const char* begin = line.data() + (line.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [next, code] = std::from_chars(begin, line.data() + line.size(), value);
    if (code != std::errc() || next != line.data() + line.size() || !std::isfinite(value))
      fail(std::string("expected a number for ") + what);
    return value;
  }
  double number(const char* what, double low) {
    const double value = number(what);
    if (!(value >= low)) fail(std::string(what) + " must be at least " + std::to_string(low));
    return value;
  }
  int integer(const char* what, int low, int high) {
    const double value = number(what);
    if (!(value >= low && value <= high) || value != std::floor(value))
      fail(std::string(what) + " must be a whole number from " + std::to_string(low) + " to " +
           std::to_string(high));
    return static_cast<int>(value);
  }
  std::vector<double> increasing(const char* what, int count, double most) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
      const double value = number(what, 0.0);
      if (i > 0 && !(value >= values.back() + kLeastStep))
        fail(std::string(what) + " must increase");
      if (!(value <= most)) fail(std::string(what) + " must be at most " + std::to_string(most));
      values.push_back(value);
    }
    return values;
  }
  void skip(const char* what, int count) {
    for (int i = 0; i < count; ++i) (void)text(what);
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(name_ + ":" + std::to_string(line_) + ": " + message);
  }

 private:
  [[noreturn]] void fail_after(const std::string& message) {
    ++line_;
    fail(message);
  }
  std::string name_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0;
};

enum Symmetry { kNone, kRound, kPlane0, kPlane90, kBothPlanes };

/// Which of the planes in the file plane m of the circle is equal to; the file holds those from
/// first_plane() on.
int stored_plane(Symmetry symmetry, int m, int planes) {
  const int half = planes / 2;
  const int quarter = planes / 4;
  switch (symmetry) {
    case kNone:
      break;
    case kRound:
      return 0;
    case kPlane0:
      return m <= half ? m : planes - m;
    case kPlane90:
      return m > quarter && m < planes - quarter ? (half - m + planes) % planes : m;
    case kBothPlanes: {
      const int front = m <= half ? m : planes - m;
      return front <= quarter ? front : half - front;
    }
  }
  return m;
}
int first_plane(Symmetry symmetry, int planes) {
  return symmetry == kPlane90 ? planes - planes / 4 : 0;
}
int plane_count(Symmetry symmetry, int planes) {
  switch (symmetry) {
    case kNone:
      break;
    case kRound:
      return 1;
    case kPlane0:
    case kPlane90:
      return planes / 2 + 1;
    case kBothPlanes:
      return planes / 4 + 1;
  }
  return planes;
}

constexpr const char* kSymmetryNames[] = {"none", "round", "plane 0-180", "plane 90-270",
                                          "planes 0-180 and 90-270"};

struct Head {
  Symmetry symmetry = kNone;
  int planes = 0, angles = 0;
};

Head read_head(Lines& in) {
  (void)in.text("the company");
  in.integer("type indicator", 0, 3);
  Head h;
  h.symmetry = static_cast<Symmetry>(in.integer("symmetry indicator", 0, 4));
  h.planes = in.integer("number of C planes", 1, kMaxPlanes);
  const int parts = h.symmetry == kPlane0 ? 2 : h.symmetry >= kPlane90 ? 4 : 1;
  if (h.planes % parts != 0)
    in.fail("the number of C planes must be a multiple of " + std::to_string(parts) +
            " with this symmetry");
  in.number("distance of C planes", 0.0);
  h.angles = in.integer("number of intensities in a plane", 2, kMaxAngles);
  in.number("distance of intensities in a plane", 0.0);
  return h;
}

/// Mirror images must lie where symmetry puts them; the planes need not be equidistant.
void check_planes(const Lines& in, const Head& h, const std::vector<double>& c) {
  if (h.symmetry == kRound) return;
  if (!(c[0] < kSameAngle)) in.fail("the first C plane must be at 0 degrees");
  for (int m = 0; m < h.planes; ++m) {
    const double a = c[static_cast<std::size_t>(m)];
    const double b = c[static_cast<std::size_t>(stored_plane(h.symmetry, m, h.planes))];
    const auto folded = [&](double x) {
      if (h.symmetry == kPlane0 || h.symmetry == kBothPlanes) x = std::min(x, 360.0 - x);
      if (h.symmetry == kPlane90 || h.symmetry == kBothPlanes)
        x = std::abs(std::remainder(x - 90.0, 360.0));
      return x;
    };
    if (!(std::abs(folded(a) - folded(b)) < kSameAngle))
      in.fail("the C planes do not lie as the symmetry indicator says");
  }
}

IntensityProfile unfold(const Head& h, const std::vector<double>& c, std::vector<double> gamma,
                        const std::vector<double>& candela) {
  IntensityProfile profile;
  profile.theta_deg = std::move(gamma);
  const int first = first_plane(h.symmetry, h.planes);
  const int planes = h.symmetry == kRound ? 1 : h.planes;
  for (int m = 0; m <= planes; ++m) {
    if (m == planes && planes == 1) break;  // round: one plane says all
    profile.phi_deg.push_back(m < planes ? c[static_cast<std::size_t>(m)] : 360.0);
    if (planes == 1) profile.phi_deg[0] = 0.0;
    const int plane = stored_plane(h.symmetry, m % planes, h.planes);
    const auto row = candela.begin() +
                     static_cast<std::ptrdiff_t>((plane - first + h.planes) % h.planes) * h.angles;
    profile.candela.insert(profile.candela.end(), row, row + h.angles);
  }
  return profile;
}

}  // namespace

Luminaire read_eulumdat(const std::filesystem::path& file) {
  const std::string text = read_luminaire_text(file);
  Lines in(file.string(), text);
  const Head h = read_head(in);
  (void)in.text("the measurement report");
  Luminaire l;
  l.format = "EULUMDAT";
  l.symmetry = kSymmetryNames[h.symmetry];
  l.name = in.text("the luminaire's name");
  in.skip("number, file and date of the luminaire", 3);
  for (const char* size : {"length", "width", "height"}) in.number(size);
  constexpr double kMillimetre = 1e-3;
  const double length = in.number("length of the luminous area", 0.0) * kMillimetre;
  const double width = in.number("width of the luminous area", 0.0) * kMillimetre;
  l.opening = width > 0.0 ? Vec3d(width, length, 0.0) : Vec3d(length, 0.0, 0.0);
  for (int i = 0; i < 4; ++i)
    l.opening.z() = std::max(l.opening.z(), in.number("height of the luminous area") * kMillimetre);
  in.number("downward flux fraction");
  const double output_ratio = in.number("light output ratio", 0.0) / 100.0;
  if (!(output_ratio <= kMostCandela)) in.fail("light output ratio: too large");
  const double conversion = in.number("conversion factor", 0.0);
  if (!(conversion > 0.0)) in.fail("the conversion factor must be above 0");
  in.number("tilt during measurement");
  const int sets = in.integer("number of sets of lamps", 1, kMaxLampSets);
  double flux = 0.0;
  bool absolute = false;  // a negative number of lamps: the flux is the luminaire's
  for (int i = 0; i < sets; ++i) {
    const double lamps = in.number("number of lamps");
    (void)in.text("type of lamps");
    const double of_set = in.number("flux of lamps", 0.0);
    if (!(of_set <= kMostCandela)) in.fail("flux of lamps: too large");
    in.skip("colour and colour rendering", 2);
    in.number("watts");
    if (i > 0) continue;
    flux = of_set;
    absolute = lamps < 0.0;
  }
  if (!absolute) l.lamp_flux = flux;
  l.stated_flux = flux * output_ratio;
  for (int i = 0; i < 10; ++i) in.number("direct ratio");
  const std::vector<double> c = in.increasing("angle of C planes", h.planes, 360.0 - kSameAngle);
  check_planes(in, h, c);
  std::vector<double> gamma = in.increasing("angle in a C plane", h.angles, 180.0);
  std::vector<double> candela;
  const int count = plane_count(h.symmetry, h.planes) * h.angles;
  const double scale = conversion * flux / 1000.0;  // the table is in cd per 1000 lm of lamps
  for (int i = 0; i < count; ++i) {
    candela.push_back(in.number("intensity", 0.0) * scale);
    if (!(candela.back() <= kMostCandela)) in.fail("intensity times flux and factors: too large");
  }
  l.profile = unfold(h, c, std::move(gamma), candela);
  return l;
}

}  // namespace atrium::scene
