#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "material/optical_constants.h"
#include "material/spectral_value.h"
#include "material/spectrum.h"

namespace atrium::material {

/// What the lanes of a Spectrum mean, and how given spectra become lanes and lanes become RGB.
///
/// Lanes are relative to the D65 white of Rec. 709: a stimulus with the value v in every lane is
/// the RGB (v, v, v). So reflectances are themselves, an RGB emission in nits keeps its numbers,
/// and the illuminance of lanes is the Y of to_rgb(). For wavelength bands,
///   rgb = to_rgb * lanes with to_rgb(c, i) = integral over band i of D65 * cmf, rows sum to 1;
///   lanes = from_rgb * rgb is the smoothest set of non-negative band values with
///   to_rgb * from_rgb = 1 and rows of from_rgb that sum to 1 (white stays white, no energy
///   gained).
class SpectralBasis {
 public:
  enum class Kind { Grey, Rgb, Bands };

  [[nodiscard]] static SpectralBasis grey();
  [[nodiscard]] static SpectralBasis rgb();
  /// \param lanes  4, 8, 16 or 32 bands over 380-730 nm. \throws std::invalid_argument for other
  /// numbers. Edges: near equal shares of D65 * (x_bar + y_bar + z_bar), moved so that the Rec. 709
  /// primaries lie inside the bands' chromaticities; else no from_rgb >= 0 exists. 16 and 32 cut
  /// the 8 bands into equal shares. More than kMaxLanes are computed in packs().
  [[nodiscard]] static SpectralBasis bands(int lanes);

  /// Bases of at most kMaxLanes lanes that share out this one's: each resolves to its part of the
  /// lanes, its to_rgb is those columns, and the RGB of the packs add up to the whole's. So the
  /// RGB of one pack is no colour by itself: white is not (1, 1, 1), channels may be negative. Up
  /// to kMaxLanes lanes: the basis itself.
  [[nodiscard]] std::vector<SpectralBasis> packs() const;

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] int lanes() const { return lanes_; }
  /// Representative vacuum wavelength of each lane [nm]; for RGB the lanes' dominant ones
  /// (612, 549, 465), for grey 555. What index-of-refraction tables are read at in Bands.
  [[nodiscard]] const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }

  /// Reflectance, transmittance, or radiance relative to D65 white. Grey takes the luminance.
  /// Sampled spectra are integrated to RGB, or (Bands) averaged over each band with weight
  /// D65 * (x_bar + y_bar + z_bar); then from_rgb of the colour that the averages miss is added.
  /// Lanes are kept in [0, largest sample]; the colour is that of the 5 nm integration unless that
  /// applies. (Averages alone: illuminant A in 8 bands is off by 0.03 of its luminance; with weight
  /// D65: by 0.23.)
  template <int N>
  [[nodiscard]] Spectrum<N> resolve(const SpectralValue& value) const;

  /// Emission given by samples of spectral radiance [W/(sr m^2 nm)]: lanes in nits, 683 lm/W at
  /// 555 nm. Values that are not sampled are in nits already and resolve as above.
  template <int N>
  [[nodiscard]] Spectrum<N> resolve_emission(const SpectralValue& value) const;

  /// A quantity that must not be mixed over wavelengths (n, k, extinction): sampled at the lane's
  /// wavelength in Bands, averaged over the positive part of the lane's response otherwise.
  template <int N>
  [[nodiscard]] Spectrum<N> resolve_at_wavelength(const SpectralValue& value) const;

  template <int N>
  [[nodiscard]] Rgb to_rgb(const Spectrum<N>& lanes) const;
  template <int N>
  [[nodiscard]] Spectrum<N> from_rgb(const Rgb& rgb) const;

  [[nodiscard]] const Eigen::Matrix<float, 3, Eigen::Dynamic>& to_rgb_matrix() const {
    return to_rgb_;
  }
  [[nodiscard]] const Eigen::Matrix<float, Eigen::Dynamic, 3>& from_rgb_matrix() const {
    return from_rgb_;
  }

  [[nodiscard]] std::string describe() const;  ///< "1 grey lane", "3 RGB lanes", "8 bands ..."

 private:
  SpectralBasis() = default;
  // Lanes of samples relative to D65 on the 5 nm grid, kept in [0, highest].
  [[nodiscard]] Eigen::VectorXd lanes_of(const Eigen::RowVectorXd& samples, double highest) const;

  Kind kind_ = Kind::Grey;
  int lanes_ = 1;
  std::vector<double> wavelengths_nm_;
  std::vector<double> band_edges_nm_;                 // lanes + 1, Bands only
  Eigen::Matrix<float, 3, Eigen::Dynamic> to_rgb_;    // 3 x lanes
  Eigen::Matrix<float, Eigen::Dynamic, 3> from_rgb_;  // lanes x 3
  Eigen::MatrixXd response_;                          // lanes x 5 nm grid, rows sum to 1
  std::shared_ptr<const SpectralBasis> whole_;        // of a pack: what it is part of
  int first_ = 0;                                     // of a pack: its first lane there
};

// ---- inline parts: used per sample ----

template <int N>
Rgb SpectralBasis::to_rgb(const Spectrum<N>& lanes) const {
  if constexpr (N == 1) return Rgb(lanes[0]);
  if constexpr (N == 3) return lanes;
  Rgb c;
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 3; ++k) c[k] += to_rgb_(k, i) * lanes[i];
  return c;
}

template <int N>
Spectrum<N> SpectralBasis::from_rgb(const Rgb& rgb) const {
  if constexpr (N == 1) return Spectrum<N>(luminance(rgb));
  if constexpr (N == 3) return rgb;
  Spectrum<N> s;
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 3; ++k) s[i] += from_rgb_(i, k) * rgb[k];
  return s;
}

}  // namespace atrium::material
