// Time per evaluation of the Fresnel forms, beside their error, and of the reflectance models.
// Directions are drawn beforehand and results depend on them. benchmarks/material_speed.py makes
// the table of docs/material-speed.md out of the output.

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "material/bsdf.h"
#include "material/fresnel_forms.h"
#include "material/optical_constants.h"
#include "material/paper.h"

namespace {

using namespace atrium;
using namespace atrium::material;

constexpr std::size_t kInputs = 1024;  // a power of two; fits the first cache

template <class T>
const T& at(const std::vector<T>& inputs, std::size_t i) {
  return inputs[i & (kInputs - 1)];
}

// ---- Fresnel ----

template <int N>
struct Index {
  Spectrum<N> n, k;
};

// Lanes spread evenly over 430-670 nm; 550 nm for one.
template <int N>
Index<N> index_of(const std::string& name) {
  const OpticalConstants& m = *find_optical_constants(name);
  Index<N> index;
  for (int i = 0; i < N; ++i) {
    const double nm = N == 1 ? 550.0 : 430.0 + 240.0 * i / (N - 1);
    index.n[i] = static_cast<float>(m.n.at(nm));
    index.k[i] = m.k.at(nm) > 1e-4 ? static_cast<float>(m.k.at(nm)) : 0.0f;
  }
  return index;
}

std::vector<float> random_cosines() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform;
  std::vector<float> c(kInputs);
  for (float& x : c) x = uniform(random);
  return c;
}

template <int N, class F>
void time_fresnel(benchmark::State& state, const F& reflectance) {
  const std::vector<float> cosines = random_cosines();
  std::size_t i = 0;
  for (auto _ : state) {
    Spectrum<N> f = reflectance(at(cosines, i++));
    benchmark::DoNotOptimize(f);
  }
}

template <int N>
double largest_error(const FresnelTerm<N>& term, const Index<N>& index) {
  double worst = 0.0;
  for (int j = 0; j <= 4000; ++j) {
    const float u = static_cast<float>(j) / 4000.0f, c = u * u;
    const Spectrum<N> f = term(c);
    for (int i = 0; i < N; ++i) {
      const double exact = fresnel_unpolarised<double>(c, index.n[i], index.k[i]);
      worst = std::max(worst, std::abs(static_cast<double>(f[i]) - exact));
    }
  }
  return worst;
}

// names: fresnel/<material>/<form>/<lanes>
template <int N>
void register_fresnel(const std::string& material) {
  const Index<N> index = index_of<N>(material);
  const std::string prefix = "fresnel/" + material + "/", lanes = "/" + std::to_string(N);
  for (const FresnelForm form :
       {FresnelForm::Schlick, FresnelForm::Order0, FresnelForm::SchlickCorrected,
        FresnelForm::Table, FresnelForm::Order1, FresnelForm::Order2, FresnelForm::Exact})
    benchmark::RegisterBenchmark((prefix + std::string(name(form)) + lanes).c_str(),
                                 [=](benchmark::State& state) {
                                   const FresnelTerm<N> term(index.n, index.k, form);
                                   time_fresnel<N>(state, term);
                                   state.counters["max_error"] = largest_error(term, index);
                                 });
  // Without anything made beforehand, lane by lane.
  benchmark::RegisterBenchmark(
      (prefix + "fresnel_unpolarised()" + lanes).c_str(), [=](benchmark::State& state) {
        Index<N> x = index;
        benchmark::DoNotOptimize(x);
        time_fresnel<N>(state, [&](float c) {
          return Spectrum<N>::generate(
              [&](int i) { return fresnel_unpolarised(c, x.n[i], x.k[i]); });
        });
      });
  for (const float bound : {1e-2f, 1e-3f, 0.0f}) {
    const FresnelTerm<N> chosen(index.n, index.k, bound);
    const std::string label = "bound " + (bound > 0.0f ? std::to_string(bound) : "0") + " = " +
                              std::string(name(chosen.form()));
    benchmark::RegisterBenchmark(("construct/" + material + "/" + label + lanes).c_str(),
                                 [=](benchmark::State& state) {
                                   for (auto _ : state) {
                                     FresnelTerm<N> term(index.n, index.k, bound);
                                     benchmark::DoNotOptimize(term);
                                   }
                                   state.counters["max_error"] = largest_error(chosen, index);
                                 });
  }
}

// ---- Models ----

struct Inputs {
  std::vector<Vec3f> wo, wi;
  std::vector<Vec2f> u;
  std::vector<float> choice;
};

// A Bsdf draws its lobe by a number of its own; a lobe does not.
template <class Model>
auto sample(const Model& model, const Vec3f& wo, float choice, const Vec2f& u) {
  if constexpr (requires { model.sample(wo, choice, u); })
    return model.sample(wo, choice, u);
  else
    return model.sample(wo, u);
}
template <int N>
Vec3f direction(const BsdfSample<N>& s) {
  return s.wi;
}
inline Vec3f direction(const Vec3f& wi) { return wi; }

// wi as the model scatters: random ones would miss a narrow lobe, and time its early return.
template <class Model>
Inputs make_inputs(const Model& model) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Inputs inputs;
  while (inputs.wo.size() < kInputs) {
    const auto pair = [&] { return Vec2f(uniform(random), uniform(random)); };
    const Vec3f wo = sample_cosine_hemisphere(pair());
    const Vec2f u = pair();
    const float choice = uniform(random);
    if (!(wo.z() > 1e-3f)) continue;
    const auto s = sample(model, wo, choice, u);
    inputs.wo.push_back(wo);
    inputs.wi.push_back(s ? direction(*s) : sample_cosine_hemisphere(pair()));
    inputs.u.push_back(u);
    inputs.choice.push_back(choice);
  }
  return inputs;
}

// names: model/<name>/<eval|sample|pdf>/<lanes>. Any type with eval(wo, wi), pdf(wo, wi) and
// sample(wo, choice, u) or sample(wo, u); one line in register_models() adds a model.
template <int N, class Model>
void register_model(const std::string& name, const Model& model) {
  const auto add = [&](const std::string& what, auto f) {
    benchmark::RegisterBenchmark(("model/" + name + "/" + what + "/" + std::to_string(N)).c_str(),
                                 [=](benchmark::State& state) {
                                   const Inputs in = make_inputs(model);
                                   std::size_t i = 0;
                                   for (auto _ : state) {
                                     auto result = f(in, i++);
                                     benchmark::DoNotOptimize(result);
                                   }
                                 });
  };
  add("eval",
      [=](const Inputs& in, std::size_t i) { return model.eval(at(in.wo, i), at(in.wi, i)); });
  add("sample", [=](const Inputs& in, std::size_t i) {
    return sample(model, at(in.wo, i), at(in.choice, i), at(in.u, i));
  });
  add("pdf",
      [=](const Inputs& in, std::size_t i) { return model.pdf(at(in.wo, i), at(in.wi, i)); });
}

Material interface_of(Material::Medium medium, double n, double k, double c) {
  Material m;
  m.medium = medium;
  m.n = n;
  m.kappa = k / n;
  m.c = c;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  m.k_tp_rg = medium == Material::Medium::Solid ? 1.0 : 0.0;
  return m;
}
Material lambert() {
  Material m;
  m.body_reflectance = 0.8;
  return m;
}
Material plastic(double c) {
  Material m = lambert();
  m.combination = Material::Combination::Coupled;
  m.n = 1.5;
  m.c = c;
  m.k_rg = 1.0;
  return m;
}

template <int N>
SpectralBasis basis() {
  if constexpr (N == 1) return SpectralBasis::grey();
  if constexpr (N == 3) return SpectralBasis::rgb();
  return SpectralBasis::bands(N);
}

// The six-term material. It refers to its description and tables, which live as long as the
// program.
template <int N>
void register_bsdf(const std::string& name, const Material& description) {
  static std::vector<std::unique_ptr<std::pair<Material, ResolvedMaterial<N>>>> kept;
  kept.push_back(std::make_unique<std::pair<Material, ResolvedMaterial<N>>>(description,
                                                                            ResolvedMaterial<N>{}));
  auto& [material, resolved] = *kept.back();
  resolved = resolve_material<N>(material, basis<N>());
  register_model<N>(name, Bsdf<N>(resolved, true, Spectrum<N>::one(), Spectrum<N>::one(), 1.0f));
}

// A model of the literature on a metal (interface) or a body.
Material literature(const LobeModel& lobe) {
  Material m = is_body(lobe) ? lambert()
                             : interface_of(Material::Medium::Opaque, 0.27, 2.95,
                                            std::numeric_limits<double>::infinity());
  m.lobe = lobe;
  return m;
}

// The paper's bracket of C1 and C5, literally: diffuse and highlight of one light.
template <int N>
void register_paper() {
  static const Material metal = interface_of(Material::Medium::Opaque, 0.27, 2.95, 10.0);
  static const ResolvedMaterial<N> resolved = resolve_material<N>(metal, basis<N>());
  const PaperSurface<N> surface(resolved, true, Spectrum<N>::one(), Spectrum<N>::one(), 1.0f);
  const Bsdf<N> scattering(resolved, true, Spectrum<N>::one(), Spectrum<N>::one(), 1.0f);
  benchmark::RegisterBenchmark(("model/paper mode, metal/eval/" + std::to_string(N)).c_str(),
                               [=](benchmark::State& state) {
                                 const Inputs in = make_inputs(scattering);
                                 std::size_t i = 0;
                                 for (auto _ : state) {
                                   auto c1 = surface.direct(at(in.wo, i), at(in.wi, i));
                                   ++i;
                                   benchmark::DoNotOptimize(c1);
                                 }
                               });
}

template <int N>
void register_models() {
  using enum Material::Medium;
  const double smooth = std::numeric_limits<double>::infinity();
  register_bsdf<N>("Lambert", lambert());
  register_bsdf<N>("metal, smooth", interface_of(Opaque, 0.27, 2.95, smooth));
  const Material metal = interface_of(Opaque, 0.27, 2.95, 10.0);
  register_bsdf<N>("metal, rough", metal);
  Material variant = metal;
  variant.fresnel_error = 0.0;
  register_bsdf<N>("metal, rough, exact F", variant);
  variant = metal;
  variant.masking = Masking::Smith;
  register_bsdf<N>("metal, rough, Smith", variant);
  variant = metal;
  variant.facet_interreflection = true;
  register_bsdf<N>("metal, rough, interreflection", variant);
  register_bsdf<N>("plastic, smooth, coupled", plastic(smooth));
  register_bsdf<N>("plastic, rough, coupled", plastic(10.0));
  register_bsdf<N>("glass, smooth", interface_of(Solid, 1.5, 0.0, smooth));
  register_bsdf<N>("glass, rough", interface_of(Solid, 1.5, 0.0, 10.0));
  register_bsdf<N>("Phong", literature(PhongModel{50.0}));
  register_bsdf<N>("Blinn-Phong", literature(BlinnPhongModel{200.0}));
  register_bsdf<N>("Cook-Torrance", literature(CookTorranceModel{0.1}));
  register_bsdf<N>("He 1991", literature(HeModel{1e-6, 20e-6}));
  register_bsdf<N>("Schlick 1994", literature(SchlickModel{0.2, 1.0}));
  register_bsdf<N>("GGX", literature(GgxModel{0.1}));
  register_bsdf<N>("Oren-Nayar", literature(OrenNayarModel{0.3}));
  register_bsdf<N>("Hanrahan-Krueger", literature(HanrahanKruegerModel{1.0, 0.3}));
  register_paper<N>();
}

template <int N>
void register_all() {
  for (const char* material : {"Au", "Ag", "Cu", "Al", "BK7"}) register_fresnel<N>(material);
  register_models<N>();
}

}  // namespace

int main(int argc, char** argv) {
  register_all<1>();
  register_all<3>();
  register_all<8>();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
