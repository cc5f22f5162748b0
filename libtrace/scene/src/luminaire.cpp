#include "scene/luminaire.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "material/error.h"
#include "scene/output_file.h"

namespace atrium::scene {

bool is_luminaire_ending(const std::filesystem::path& file) {
  const std::string ending = file_ending(file);
  return ending == ".ies" || ending == ".ldt";
}

Luminaire read_luminaire(const std::filesystem::path& file) {
  const std::string ending = file_ending(file);
  if (ending == ".ies") return read_ies(file);
  if (ending == ".ldt") return read_eulumdat(file);
  throw Error(file.string() + ": unknown luminaire format (known: .ies .ldt)");
}

double opening_angle(const IntensityProfile& profile, double phi_deg, double share) {
  constexpr int kSteps = 18000;  // of 0.01 degrees to either side of the nadir
  const auto at = [&](int i) {
    const double angle = 0.01 * i;
    return profile.at(std::abs(angle), angle < 0.0 ? phi_deg + 180.0 : phi_deg);
  };
  int brightest = -kSteps;
  for (int i = -kSteps; i <= kSteps; ++i)
    if (at(i) > at(brightest)) brightest = i;
  const double least = share * at(brightest);
  if (!(least > 0.0)) return 0.0;
  // The plane is a circle: a beam upwards goes on beyond 180 degrees.
  const auto around = [&](int i) {
    return at(i > kSteps ? i - 2 * kSteps : i < -kSteps ? i + 2 * kSteps : i);
  };
  int up = brightest;
  int down = brightest;
  while (up - brightest < 2 * kSteps && around(up + 1) >= least) ++up;
  while (brightest - down < 2 * kSteps && around(down - 1) >= least) --down;
  return std::min(360.0, 0.01 * (up - down));
}

}  // namespace atrium::scene
