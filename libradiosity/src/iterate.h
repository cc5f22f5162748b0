#pragma once

#include "rows.h"

namespace atrium::radiosity {

struct Iteration {
  int iterations = 0;     ///< applications of the rows
  double residual = 0.0;  ///< last change of radiosity, relative to its maximum
  bool converged = false;
  std::size_t trapped = 0;  ///< sides whose rays all stay in white pockets, see solve_rows()
};

/// Solves I = constant + W (rho (source + I) + tau (source + I)_other side) for the exchange
/// irradiance I of the active sides (E_B where coupled). `result` is the start value; the same rows
/// serve any number of sources and constants.
///
/// Gauss-Seidel sweeps while they get on, then GMRES: where light goes round a hundred times or
/// more, sweeps need as many. Either ends when the estimated error is within
/// SolveOptions::tolerance.
///
/// Any reflectance below 1 has a solution. At 1 the rows' graph decides: sides from which no chain
/// of entries leads to a loss keep all light. If other sides see them, or few rays speak for it, it
/// is a pocket whose opening the rays missed; its rows of n rays count n / (n + 1), the expected
/// share of the next ray to stay (Laplace's rule of succession), and Iteration::trapped says how
/// many sides that concerns.
/// \throws Error  naming materials and objects of a lit closed enclosure of reflectance 1.
template <int N>
Iteration solve_rows(const Problem<N>& problem, const Rows<N>& rows, const SideValues<N>& source,
                     const SideValues<N>& constant, SideValues<N>& result, Work& work);

}  // namespace atrium::radiosity
