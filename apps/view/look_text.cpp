#include "look_text.h"

#include <algorithm>
#include <cmath>

#include "common/option_values.h"
#include "material/error.h"

namespace atrium::view {
namespace {

constexpr int kMostContours = 100;

[[noreturn]] void fail(const char* option, const std::string& text, const std::string& why) {
  throw Error(std::string(option) + " " + text + ": " + why);
}

std::optional<Vec3d> direction(const std::string& text) {
  if (text == "x") return Vec3d::UnitX();
  if (text == "y") return Vec3d::UnitY();
  if (text == "z") return Vec3d::UnitZ();
  const auto n = app::numbers<3>(text, ',');
  if (!n) return std::nullopt;
  const Vec3d v((*n)[0], (*n)[1], (*n)[2]);
  return v.norm() > 1e-9 ? std::optional(v) : std::nullopt;
}

}  // namespace

std::array<double, 2> parse_range(const std::string& text, bool logarithmic) {
  const auto n = app::numbers<2>(text, ',');
  if (!n || !((*n)[0] < (*n)[1])) fail("--range", text, "is not LOW,HIGH with LOW below HIGH");
  if (logarithmic && !((*n)[0] > 0.0)) fail("--range", text, "a logarithmic range starts above 0");
  return *n;
}

ContourChoice parse_contours(const std::string& text) {
  const std::string why = "is neither a count from 1 to " + std::to_string(kMostContours) +
                          " nor a list of values A,B,C";
  ContourChoice choice;
  if (text.find(',') == std::string::npos) {
    const auto n = app::numbers<1>(text, ' ');
    if (!n || !((*n)[0] >= 1.0 && (*n)[0] <= kMostContours) || (*n)[0] != std::floor((*n)[0]))
      fail("--contours", text, why);
    choice.count = static_cast<int>((*n)[0]);
    return choice;
  }
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const auto n = app::numbers<1>(text.substr(at, end - at), ' ');
    if (!n || choice.levels.size() >= kMostContours) fail("--contours", text, why);
    choice.levels.push_back((*n)[0]);
    at = end + 1;
  }
  std::sort(choice.levels.begin(), choice.levels.end());
  return choice;
}

Clip parse_clip(const std::string& text) {
  const std::size_t sign = text.find_first_of("<>");
  const auto axis = direction(text.substr(0, sign));
  const auto at =
      sign == std::string::npos ? std::nullopt : app::numbers<1>(text.substr(sign + 1), ' ');
  if (!axis || !at)
    fail("--clip", text, "is not what stays, such as y<2.4, x>1 or nx,ny,nz<distance");
  const double factor = (text[sign] == '<' ? 1.0 : -1.0) / axis->norm();
  return {factor * *axis, factor * (*at)[0]};
}

}  // namespace atrium::view
