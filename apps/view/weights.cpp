#include "weights.h"

#include <algorithm>

#include "common/suggest.h"
#include "fields.h"
#include "material/error.h"
#include "scene/parallel.h"

namespace atrium::view {
namespace {

constexpr std::size_t kGrain = 65536;

/// Sum of the groups' arrays into that of a side; nothing if one of them is missing.
void add_up(std::vector<Array>& arrays, const std::string& quantity, bool back,
            const std::vector<std::string>& groups, const std::vector<double>& factors) {
  Array* sum = find_array(arrays, back ? quantity + "_back" : quantity);
  if (sum == nullptr) return;
  std::vector<std::pair<const float*, float>> parts;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Array* part = find_group_array(arrays, quantity, back, groups[g]);
    if (part == nullptr || part->values.size() != sum->values.size()) return;
    parts.emplace_back(part->values.data(), static_cast<float>(factors[g]));
  }
  scene::parallel_for(sum->values.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      float v = 0.0f;
      for (const auto& [values, factor] : parts) v += factor * values[i];
      sum->values[i] = v;
    }
  });
}

void update_lux(std::vector<Array>& arrays, double lux_per_unit) {
  Array* lux = find_array(arrays, "illuminance_lux");
  const Array* e = find_array(std::as_const(arrays), "irradiance");
  if (lux == nullptr || e == nullptr || e->components != 3) return;
  for (std::size_t i = 0; i < lux->values.size(); ++i)
    lux->values[i] = static_cast<float>(lux_per_unit) * luminance_at(&e->values[3 * i]);
}

}  // namespace

Weights::Weights(const Mesh& mesh)
    : groups_(light_groups_of(mesh)), factors_(groups_.size(), 1.0) {}

bool Weights::as_solved() const {
  return std::all_of(factors_.begin(), factors_.end(), [](double f) { return f == 1.0; });
}

void Weights::set(const std::string& group, double factor) {
  const auto it = std::find(groups_.begin(), groups_.end(), group);
  if (it != groups_.end()) {
    factors_[static_cast<std::size_t>(it - groups_.begin())] = factor;
    return;
  }
  const std::vector<std::string_view> known(groups_.begin(), groups_.end());
  throw Error("--weights " + group + ": no such light group" +
              (known.empty() ? "; the solution has one only" : app::suggestion(group, known)));
}

void Weights::apply(Mesh& mesh) const {
  if (groups_.empty()) return;
  for (auto* arrays : {&mesh.polygons.cell_arrays, &mesh.polygons.point_arrays}) {
    for (const char* quantity : {"irradiance", "radiosity"})
      for (const bool back : {false, true}) add_up(*arrays, quantity, back, groups_, factors_);
    update_lux(*arrays, mesh.lux_per_unit);
  }
}

}  // namespace atrium::view
