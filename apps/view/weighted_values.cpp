#include "weighted_values.h"

#include <cmath>

#include "values.h"

namespace atrium::view {

std::vector<Weighted> weighted_values(const Mesh& mesh, const Field& field, ShownSide side,
                                      bool both, const std::vector<std::uint8_t>& polygons) {
  const Values front = numbers_of(mesh, field, Side::Front, false);
  const Values back = side != ShownSide::Front && field.sided
                          ? numbers_of(mesh, field, Side::Back, false)
                          : Values{};
  std::vector<Weighted> values;
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k) {
    if (polygons[k] == 0) continue;
    const auto area = static_cast<double>(mesh.area(k));
    const auto f = static_cast<double>(front.numbers[k]);
    const double b = back.numbers.empty() ? std::nan("") : static_cast<double>(back.numbers[k]);
    if (side == ShownSide::Back && field.sided)
      values.push_back({b, area});
    else if (std::isfinite(f) || !std::isfinite(b))
      values.push_back({f, area});
    if (side == ShownSide::Seen && std::isfinite(b) && (both || !std::isfinite(f)))
      values.push_back({b, area});
  }
  return values;
}

}  // namespace atrium::view
