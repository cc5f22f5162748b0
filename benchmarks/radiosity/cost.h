#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "error_measure.h"
#include "point_reference.h"
#include "variants.h"

namespace atrium::bench {

/// One computation of the irradiance everywhere: what it took and how wrong it is.
struct CostRow {
  std::string variant;
  std::uint64_t rays = 0;        ///< all that were traced
  std::uint64_t receivers = 0;   ///< element sides that got a value
  double cpu = 0.0, wall = 0.0;  ///< [s]
  double memory = 0.0;           ///< peak of the process [MB]; 0: not of interest
  ErrorMeasure patches;          ///< means over patches, by the values of their elements
  ErrorMeasure points;           ///< at points, by the value of the element
  ErrorMeasure interpolated;     ///< ... by interpolation
  /// RMS between two seeds on the same mesh, over sqrt(2): the part that more rays take away. Rows
  /// only.
  double statistical = 0.0;
  double statistical_absolute = 0.0;  ///< RMS of the differences over RMS of the values
  double estimate = 0.0;              ///< by the solver itself; 0: makes none
  std::string stopped_by;
};

/// One method with growing effort.
struct CostSeries {
  std::string name;
  std::vector<CostRow> rows;
};

/// Receivers with their reference.
struct Judges {
  std::vector<Receiver> receivers;
  PointValues reference;
};

/// Solves, rows with two seeds; cost is that of the first.
[[nodiscard]] CostRow solve_cost(const Workload& workload, const Judges& patches,
                                 const Judges& points, const Variant& variant);

/// Path tracing of every receiver: measured at the given ones, cost scaled to `sides` of them.
[[nodiscard]] CostRow path_cost(const Workload& workload, const Judges& patches,
                                std::uint32_t paths, std::uint64_t sides);

/// Which number of a row counts as its error.
enum class ErrorKind { Total, Statistical };
[[nodiscard]] double error_of(const CostRow& row, ErrorKind kind);
/// Which as its cost.
enum class CostKind { Rays, Cpu };
[[nodiscard]] double cost_of(const CostRow& row, CostKind kind);

/// Cost at which a series gets to an error, by linear interpolation of the logarithms between
/// neighbouring rows; 0 if it never does. What the first row undercuts costs at most as much as it.
[[nodiscard]] double cost_to(const CostSeries& series, double error, ErrorKind kind, CostKind cost);

}  // namespace atrium::bench
