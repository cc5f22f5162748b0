#include "material/spectral_basis.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "band_upsampling.h"
#include "cie_grid.h"
#include "material/cie.h"

namespace atrium::material {
namespace {

using Row = Eigen::RowVectorXd;

// Band edges [nm]: near equal shares of D65 * (x_bar + y_bar + z_bar), moved so that the triangle
// of the Rec. 709 primaries lies inside the chromaticities of the bands; without that no
// non-negative band values reproduce every colour. The four were chosen for the smallest errors of
// lamps and metals among the 56 sets of edges on the grid that allow it.
constexpr double kEdges4[] = {380.0, 475.0, 510.0, 590.0, 730.0};
constexpr double kEdges8[] = {380.0, 440.0, 465.0, 490.0, 530.0, 560.0, 590.0, 615.0, 730.0};

const Row& d65() { return d65_on_grid(); }

// What the edges share out: D65 * (x_bar + y_bar + z_bar).
Row seen() {
  return d65().cwiseProduct(on_grid(cie_x_bar()) + on_grid(cie_y_bar()) + on_grid(cie_z_bar()));
}

// Share of each grid cell (5 nm round its node) that lies in [lo, hi].
Row overlap(double lo, double hi) {
  Row share(d65().size());
  for (Eigen::Index j = 0; j < share.size(); ++j) {
    const double nm = grid_nm()[static_cast<std::size_t>(j)];
    share[j] = std::max(0.0, std::min(hi, nm + 2.5) - std::max(lo, nm - 2.5)) / 5.0;
  }
  return share;
}

// Every band cut in two at the whole nanometre that shares out what it sees most evenly. Halves
// with equal values are the band again, so non-negative values for every colour still exist.
std::vector<double> halved(const std::vector<double>& edges) {
  const Row weight = seen();
  std::vector<double> finer = {edges.front()};
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    double best = 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (int nm = 1; edges[i] + nm < edges[i + 1]; ++nm) {
      const double cut = edges[i] + nm;
      const double left = overlap(edges[i], cut).dot(weight);
      const double right = overlap(cut, edges[i + 1]).dot(weight);
      if (std::abs(left - right) >= least) continue;
      least = std::abs(left - right);
      best = cut;
    }
    finer.push_back(best);
    finer.push_back(edges[i + 1]);
  }
  return finer;
}

std::vector<double> edges_of(int lanes) {
  if (lanes == 4) return {std::begin(kEdges4), std::end(kEdges4)};
  std::vector<double> edges(std::begin(kEdges8), std::end(kEdges8));
  for (int n = 8; n < lanes; n *= 2) edges = halved(edges);
  return edges;
}

// Rounds to float and gives the rounding to the largest entry of each row, so that the row still
// sums to 1 (to one unit in the last place).
template <class FloatMatrix>
FloatMatrix rows_sum_to_one(const Eigen::MatrixXd& exact) {
  FloatMatrix m = exact.cast<float>();
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    Eigen::Index largest = 0;
    m.row(r).maxCoeff(&largest);
    for (int pass = 0; pass < 2; ++pass) {
      float sum = 0.0f;
      for (Eigen::Index c = 0; c < m.cols(); ++c) sum += m(r, c);
      m(r, largest) += 1.0f - sum;
    }
  }
  return m;
}

}  // namespace

SpectralBasis SpectralBasis::grey() {
  SpectralBasis basis;
  basis.kind_ = Kind::Grey;
  basis.lanes_ = 1;
  basis.wavelengths_nm_ = {555.0};
  basis.to_rgb_ = Eigen::Matrix<float, 3, Eigen::Dynamic>::Ones(3, 1);
  basis.from_rgb_.resize(1, 3);
  basis.from_rgb_ << 0.2126f, 0.7152f, 0.0722f;
  basis.response_ = d65().cwiseProduct(on_grid(cie_y_bar()));
  basis.response_ /= basis.response_.sum();
  return basis;
}

SpectralBasis SpectralBasis::rgb() {
  SpectralBasis basis;
  basis.kind_ = Kind::Rgb;
  basis.lanes_ = 3;
  basis.wavelengths_nm_ = {612.0, 549.0, 465.0};
  basis.to_rgb_ = Eigen::Matrix<float, 3, Eigen::Dynamic>::Identity(3, 3);
  basis.from_rgb_ = Eigen::Matrix<float, Eigen::Dynamic, 3>::Identity(3, 3);
  basis.response_ = rgb_response();
  return basis;
}

SpectralBasis SpectralBasis::bands(int lanes) {
  if (lanes != 4 && lanes != 8 && lanes != 16 && lanes != 32)
    throw std::invalid_argument("SpectralBasis::bands: lanes is " + std::to_string(lanes) +
                                ", must be 4, 8, 16 or 32");
  SpectralBasis basis;
  basis.kind_ = Kind::Bands;
  basis.lanes_ = lanes;
  basis.band_edges_nm_ = edges_of(lanes);
  basis.response_.resize(lanes, d65().size());
  const Eigen::MatrixXd light = rgb_matching_on_grid() * d65().asDiagonal();
  const Row sensitivity = seen();
  Eigen::MatrixXd to_rgb(3, lanes);
  for (int i = 0; i < lanes; ++i) {
    const auto band = static_cast<std::size_t>(i);
    const Row share = overlap(basis.band_edges_nm_[band], basis.band_edges_nm_[band + 1]);
    to_rgb.col(i) = light * share.transpose();
    const Row weight = share.cwiseProduct(sensitivity);
    basis.response_.row(i) = weight / weight.sum();
    const Row nm = Eigen::Map<const Row>(grid_nm().data(), share.size());
    basis.wavelengths_nm_.push_back(weight.dot(nm) / weight.sum());
  }
  for (Eigen::Index r = 0; r < 3; ++r) to_rgb.row(r) /= to_rgb.row(r).sum();
  basis.to_rgb_ = rows_sum_to_one<Eigen::Matrix<float, 3, Eigen::Dynamic>>(to_rgb);
  basis.from_rgb_ = rows_sum_to_one<Eigen::Matrix<float, Eigen::Dynamic, 3>>(
      smoothest_bands(to_rgb, basis.wavelengths_nm_));
  return basis;
}

std::vector<SpectralBasis> SpectralBasis::packs() const {
  if (lanes_ <= kMaxLanes) return {*this};
  const auto whole = std::make_shared<const SpectralBasis>(*this);
  std::vector<SpectralBasis> packs;
  for (int first = 0; first < lanes_; first += kMaxLanes) {
    SpectralBasis pack;
    pack.kind_ = kind_;
    pack.lanes_ = kMaxLanes;
    pack.whole_ = whole;
    pack.first_ = first;
    const auto nm = wavelengths_nm_.begin() + first;
    const auto edge = band_edges_nm_.begin() + first;
    pack.wavelengths_nm_.assign(nm, nm + kMaxLanes);
    pack.band_edges_nm_.assign(edge, edge + kMaxLanes + 1);
    pack.to_rgb_ = to_rgb_.middleCols(first, kMaxLanes);
    pack.from_rgb_ = from_rgb_.middleRows(first, kMaxLanes);
    pack.response_ = response_.middleRows(first, kMaxLanes);
    packs.push_back(std::move(pack));
  }
  return packs;
}

Eigen::VectorXd SpectralBasis::lanes_of(const Eigen::RowVectorXd& samples, double highest) const {
  // The colour that band means miss is shared out over all packs.
  if (whole_) return whole_->lanes_of(samples, highest).segment(first_, lanes_);
  Eigen::VectorXd lane = response_ * samples.transpose();
  if (kind_ == Kind::Bands) {
    // Band means shift the colour; the smooth spectrum of what is missing is added.
    const Eigen::Vector3d missing =
        rgb_response() * samples.transpose() - to_rgb_.cast<double>() * lane;
    lane += from_rgb_.cast<double>() * missing;
  }
  return lane.cwiseMax(0.0).cwiseMin(highest);
}

template <int N>
Spectrum<N> SpectralBasis::resolve(const SpectralValue& value) const {
  assert(N == lanes_);
  if (const auto* number = std::get_if<double>(&value))
    return Spectrum<N>(static_cast<float>(*number));
  if (const auto* rgb_value = std::get_if<Rgb>(&value)) return from_rgb<N>(*rgb_value);
  const Row samples = resample(std::get<SampledSpectrum>(value));
  const Eigen::VectorXd lane = lanes_of(samples, std::max(0.0, samples.maxCoeff()));
  return Spectrum<N>::generate([&](int i) { return lane[i]; });
}

template <int N>
Spectrum<N> SpectralBasis::resolve_emission(const SpectralValue& value) const {
  assert(N == lanes_);
  const auto* sampled = std::get_if<SampledSpectrum>(&value);
  if (sampled == nullptr) return resolve<N>(value);
  // Light of one nit in every lane is D65 / (683 * integral of D65 * y_bar).
  const double white = 5.0 * kMaxLuminousEfficacy * d65().dot(on_grid(cie_y_bar()));
  const Row relative = resample(*sampled).cwiseQuotient(d65());
  const Eigen::VectorXd lane = lanes_of(white * relative, std::numeric_limits<double>::infinity());
  return Spectrum<N>::generate([&](int i) { return lane[i]; });
}

template <int N>
Spectrum<N> SpectralBasis::resolve_at_wavelength(const SpectralValue& value) const {
  assert(N == lanes_);
  const auto* sampled = std::get_if<SampledSpectrum>(&value);
  if (sampled == nullptr) return resolve<N>(value);
  if (kind_ == Kind::Bands)
    return Spectrum<N>::generate(
        [&](int i) { return sampled->at(wavelengths_nm_[static_cast<std::size_t>(i)]); });
  // Negative parts of a response are left out: the mean of an index stays inside its range.
  const Row values = resample(*sampled);
  return Spectrum<N>::generate([&](int i) {
    const Row weight = response_.row(i).cwiseMax(0.0);
    return weight.dot(values) / weight.sum();
  });
}

std::string SpectralBasis::describe() const {
  switch (kind_) {
    case Kind::Grey:
      return "1 grey lane";
    case Kind::Rgb:
      return "3 RGB lanes";
    case Kind::Bands:
      break;
  }
  std::string text = std::to_string(lanes_);
  if (whole_) text += " of " + std::to_string(whole_->lanes_);
  text += " wavelength bands, edges";
  for (const double nm : band_edges_nm_) text.append(" ").append(std::to_string(std::lround(nm)));
  return text + " nm";
}

#define ATRIUM_INSTANTIATE(N)                                                          \
  template Spectrum<N> SpectralBasis::resolve<N>(const SpectralValue&) const;          \
  template Spectrum<N> SpectralBasis::resolve_emission<N>(const SpectralValue&) const; \
  template Spectrum<N> SpectralBasis::resolve_at_wavelength<N>(const SpectralValue&) const;
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::material
