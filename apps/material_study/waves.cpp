#include "material_study/waves.h"

#include <algorithm>

namespace atrium::study {

Roughness WaveCase::roughness() const {
  return {.name = "", .sigma = sigma * kWaveLength, .tau = tau * kWaveLength};
}

std::vector<WaveCase> wave_cases(bool quick) {
  // Aluminium at 555 nm; a black glass.
  const std::vector<Substance> kinds{grey_substance("metal", 0.96, 6.69),
                                     grey_substance("dielectric", 1.5, 0.0)};
  const std::vector<double> sigmas =
      quick ? std::vector{0.05, 0.3, 2.0}
            : std::vector{0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 5.0, 10.0};
  std::vector<WaveCase> cases;
  for (const Substance& kind : kinds)
    for (const double tau : kWaveTaus)
      for (const double sigma : sigmas) {
        const WaveCase wave{kind, tau, sigma};
        // The steep ones of the finest structure say nothing that those of the next do not.
        if (tau == kWaveTaus[0] && wave.steep()) continue;
        if (!quick || (kind.name == "metal" && tau == 10.0)) cases.push_back(wave);
      }
  return cases;
}

WaveResult compare_waves(const WaveCase& wave, const TileOptions& options,
                         const scene::Control& control) {
  const auto basis = material::SpectralBasis::grey();
  const Roughness roughness = wave.roughness();
  const material::Material facets = make_material(wave.substance, roughness, Model::Facets);
  const material::Material he = make_material(wave.substance, roughness, Model::He);
  const auto tile = [&](const material::Material& m, int effort) {
    TileOptions o = options;
    o.samples *= effort;
    return render_tile(Stage::Sphere, m, trace::Mode::Radiometric, basis, o, control);
  };
  constexpr int kFine = 4;  // differences of a percent are looked for
  WaveResult r;
  r.wave = wave;
  const LobeSurface reference(he, trace::Mode::Radiometric, basis);
  const LobeSurface cheap(facets, trace::Mode::Radiometric, basis);
  r.lobe30 = lobe_difference(reference, cheap, 30.0);
  r.lobe60 = lobe_difference(reference, cheap, 60.0);
  const RenderedTile facet_tile = tile(facets, kFine), he_tile = tile(he, kFine);
  r.image = difference(facet_tile, he_tile);
  r.facets = show(facet_tile);
  r.he = show(he_tile);

  material::Material lobe_only = facets;
  lobe_only.sigma.reset();
  r.geometric = difference(tile(make_material(wave.substance, roughness, Model::CookTorrance), 1),
                           tile(lobe_only, 1));
  return r;
}

Verdict verdict(const std::vector<WaveResult>& results, const std::string& substance, double tau,
                double error) {
  std::vector<const WaveResult*> cases;
  for (const WaveResult& r : results)
    if (r.wave.substance.name == substance && r.wave.tau == tau && !r.wave.steep())
      cases.push_back(&r);
  std::sort(cases.begin(), cases.end(),
            [](const auto* a, const auto* b) { return a->wave.sigma < b->wave.sigma; });
  Verdict v;
  for (const WaveResult* r : cases) {
    v.looked_at.push_back(r->wave.sigma);
    v.does.push_back(r->image.high <= error ? Verdict::Answer::Yes
                     : r->image.low > error ? Verdict::Answer::No
                                            : Verdict::Answer::Open);
  }
  return v;
}

}  // namespace atrium::study
