#include "validation/solution.h"

#include <span>
#include <stdexcept>

namespace atrium::validation {

Solution::Solution(scene::Scene scene, const radiosity::SolveOptions& options)
    : scene_(std::move(scene)),
      query_(scene_),
      result_(radiosity::solve(query_, material::SpectralBasis::grey(), options)) {}

double Solution::irradiance(std::size_t element, Part part, scene::Side side) const {
  const scene::SurfaceField::Quantities& e = result_.field.irradiance;
  const std::size_t i = element * 2 + static_cast<std::size_t>(side);
  const auto at = [i](const std::vector<float>& a) {
    return a.empty() ? 0.0 : static_cast<double>(a[i]);
  };
  switch (part) {
    case Part::Direct:
      return at(e.direct);
    case Part::Indirect:
      return at(e.indirect);
    case Part::Total:
      break;
  }
  return at(e.direct) + at(e.caustic) + at(e.indirect);
}

const std::string& Solution::object_name(std::size_t element) const {
  const radiosity::Elements& e = result_.elements;
  return scene_.objects[e.pieces[e.first_piece[element]].object.value].name;
}

Vec3d Solution::centre(std::size_t element) const {
  const radiosity::Elements& e = result_.elements;
  Vec3d sum = Vec3d::Zero();
  double weight = 0.0;
  for (std::uint32_t p = e.first_piece[element]; p < e.first_piece[element + 1]; ++p) {
    const auto& piece = e.pieces[p];
    const std::span<const Vec3f> c = piece.corners;
    for (std::size_t k = 1; k + 1 < c.size(); ++k) {
      const Vec3d a = c[0].cast<double>(), b = c[k].cast<double>(), d = c[k + 1].cast<double>();
      const double twice_area = (b - a).cross(d - a).norm();
      sum += twice_area / 3.0 * (a + b + d);
      weight += twice_area;
    }
  }
  return sum / weight + scene_.origin;
}

Solution::Sum Solution::sum(const std::string& name, Part part, scene::Side side) const {
  Sum s;
  for (std::size_t e = 0; e < element_count(); ++e) {
    if (!object_name(e).starts_with(name)) continue;
    s.flux += area(e) * irradiance(e, part, side);
    s.area += area(e);
  }
  if (!(s.area > 0.0)) throw std::logic_error("no elements on surfaces '" + name + "'");
  return s;
}

}  // namespace atrium::validation
