#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "material/material.h"
#include "material/spectral_basis.h"

namespace atrium::material {

/// A light as far as its colour matters.
struct LightSpectrum {
  std::string name;
  SpectralValue value;          ///< of any scale: relative to D65 (as lanes are), or
  bool spectral_watts = false;  ///< samples of spectral power per wavelength
};

/// Largest difference from the 81-wavelength answer, and what shows it.
struct ColourError {
  double ciede2000 = 0.0;
  std::string cause;  ///< "gold, reflection at 0 deg, light F2, bounce 2"; empty if nothing differs
};

/// Predicts the colour error of computing a scene with few lanes, before it is rendered.
///
/// Each colour a material can show (reflection at 0 and 60 degrees, body, diffuse transmission,
/// 1 cm, 10 cm and 1 m of a solid, a pane at 0 and 60 degrees) is seen in each light once and
/// twice, as `resolve_material` and `to_rgb` make it and as the sum over 380, 385, ..., 780 nm.
/// White is the light itself. Wherever one of the two is sampled the pair counts:
/// - colours given by RGB have the spectrum rgb_reflectance() there, and only count in sampled
///   lights; the light itself counts if it is sampled;
/// - lights given by RGB or number count as D65, which lanes are relative to: they have no spectrum
///   to be right about.
/// Cost: about 0.1 ms per material; nothing is computed if nothing is sampled.
class ColourErrorPredictor {
 public:
  /// \param materials  not null; kept by value.  Lights of one spectral shape count once.
  ColourErrorPredictor(std::vector<const Material*> materials, std::vector<LightSpectrum> lights);
  ColourErrorPredictor(const ColourErrorPredictor&) = delete;  // stimuli_ point into bare_
  ColourErrorPredictor& operator=(const ColourErrorPredictor&) = delete;

  /// Number of colours compared per basis: 0 if neither a material nor a light is sampled.
  [[nodiscard]] std::size_t comparisons() const { return comparisons_; }

  /// Of any basis; more than kMaxLanes lanes are summed over packs().
  [[nodiscard]] ColourError error(const SpectralBasis& basis) const;

  /// What a material can show.
  enum class Aspect {
    Light,
    Reflection0,
    Reflection60,
    Body,
    BodyTransmission,
    Solid1cm,
    Solid10cm,
    Solid1m,
    Pane0,
    Pane60,
    PaneReflection60
  };

 private:
  struct Stimulus {
    const Material* material;  // as given, without what costs time to resolve; null: Light
    Aspect aspect;
    bool sampled;
    Eigen::VectorXd truth;  // at the 81 wavelengths
  };
  struct Light {
    LightSpectrum given;
    bool sampled;
    Eigen::MatrixXd rgb_of;  // 3 x 81: linear RGB of what the light shows, white has luminance 1
    double scale;            // makes lanes of `given` have luminance 1
    Eigen::Vector3d white;   // XYZ
  };
  void add_light(LightSpectrum light);
  void add_material(const Material& material);
  [[nodiscard]] bool compared(const Stimulus& s, const Light& l) const {
    return s.sampled || l.sampled;
  }
  template <int N>
  void add_rgb(const SpectralBasis& pack, Eigen::Matrix3Xd& rgb) const;

  std::vector<Material> bare_;
  std::vector<Stimulus> stimuli_;
  std::vector<Light> lights_;
  std::size_t comparisons_ = 0;
};

/// The answer to "how many lanes".
struct SpectralChoice {
  SpectralBasis basis;
  ColourError error;         ///< predicted, of `basis`
  bool within_bound = true;  ///< false: even 8 bands miss the bound
};

/// The first of RGB, 4 and 8 bands whose predicted error is at most `bound` (CIEDE2000, > 0), else
/// 8 bands. \throws std::invalid_argument for a bound that is not positive.
[[nodiscard]] SpectralChoice cheapest_basis(const ColourErrorPredictor& predictor,
                                            double bound = 1.0);

}  // namespace atrium::material
