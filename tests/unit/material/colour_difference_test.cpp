#include "material/colour_difference.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace atrium::material {
namespace {

// All 34 pairs of Sharma, Wu & Dalal 2005, Table 1; four digits are published.
TEST(Ciede2000, AgreesWithThePublishedPairs) {
  const struct {
    Eigen::Vector3d a, b;
    double difference;
  } pairs[] = {{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
               {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
               {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
               {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
               {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1.0000},
               {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
               {{50, 0, 0}, {50, -1, 2}, 2.3669},
               {{50, -1, 2}, {50, 0, 0}, 2.3669},
               {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
               {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0010}, 7.1792},
               {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
               {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0012}, 7.2195},
               {{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
               {{50, -0.0010, 2.4900}, {50, 0.0010, -2.4900}, 4.8045},
               {{50, -0.0010, 2.4900}, {50, 0.0011, -2.4900}, 4.7461},
               {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
               {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
               {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
               {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
               {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
               {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
               {{50, 2.5, 0}, {50, 3.2972, 0}, 1.0000},
               {{50, 2.5, 0}, {50, 1.8634, 0.5757}, 1.0000},
               {{50, 2.5, 0}, {50, 3.2592, 0.3350}, 1.0000},
               {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
               {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
               {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
               {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
               {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
               {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
               {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
               {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
               {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
               {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082}};
  for (const auto& p : pairs) {
    SCOPED_TRACE(::testing::Message() << p.a.transpose() << " | " << p.b.transpose());
    EXPECT_NEAR(ciede2000(p.a, p.b), p.difference, 5.1e-5);
    EXPECT_NEAR(ciede2000(p.b, p.a), p.difference, 5.1e-5);
  }
}

// A metric on what it is used for: 0 for equal colours, symmetric, finite far outside the gamut.
TEST(Ciede2000, IsZeroForEqualColoursAndSymmetric) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-150.0, 150.0);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d a(u(random), u(random), u(random)), b(u(random), u(random), u(random));
    EXPECT_EQ(ciede2000(a, a), 0.0);
    EXPECT_GE(ciede2000(a, b), 0.0);
    EXPECT_NEAR(ciede2000(a, b), ciede2000(b, a), 1e-10);
  }
  EXPECT_EQ(ciede2000({0, 0, 0}, {0, 0, 0}), 0.0);
}

// Along the grey axis only S_L acts: dL / (1 + 0.015 (L - 50)^2 / sqrt(20 + (L - 50)^2)).
TEST(Ciede2000, GreysDifferByLightnessAlone) {
  for (const double l : {0.0, 20.0, 50.0, 80.0, 99.0}) {
    const double d = l + 0.5 - 50.0;
    EXPECT_NEAR(ciede2000({l, 0, 0}, {l + 1.0, 0, 0}),
                1.0 / (1.0 + 0.015 * d * d / std::sqrt(20.0 + d * d)), 1e-12);
  }
}

TEST(Lab, WhiteBlackAndTheJoinOfItsTwoParts) {
  const Eigen::Vector3d white(0.9505, 1.0, 1.089);
  EXPECT_LT((lab_from_xyz(white, white) - Eigen::Vector3d(100, 0, 0)).norm(), 1e-12);
  EXPECT_LT(lab_from_xyz(Eigen::Vector3d::Zero(), white).norm(), 1e-12);
  // Grey of 18 % has L* = 116 * 0.18^(1/3) - 16 = 49.496; below 216/24389 L* = 24389/27 Y.
  EXPECT_NEAR(lab_from_xyz(0.18 * white, white)[0], 49.4961, 1e-4);
  EXPECT_NEAR(lab_from_xyz(0.001 * white, white)[0], 24389.0 / 27.0 * 0.001, 1e-12);
  const double join = 216.0 / 24389.0;
  const double below = lab_from_xyz(join * (1.0 - 1e-9) * white, white)[0];
  const double above = lab_from_xyz(join * (1.0 + 1e-9) * white, white)[0];
  EXPECT_NEAR(below, 8.0, 1e-7);
  EXPECT_NEAR(above, 8.0, 1e-7);
  // a* and b* by the definition.
  const Eigen::Vector3d lab = lab_from_xyz({0.3, 0.2, 0.1}, white);
  EXPECT_NEAR(lab[1], 500.0 * (std::cbrt(0.3 / 0.9505) - std::cbrt(0.2)), 1e-12);
  EXPECT_NEAR(lab[2], 200.0 * (std::cbrt(0.2) - std::cbrt(0.1 / 1.089)), 1e-12);
}

}  // namespace
}  // namespace atrium::material
