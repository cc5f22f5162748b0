#include "material/spectral_basis.h"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include "material/cie.h"
#include "material/fresnel.h"

namespace atrium::material {
namespace {

// Largest difference of two colours over the channels.
double distance(const Rgb& a, const Eigen::Vector3d& b) {
  double worst = 0.0;
  for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(static_cast<double>(a[c]) - b[c]));
  return worst;
}

SampledSpectrum metal_reflectance(const OpticalConstants& metal) {
  SampledSpectrum f = metal.n;
  for (std::size_t i = 0; i < f.value.size(); ++i)
    f.value[i] = fresnel(1.0, metal.n.value[i], metal.k.value[i]).mean();
  return f;
}

// Second method: the CIE's sum over the 5 nm grid, divided by the white's so that 1 is (1, 1, 1).
Eigen::Vector3d exact_rgb(const SampledSpectrum& reflectance) {
  const SampledSpectrum one = make_sampled_spectrum({360.0}, {1.0});
  const SampledSpectrum& d65 = *find_illuminant("D65");
  const Eigen::Vector3d white = rgb_from_xyz() * xyz_of_reflectance(one, d65);
  const Eigen::Vector3d rgb = rgb_from_xyz() * xyz_of_reflectance(reflectance, d65);
  return rgb.cwiseQuotient(white);
}

Eigen::Vector3d nits_of(const SampledSpectrum& radiance) {
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  for (double nm = 360.0; nm <= 830.0; nm += 5.0)
    xyz += 5.0 * 683.0 * radiance.at(nm) *
           Eigen::Vector3d(cie_x_bar().at(nm), cie_y_bar().at(nm), cie_z_bar().at(nm));
  return rgb_from_xyz() * xyz;
}

template <int N>
void check_white_and_round_trips(const SpectralBasis& basis) {
  SCOPED_TRACE(basis.describe());
  ASSERT_EQ(basis.lanes(), N);
  EXPECT_EQ(basis.wavelengths_nm().size(), static_cast<std::size_t>(N));
  // White: a number, a constant spectrum and the RGB white are 1 in every lane and (1, 1, 1) back.
  const SpectralValue whites[] = {1.0, make_rgb(1.0, 1.0, 1.0),
                                  make_sampled_spectrum({400.0, 700.0}, {1.0, 1.0})};
  for (const SpectralValue& white : whites) {
    const Spectrum<N> lanes = basis.resolve<N>(white);
    for (int i = 0; i < N; ++i) EXPECT_NEAR(lanes[i], 1.0f, 3e-7f);
    EXPECT_LT(distance(basis.to_rgb(lanes), Eigen::Vector3d::Ones()), 1e-6);
  }
  // Light of one spectral shape, D65: lanes are equal, and luminance is 683 * integral of V L.
  const SampledSpectrum& d65 = *find_illuminant("D65");
  const Spectrum<N> light = basis.resolve_emission<N>(d65);
  const double nits = (xyz_from_rgb() * nits_of(d65)).y();
  for (int i = 0; i < N; ++i) EXPECT_NEAR(static_cast<double>(light[i]) / nits, 1.0, 1e-6);
}

TEST(SpectralBasis, WhiteIsOneInEveryLane) {
  check_white_and_round_trips<1>(SpectralBasis::grey());
  check_white_and_round_trips<3>(SpectralBasis::rgb());
  check_white_and_round_trips<4>(SpectralBasis::bands(4));
  check_white_and_round_trips<8>(SpectralBasis::bands(8));
  for (const int lanes : {-1, 0, 1, 3, 5, 12, 64})
    EXPECT_THROW((void)SpectralBasis::bands(lanes), std::invalid_argument) << lanes;
}

// from_rgb is non-negative, its rows and those of to_rgb sum to 1 in float, and the product is the
// identity: every RGB in [0, 1] gives band values in [0, 1] and comes back.
TEST(SpectralBasis, BandMatricesAreStochasticAndInverse) {
  for (const int lanes : {4, 8, 16, 32}) {
    SCOPED_TRACE(lanes);
    const SpectralBasis basis = SpectralBasis::bands(lanes);
    const auto& t = basis.to_rgb_matrix();
    const auto& s = basis.from_rgb_matrix();
    EXPECT_GE(s.minCoeff(), 0.0f);
    EXPECT_LE(s.maxCoeff(), 1.0f);
    for (int c = 0; c < 3; ++c) {
      float sum = 0.0f;
      for (int i = 0; i < lanes; ++i) sum += t(c, i);
      EXPECT_NEAR(sum, 1.0f, 1.2e-7f);  // one unit in the last place
    }
    for (int i = 0; i < lanes; ++i) EXPECT_NEAR(s(i, 0) + s(i, 1) + s(i, 2), 1.0f, 1.2e-7f);
    EXPECT_LT((t * s - Eigen::Matrix3f::Identity()).cwiseAbs().maxCoeff(), 1e-6f);
  }
}

template <int N>
void check_rgb_cube(const SpectralBasis& basis) {
  SCOPED_TRACE(basis.describe());
  std::mt19937 random(5);
  std::uniform_real_distribution<float> u(0.0f, 1.0f);
  float low = 1.0f, high = 0.0f;
  for (int i = 0; i < 500; ++i) {
    Rgb c = Rgb::generate([&](int) { return u(random); });
    if (i < 8) c = make_rgb(i & 1, (i >> 1) & 1, i >> 2);  // the corners are the extremes
    const Spectrum<N> lanes = basis.resolve<N>(c);
    low = std::min(low, lanes.min());
    high = std::max(high, lanes.max());
    EXPECT_LT(distance(basis.to_rgb(lanes), Eigen::Vector3d(c[0], c[1], c[2])), 1e-6);
  }
  EXPECT_GE(low, 0.0f);
  EXPECT_LE(high, 1.0f + 1e-6f);
}

TEST(SpectralBasis, RgbReflectancesStayReflectancesAndRoundTrip) {
  check_rgb_cube<3>(SpectralBasis::rgb());
  check_rgb_cube<4>(SpectralBasis::bands(4));
  check_rgb_cube<8>(SpectralBasis::bands(8));
}

// Optimality (Karush, Kuhn, Tucker) of the smoothest band values: with H the matrix of squared
// steps over wavelength steps, H x is a combination of the equations' gradients wherever x > 0, and
// what remains where x = 0 pushes against the bound.
template <int N>
void check_smoothest(const SpectralBasis& basis) {
  const Eigen::MatrixXd t = basis.to_rgb_matrix().cast<double>();
  const Eigen::MatrixXd s = basis.from_rgb_matrix().cast<double>();
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(N, N);
  for (int i = 0; i + 1 < N; ++i) {
    const auto j = static_cast<std::size_t>(i);
    const double w = 100.0 / (basis.wavelengths_nm()[j + 1] - basis.wavelengths_nm()[j]);
    h.block<2, 2>(i, i) += w * (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
  }
  const Eigen::VectorXd gradient = (h * s).reshaped();
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(9 + N, 3 * N);
  for (int c = 0; c < 3; ++c) {
    equations.block(3 * c, N * c, 3, N) = t;
    equations.block(9, N * c, N, N).setIdentity();
  }
  std::vector<int> free, bound;
  for (int i = 0; i < 3 * N; ++i) (s.reshaped()[i] > 1e-6 ? free : bound).push_back(i);
  const Eigen::MatrixXd on_free = equations(Eigen::all, free).transpose();
  const Eigen::VectorXd multipliers =
      on_free.completeOrthogonalDecomposition().solve(gradient(free));
  const Eigen::VectorXd rest = gradient - equations.transpose() * multipliers;
  EXPECT_LT(rest(free).cwiseAbs().maxCoeff(), 1e-4);  // float matrices times w of about 5
  ASSERT_FALSE(bound.empty());
  EXPECT_GT(rest(bound).minCoeff(), -1e-4);
}

TEST(SpectralBasis, BandValuesOfThePrimariesAreTheSmoothest) {
  check_smoothest<4>(SpectralBasis::bands(4));
  check_smoothest<8>(SpectralBasis::bands(8));
}

struct Errors {
  double lamp = 0.0;         // emission, relative to its luminance
  double reflectance = 0.0;  // metals under D65
  double index = 0.0;        // metals by n and k at the lanes' wavelengths, under D65
  double product = 0.0;      // metals under illuminant A, relative to the light's luminance
};

template <int N>
Errors colour_errors(const SpectralBasis& basis) {
  Errors e;
  for (const char* name : {"A", "E", "F2", "F11"}) {
    const SampledSpectrum& lamp = *find_illuminant(name);
    const Eigen::Vector3d exact = nits_of(lamp);
    const Rgb rgb = basis.to_rgb(basis.resolve_emission<N>(lamp));
    e.lamp = std::max(e.lamp, distance(rgb, exact) / (xyz_from_rgb() * exact).y());
  }
  const SampledSpectrum& a = *find_illuminant("A");
  const double luminance_a = (xyz_from_rgb() * nits_of(a)).y();
  for (const char* name : {"Au", "Ag", "Cu", "Al", "Fe", "Cr", "W", "Ti"}) {
    const OpticalConstants& metal = *find_optical_constants(name);
    const SampledSpectrum f = metal_reflectance(metal);
    const Spectrum<N> lanes = basis.resolve<N>(f);
    EXPECT_GE(lanes.min(), 0.0f);
    EXPECT_LE(lanes.max(), 1.0f);
    e.reflectance = std::max(e.reflectance, distance(basis.to_rgb(lanes), exact_rgb(f)));
    const Spectrum<N> n = basis.resolve_at_wavelength<N>(metal.n);
    const Spectrum<N> k = basis.resolve_at_wavelength<N>(metal.k);
    const auto by_index =
        Spectrum<N>::generate([&](int i) { return fresnel(1.0f, n[i], k[i]).mean(); });
    e.index = std::max(e.index, distance(basis.to_rgb(by_index), exact_rgb(f)));
    const Rgb lit = basis.to_rgb(basis.resolve_emission<N>(a) * lanes);
    const Eigen::Vector3d exact = rgb_from_xyz() * xyz_of_reflectance(f, a) * luminance_a;
    e.product = std::max(e.product, distance(lit, exact) / luminance_a);
  }
  return e;
}

// Stated errors of the bands against the 5 nm integration, largest over A, E, F2, F11 and eight
// metals. The colour of one spectrum is exact (up to the white of the tables, 1e-4) unless a lane
// would leave the spectrum's range: gold in 4 bands. Products and n, k are not.
TEST(SpectralBasis, SpectraHaveTheirColourWithinTheStatedErrors) {
  const Errors four = colour_errors<4>(SpectralBasis::bands(4));
  EXPECT_LT(four.lamp, 2e-4);
  EXPECT_LT(four.reflectance, 0.011);
  EXPECT_LT(four.index, 0.06);
  EXPECT_LT(four.product, 0.05);
  const Errors eight = colour_errors<8>(SpectralBasis::bands(8));
  EXPECT_LT(eight.lamp, 2e-4);
  EXPECT_LT(eight.reflectance, 2e-4);
  EXPECT_LT(eight.index, 0.006);
  EXPECT_LT(eight.product, 0.005);
  for (const auto& [name, e] : {std::pair{"4", four}, std::pair{"8", eight}}) {
    RecordProperty(std::string("lamp") + name, std::to_string(e.lamp));
    RecordProperty(std::string("reflectance") + name, std::to_string(e.reflectance));
    RecordProperty(std::string("index") + name, std::to_string(e.index));
    RecordProperty(std::string("product") + name, std::to_string(e.product));
  }
}

// In RGB a sampled reflectance is its integral; negative channels are
// clipped, and those above the spectrum's maximum (gold: R = 1.04), which would gain energy.
TEST(SpectralBasis, RgbLanesOfSamplesAreTheirColour) {
  const SpectralBasis basis = SpectralBasis::rgb();
  for (const char* name : {"Au", "Cu", "Ag", "Ti"}) {
    const SampledSpectrum f = metal_reflectance(*find_optical_constants(name));
    const Rgb lanes = basis.resolve<3>(f);
    Eigen::Vector3d exact =
        exact_rgb(f).cwiseMin(*std::max_element(f.value.begin(), f.value.end()));
    EXPECT_LT(distance(lanes, exact), 1e-6) << name;
  }
  // 520 nm is greener than the primaries allow: red and blue are clipped, not negative.
  const SampledSpectrum line = make_sampled_spectrum({514.0, 520.0, 526.0}, {0.0, 1.0, 0.0});
  const Rgb green = basis.resolve<3>(line);
  EXPECT_EQ(green[0], 0.0f);
  EXPECT_GT(green[1], 0.0f);
}

// A line much narrower than the grid, wherever it falls, keeps its power: 683 V(lambda) nits per
// W/(sr m^2), V linear between the 5 nm nodes up to the cell's average.
TEST(SpectralBasis, NarrowLinesAreNotMissed) {
  const SpectralBasis basis = SpectralBasis::grey();
  for (const double nm : {550.0, 551.3, 552.4, 553.9}) {
    const SampledSpectrum line =
        make_sampled_spectrum({nm - 0.5, nm, nm + 0.5}, {0.0, 2.0, 0.0});  // integral 1
    const double nits = basis.resolve_emission<1>(line)[0];
    EXPECT_NEAR(nits / (683.0 * cie_y_bar().at(nm)), 1.0, 0.005) << nm;
  }
}

// Index of refraction in RGB lanes: a mean with positive weights stays inside the table's range.
TEST(SpectralBasis, MeansOfAnIndexStayInItsRange) {
  for (const char* name : {"Au", "Cu", "diamond"}) {
    const OpticalConstants& m = *find_optical_constants(name);
    for (const SampledSpectrum* table : {&m.n, &m.k}) {
      const Rgb mean = SpectralBasis::rgb().resolve_at_wavelength<3>(*table);
      EXPECT_GE(mean.min(), static_cast<float>(min_value(*table)));
      EXPECT_LE(mean.max(), static_cast<float>(max_value(*table)));
    }
  }
}

// RGB of all packs together.
Rgb rgb_of_packs(const SpectralBasis& basis, const SpectralValue& value, bool emission) {
  Rgb sum;
  for (const SpectralBasis& pack : basis.packs())
    sum += pack.to_rgb(emission ? pack.resolve_emission<8>(value) : pack.resolve<8>(value));
  return sum;
}

TEST(SpectralBasis, PacksShareOutTheLanes) {
  for (const int lanes : {16, 32}) {
    SCOPED_TRACE(lanes);
    const SpectralBasis basis = SpectralBasis::bands(lanes);
    const std::vector<SpectralBasis> packs = basis.packs();
    ASSERT_EQ(packs.size(), static_cast<std::size_t>(lanes / 8));
    for (std::size_t p = 0; p < packs.size(); ++p) {
      ASSERT_EQ(packs[p].lanes(), 8);
      EXPECT_EQ(packs[p].packs().size(), 1u);
      const auto first = static_cast<Eigen::Index>(8 * p);
      EXPECT_EQ(packs[p].to_rgb_matrix(), basis.to_rgb_matrix().middleCols(first, 8));
      EXPECT_EQ(packs[p].from_rgb_matrix(), basis.from_rgb_matrix().middleRows(first, 8));
      for (std::size_t i = 0; i < 8; ++i)
        EXPECT_EQ(packs[p].wavelengths_nm()[i], basis.wavelengths_nm()[8 * p + i]);
      const Spectrum<8> white = packs[p].resolve<8>(make_rgb(1, 1, 1));
      for (int i = 0; i < 8; ++i) EXPECT_NEAR(white[i], 1.0f, 3e-7f);
    }
    // Colours of single spectra are exact, as they are for 8 bands.
    EXPECT_LT(distance(rgb_of_packs(basis, make_rgb(0.9, 0.2, 0.1), false), {0.9, 0.2, 0.1}), 2e-6);
    for (const char* name : {"Au", "Cu", "Ti"}) {
      const SampledSpectrum f = metal_reflectance(*find_optical_constants(name));
      EXPECT_LT(distance(rgb_of_packs(basis, f, false), exact_rgb(f)), 2e-4) << name;
    }
    const SampledSpectrum& a = *find_illuminant("A");
    const Eigen::Vector3d nits = nits_of(a);
    EXPECT_LT(distance(rgb_of_packs(basis, a, true), nits), 2e-4 * nits.maxCoeff());
  }
  EXPECT_EQ(SpectralBasis::bands(8).packs().size(), 1u);
  EXPECT_EQ(SpectralBasis::rgb().packs().front().lanes(), 3);
}

// Finer bands are cut from the eight: every second edge of 16 is an edge of 8, and so on, so
// the luminances of the parts add up.
TEST(SpectralBasis, FinerBandsHalveTheEight) {
  const auto luminance_of = [](const SpectralBasis& basis) {
    return Eigen::RowVectorXf(xyz_from_rgb().cast<float>().row(1) * basis.to_rgb_matrix());
  };
  const Eigen::RowVectorXf eight = luminance_of(SpectralBasis::bands(8));
  for (const int lanes : {16, 32}) {
    const SpectralBasis basis = SpectralBasis::bands(lanes);
    const Eigen::RowVectorXf fine = luminance_of(basis);
    for (int i = 0; i < 8; ++i)
      EXPECT_NEAR(fine.segment(i * lanes / 8, lanes / 8).sum(), eight[i], 1e-6f);
    for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(lanes); ++i)
      EXPECT_LT(basis.wavelengths_nm()[i], basis.wavelengths_nm()[i + 1]);
  }
}

}  // namespace
}  // namespace atrium::material
