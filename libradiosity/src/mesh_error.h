#pragma once

#include "light_places.h"
#include "solvers.h"

namespace atrium::radiosity {

/// Second differences of fields between elements. What linear interpolation misses of a field that
/// is smooth from element to element is about an eighth of them; beside a rim a quarter.
class Bends {
 public:
  /// \param known  by side: which have values.
  Bends(const scene::SurfaceField& layout, std::vector<std::uint8_t> known)
      : neighbours_(edge_neighbours(layout)), known_(std::move(known)) {}

  /// Squared miss of interpolation round a side, free of noise on average: products of halves.
  [[nodiscard]] double squared_miss(const HalfFields& fields, SideIndex i) const;

 private:
  bool beyond(const std::vector<float>& field, SideIndex i, int axis, int end, double& value,
              SideIndex& next) const;
  double bend(const std::vector<float>& field, SideIndex i, int axis, double& value) const;

  std::vector<EdgeNeighbours> neighbours_;
  std::vector<std::uint8_t> known_;
};

/// Squared relative misses of direct light, summed over the area.
struct MeshMiss {
  double between = 0.0;  ///< by second differences between elements
  double within = 0.0;   ///< measured at places, however small what is missed there is
  double within_variance = 0.0;

  /// Of smooth light second differences say the same with far less noise; what places find counts
  /// where it is not that within its noise.
  [[nodiscard]] double squared() const {
    const double difference = within - between;
    const bool noise = difference * difference <= 4.0 * within_variance;
    return std::max(0.0, noise ? between : within);
  }
};

/// What the mesh alone costs, as the RMS of relative errors that docs/radiosity.md (Eq. 8) defines,
/// relative to the irradiance at the place itself. From samples that decided nothing:
///
/// Direct light: pairs of samples at four places inside every lit side against the interpolated
/// halves of `direct`, so that shadows and bright spots smaller than an element count and noise
/// does not. Indirect light: second differences between elements of the halves of `gathered`.
///
/// Not seen: indirect light that varies within an element, and that elements send light on as if
/// they were equally bright all over.
/// \param share  of a side's area that counts. \param mixed  as for sample_direct().
template <int N>
[[nodiscard]] double find_mesh_error(const Problem<N>& problem, const Solution<N>& solution,
                                     const Tally<N>& direct, const Tally<N>& gathered,
                                     const std::vector<float>& share,
                                     const std::vector<std::uint8_t>& mixed, Work& work,
                                     scene::Counters& counters);

}  // namespace atrium::radiosity
