#pragma once

#include <string>

#include "radiosity/solve.h"

namespace atrium::validation {

/// A grey scene with its solution.
class Solution {
 public:
  Solution(scene::Scene scene, const radiosity::SolveOptions& options);
  Solution(const Solution&) = delete;
  Solution& operator=(const Solution&) = delete;

  [[nodiscard]] const scene::Scene& scene() const { return scene_; }
  [[nodiscard]] const scene::RayQuery& query() const { return query_; }
  [[nodiscard]] const radiosity::SolveResult& result() const { return result_; }

  /// Irradiance by where it comes from.
  enum class Part { Direct, Indirect, Total };
  [[nodiscard]] double irradiance(std::size_t element, Part part,
                                  scene::Side side = scene::Side::Front) const;
  [[nodiscard]] double area(std::size_t element) const {
    return static_cast<double>(result_.field.element_area[element]);
  }
  [[nodiscard]] std::size_t element_count() const { return result_.field.element_count(); }
  [[nodiscard]] const std::string& object_name(std::size_t element) const;
  [[nodiscard]] Vec3d centre(std::size_t element) const;  ///< in the coordinates of the model

  /// Flux that arrives at the surfaces whose names begin with `name`, and their area.
  struct Sum {
    double flux = 0.0, area = 0.0;
    [[nodiscard]] double mean() const { return flux / area; }
  };
  [[nodiscard]] Sum sum(const std::string& name, Part part,
                        scene::Side side = scene::Side::Front) const;
  [[nodiscard]] double mean(const std::string& name, Part part,
                            scene::Side side = scene::Side::Front) const {
    return sum(name, part, side).mean();
  }

 private:
  scene::Scene scene_;
  scene::RayQuery query_;
  radiosity::SolveResult result_;
};

}  // namespace atrium::validation
