#include "scene/light_groups.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "material/error.h"

namespace atrium::scene {
namespace {

struct KindName {
  std::string operator()(const PointLight&) const { return "point"; }
  std::string operator()(const SpotLight&) const { return "spot"; }
  std::string operator()(const DirectionalLight&) const { return "directional"; }
  std::string operator()(const ProfileLight&) const { return "luminaire"; }
};

/// The first name that is not empty.
std::string first_of(const std::string& a, const std::string& b, const std::string& c) {
  return !a.empty() ? a : !b.empty() ? b : c;
}

class GroupFinder {
 public:
  explicit GroupFinder(Grouping grouping) : grouping_(grouping) {}

  void add(const std::string& declared, const std::string& name, const std::string& kind) {
    any_declared_ = any_declared_ || !declared.empty();
    const std::string group = grouping_ == Grouping::ByName ? first_of(declared, name, kind)
                                                            : first_of(declared, "other", "");
    const auto known = std::find(groups_.names.begin(), groups_.names.end(), group);
    groups_.group.push_back(static_cast<std::uint32_t>(known - groups_.names.begin()));
    if (known == groups_.names.end()) groups_.names.push_back(group);
  }
  void add_dark() { groups_.group.push_back(0); }

  LightGroups finish() {
    if (groups_.names.empty() || (grouping_ == Grouping::Declared && !any_declared_))
      groups_.names = {"all"};
    if (groups_.size() > kMostLightGroups)
      throw Error("light groups: " + std::to_string(groups_.size()) + " are too many (at most " +
                  std::to_string(kMostLightGroups) + "); put lights together by light_group");
    return std::move(groups_);
  }

 private:
  Grouping grouping_;
  bool any_declared_ = false;
  LightGroups groups_;
};

void add_scaled(std::vector<float>& sum, const std::vector<float>& part, float factor) {
  if (part.empty()) return;
  if (sum.empty()) sum.assign(part.size(), 0.0f);
  if (sum.size() != part.size()) throw std::invalid_argument("reweight: groups of several sizes");
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * part[i];
}

void add_scaled(SurfaceField::Quantities& sum, const SurfaceField::Quantities& part, float factor) {
  add_scaled(sum.direct, part.direct, factor);
  add_scaled(sum.caustic, part.caustic, factor);
  add_scaled(sum.indirect, part.indirect, factor);
}

}  // namespace

LightGroups find_light_groups(const Scene& scene, Grouping grouping) {
  if (grouping == Grouping::One)
    return {{"all"}, std::vector<std::uint32_t>(environment_source(scene) + 1, 0)};
  GroupFinder finder(grouping);
  for (const Light& light : scene.lights)
    finder.add(light.light_group, light.name, std::visit(KindName{}, light.kind));
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (scene.material_of(ObjectId(o)).emissive())
      finder.add(object.light_group, object.name, "emitter");
    else
      finder.add_dark();
  }
  if (scene.environment) {
    const bool sky = std::holds_alternative<SkyDome>(scene.environment->pattern);
    finder.add(scene.environment->light_group, "", sky ? "sky" : "environment");
  } else {
    finder.add_dark();
  }
  return finder.finish();
}

SurfaceField reweight(const SurfaceField& layout, std::span<const GroupField> groups,
                      std::span<const double> factors) {
  if (groups.size() != factors.size())
    throw std::invalid_argument("reweight: as many factors as groups are needed");
  for (const double f : factors)
    if (!(f >= 0.0 && std::isfinite(f)))
      throw std::invalid_argument("reweight: a factor must be at least 0");
  SurfaceField field = layout;
  field.irradiance = {};
  field.body_irradiance = {};
  std::vector<double> squares(layout.element_count() * 2, 0.0);
  std::vector<double> sums(squares.size(), 0.0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const GroupField& part = groups[g];
    add_scaled(field.irradiance, part.irradiance, static_cast<float>(factors[g]));
    add_scaled(field.body_irradiance, part.body_irradiance, static_cast<float>(factors[g]));
    if (part.light_error.size() != squares.size() || part.indirect_error.size() != squares.size())
      throw std::invalid_argument("reweight: groups of several sizes");
    for (std::size_t i = 0; i < squares.size(); ++i) {
      squares[i] += std::pow(factors[g] * static_cast<double>(part.light_error[i]), 2);
      sums[i] += factors[g] * static_cast<double>(part.indirect_error[i]);
    }
  }
  field.standard_error.resize(squares.size());
  for (std::size_t i = 0; i < squares.size(); ++i)
    field.standard_error[i] = static_cast<float>(std::sqrt(squares[i] + sums[i] * sums[i]));
  return field;
}

}  // namespace atrium::scene
