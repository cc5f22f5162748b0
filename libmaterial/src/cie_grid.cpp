#include "cie_grid.h"

#include <algorithm>
#include <cmath>

#include "material/cie.h"

namespace atrium::material {
namespace {

using Row = Eigen::RowVectorXd;

Eigen::Index cells() { return static_cast<Eigen::Index>(grid_nm().size()); }

double node(Eigen::Index j) { return grid_nm()[static_cast<std::size_t>(j)]; }

// Integral over [lo, hi] of a(nm) b(nm) weight(nm), weight linear there. Between the breakpoints of
// both spectra this is a cubic: Simpson's rule is exact.
template <class Weight>
double integral_of_product(const SampledSpectrum& a, const SampledSpectrum& b, double lo, double hi,
                           Weight&& weight) {
  const auto value = [&](double nm) { return a.at(nm) * b.at(nm) * weight(nm); };
  auto next_a = std::upper_bound(a.wavelength_nm.begin(), a.wavelength_nm.end(), lo);
  auto next_b = std::upper_bound(b.wavelength_nm.begin(), b.wavelength_nm.end(), lo);
  double sum = 0.0;
  double left = lo;
  while (left < hi) {
    double right = hi;
    if (next_a != a.wavelength_nm.end()) right = std::min(right, *next_a);
    if (next_b != b.wavelength_nm.end()) right = std::min(right, *next_b);
    sum += (right - left) / 6.0 * (value(left) + 4.0 * value(0.5 * (left + right)) + value(right));
    if (next_a != a.wavelength_nm.end() && *next_a <= right) ++next_a;
    if (next_b != b.wavelength_nm.end() && *next_b <= right) ++next_b;
    left = right;
  }
  return sum;
}

}  // namespace

const std::vector<double>& grid_nm() { return cie_y_bar().wavelength_nm; }

Row on_grid(const SampledSpectrum& s) {
  Row row(cells());
  for (Eigen::Index j = 0; j < row.size(); ++j) row[j] = s.at(node(j));
  return row;
}

bool finer_than_grid(const SampledSpectrum& s) {
  for (std::size_t i = 1; i < s.wavelength_nm.size(); ++i)
    if (s.wavelength_nm[i] - s.wavelength_nm[i - 1] < kGridStepNm - 1e-9) return true;
  return false;
}

double integral(const SampledSpectrum& s, double lo, double hi) {
  double sum = 0.0;
  double left = lo;
  auto next = std::upper_bound(s.wavelength_nm.begin(), s.wavelength_nm.end(), lo);
  while (left < hi) {
    const double right = next != s.wavelength_nm.end() ? std::min(hi, *next++) : hi;
    sum += 0.5 * (right - left) * (s.at(left) + s.at(right));
    left = right;
  }
  return sum;
}

Row resample(const SampledSpectrum& s) {
  if (!finer_than_grid(s)) return on_grid(s);
  Row row(cells());
  for (Eigen::Index j = 0; j < row.size(); ++j)
    row[j] = integral(s, node(j) - 2.5, node(j) + 2.5) / kGridStepNm;
  return row;
}

Row seen_product(const SampledSpectrum& a, const SampledSpectrum& b) {
  if (!finer_than_grid(a) && !finer_than_grid(b)) return on_grid(a).cwiseProduct(on_grid(b));
  Row row(cells());
  for (Eigen::Index j = 0; j < row.size(); ++j) {
    const double nm = node(j);
    const auto hat = [nm](double at) { return 1.0 - std::abs(at - nm) / kGridStepNm; };
    row[j] = (integral_of_product(a, b, nm - kGridStepNm, nm, hat) +
              integral_of_product(a, b, nm, nm + kGridStepNm, hat)) /
             kGridStepNm;
  }
  return row;
}

const Row& d65_on_grid() {
  static const Row row = on_grid(*find_illuminant("D65"));
  return row;
}

const Eigen::MatrixXd& matching_on_grid() {
  static const Eigen::MatrixXd matrix = [] {
    Eigen::MatrixXd xyz(3, cells());
    xyz << on_grid(cie_x_bar()), on_grid(cie_y_bar()), on_grid(cie_z_bar());
    return xyz;
  }();
  return matrix;
}

const Eigen::MatrixXd& rgb_matching_on_grid() {
  static const Eigen::MatrixXd matrix = rgb_from_xyz() * matching_on_grid();
  return matrix;
}

const Eigen::MatrixXd& rgb_response() {
  static const Eigen::MatrixXd response = [] {
    Eigen::MatrixXd m = rgb_matching_on_grid() * d65_on_grid().asDiagonal();
    for (Eigen::Index r = 0; r < 3; ++r) m.row(r) /= m.row(r).sum();
    return m;
  }();
  return response;
}

}  // namespace atrium::material
