// Colour error of RGB, 4, 8, 16 and 32 bands against 81 wavelengths (380 to 780 nm, 5 nm), as
// CIEDE2000 in the light's own white. Writes the tables of docs/spectra.md to standard output.
//
//   colour_error [--all]     --all: every material, light and number of bounces
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "material/bsdf.h"
#include "material/cie.h"
#include "material/colour_difference.h"
#include "material/fresnel.h"
#include "material/optical_constants.h"
#include "material/rgb_spectrum.h"

namespace {

using namespace atrium;
using namespace atrium::material;

// What is seen, from n, k, extinction [1/m] and body colour of one wavelength or lane.
struct Numbers {
  double n, k, extinction, body;
};
struct Sample {
  std::string name;
  Material material;
  std::function<double(const Numbers&)> shown;
};

struct Basis {
  const char* name;
  std::vector<SpectralBasis> packs;
};

std::vector<double> wavelengths() {
  std::vector<double> nm;
  for (int i = 0; i < 81; ++i) nm.push_back(380.0 + 5.0 * i);
  return nm;
}

double at(const SpectralValue& v, double nm) {
  if (const auto* s = std::get_if<SampledSpectrum>(&v)) return s->at(nm);
  return std::get<double>(v);
}

Material of_table(const char* name) {
  const OpticalConstants& table = *find_optical_constants(name);
  Material m;
  m.n = table.n;
  SampledSpectrum kappa = table.k;
  for (std::size_t i = 0; i < kappa.value.size(); ++i) kappa.value[i] /= table.n.value[i];
  m.extinction = extinction_of(table);
  // k belongs to the interface of metals and to the body of what is transparent.
  if (max_value(table.k) > 0.1) m.kappa = kappa;
  return m;
}

std::vector<Sample> samples() {
  std::vector<Sample> list;
  const auto mirror = [&](const char* words, const char* table, int degrees) {
    const double c = std::cos(degrees * std::numbers::pi / 180.0);
    list.push_back({std::string(words) + ", " + std::to_string(degrees) + "°", of_table(table),
                    [c](const Numbers& p) { return fresnel(c, p.n, p.k).mean(); }});
  };
  const auto through = [&](const char* words, const char* table, double metres) {
    list.push_back({words, of_table(table), [metres](const Numbers& p) {
                      const double t = 1.0 - fresnel(1.0, p.n, 0.0).mean();
                      return t * t * std::exp(-p.extinction * metres);
                    }});
  };
  const auto body = [&](const char* words, SpectralValue colour) {
    Material m;
    m.body_reflectance = std::move(colour);
    list.push_back({words, m, [](const Numbers& p) { return p.body; }});
  };
  for (const auto& [words, table] : {std::pair{"gold", "Au"},
                                     {"copper", "Cu"},
                                     {"silver", "Ag"},
                                     {"aluminium", "Al"},
                                     {"BK7", "BK7"}})
    for (const int degrees : {0, 60, 80}) mirror(words, table, degrees);
  through("window glass, 1 cm", "soda-lime-glass", 0.01);
  through("window glass, 10 cm", "soda-lime-glass", 0.1);
  through("water, 1 m", "water", 1.0);
  through("water, 5 m", "water", 5.0);
  body("white, 0.8", 0.8);
  body("red (0.6, 0.1, 0.08)", rgb_reflectance(make_rgb(0.6, 0.1, 0.08)));
  body("yellow (0.7, 0.5, 0.05)", rgb_reflectance(make_rgb(0.7, 0.5, 0.05)));
  body("green (0.1, 0.4, 0.12)", rgb_reflectance(make_rgb(0.1, 0.4, 0.12)));
  body("blue (0.05, 0.1, 0.5)", rgb_reflectance(make_rgb(0.05, 0.1, 0.5)));
  return list;
}

Numbers at_wavelength(const Material& m, double nm) {
  const double n = at(m.n, nm);
  return {n, n * at(m.kappa, nm), at(m.extinction, nm),
          m.body_reflectance ? at(*m.body_reflectance, nm) : 0.0};
}

// XYZ of light that has met the sample some times, or of the light itself.
Eigen::Vector3d truth(const Sample& sample, const SampledSpectrum& light, int bounces) {
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  for (const double nm : wavelengths()) {
    const double r = sample.shown(at_wavelength(sample.material, nm));
    xyz += 5.0 * kMaxLuminousEfficacy * std::pow(r, bounces) * light.at(nm) *
           Eigen::Vector3d(cie_x_bar().at(nm), cie_y_bar().at(nm), cie_z_bar().at(nm));
  }
  return xyz;
}

template <int N>
Rgb lanes_rgb(const Sample& sample, const SampledSpectrum& light, int bounces,
              const SpectralBasis& pack) {
  const ResolvedMaterial<N> r = resolve_material<N>(sample.material, pack);
  const Spectrum<N> source = pack.resolve_emission<N>(light);
  return pack.to_rgb(Spectrum<N>::generate([&](int i) {
    const auto wide = [i](const Spectrum<N>& s) { return static_cast<double>(s[i]); };
    const Numbers p{wide(r.n), wide(r.k), wide(r.extinction), wide(r.body_reflectance)};
    return wide(source) * std::pow(sample.shown(p), bounces);
  }));
}

double error(const Sample& sample, const SampledSpectrum& light, int bounces, const Basis& basis) {
  Eigen::Vector3d rgb = Eigen::Vector3d::Zero();
  for (const SpectralBasis& pack : basis.packs)
    with_lanes(pack.lanes(), [&](auto n) {
      const Rgb part = lanes_rgb<decltype(n)::value>(sample, light, bounces, pack);
      for (int c = 0; c < 3; ++c) rgb[c] += static_cast<double>(part[c]);
    });
  const Eigen::Vector3d white = truth(sample, light, 0);
  return ciede2000(lab_from_xyz(xyz_from_rgb() * rgb, white),
                   lab_from_xyz(truth(sample, light, bounces), white));
}

void print_head(const char* first, const std::vector<Basis>& bases) {
  std::printf("| %s |", first);
  for (const Basis& b : bases) std::printf(" %s |", b.name);
  std::printf("\n| --- |");
  for (std::size_t i = 0; i < bases.size(); ++i) std::printf(" ---: |");
  std::printf("\n");
}

void print_row(const std::string& name, const std::vector<double>& values) {
  std::printf("| %s |", name.c_str());
  for (const double v : values) std::printf(" %.2f |", v);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  const bool all = argc == 2 && std::strcmp(argv[1], "--all") == 0;
  if (argc > 1 && !all) {
    std::fprintf(stderr, "usage: colour_error [--all]\n");
    return 2;
  }
  const std::vector<Basis> bases = {{"RGB", SpectralBasis::rgb().packs()},
                                    {"4", SpectralBasis::bands(4).packs()},
                                    {"8", SpectralBasis::bands(8).packs()},
                                    {"16", SpectralBasis::bands(16).packs()},
                                    {"32", SpectralBasis::bands(32).packs()}};
  const std::vector<Sample> list = samples();
  const std::vector<const char*> lights = {"D65", "A", "E", "F2", "F11"};
  for (const int bounces : {1, 3}) {
    std::vector<std::vector<double>> by_light(lights.size(),
                                              std::vector<double>(bases.size(), 0.0));
    const std::string title = bounces == 1 ? "one bounce" : "three bounces";
    print_head((title + (all ? ", light" : ", largest over the lights")).c_str(), bases);
    for (const Sample& sample : list) {
      std::vector<double> largest(bases.size(), 0.0);
      for (std::size_t l = 0; l < lights.size(); ++l) {
        std::vector<double> row;
        for (std::size_t b = 0; b < bases.size(); ++b) {
          row.push_back(error(sample, *find_illuminant(lights[l]), bounces, bases[b]));
          largest[b] = std::max(largest[b], row[b]);
          by_light[l][b] = std::max(by_light[l][b], row[b]);
        }
        if (all) print_row(sample.name + ", " + lights[l], row);
      }
      if (!all) print_row(sample.name, largest);
    }
    std::printf("\n");
    print_head((title + ", largest over the materials").c_str(), bases);
    for (std::size_t l = 0; l < lights.size(); ++l) print_row(lights[l], by_light[l]);
    std::printf("\n");
  }
  return 0;
}
