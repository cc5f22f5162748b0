#include <algorithm>

#include "material/bsdf.h"
#include "material/error.h"
#include "material_query/kinds.h"
#include "material_query/named_material.h"

namespace atrium::material_query {
namespace {

using material::Material;
using Bsdf = material::Bsdf<3>;

/// A table whose k leaves light to pass: glass, water, acrylic.
bool is_transparent(const material::OpticalConstants& table) {
  return *std::max_element(table.k.value.begin(), table.k.value.end()) < 0.01;
}

void set_index(Material& m, const Inputs& in) {
  if (in.has("material") == in.has("n"))
    throw Error(in.has("n") ? "material and n are both given, must be one of them"
                            : "missing input material or n");
  if (in.has("n")) {
    m.n = in["n"];
    m.kappa = in.get("kappa", 0.0);
    return;
  }
  if (in.has("kappa")) throw Error("kappa belongs to n, must not be given with material");
  const auto& table = named_material(in.text("material"));
  material::SampledSpectrum kappa = table.k;
  for (std::size_t i = 0; i < kappa.value.size(); ++i) kappa.value[i] /= table.n.value[i];
  m.n = table.n;
  m.kappa = kappa;
  if (is_transparent(table)) m.medium = Material::Medium::Solid;
}

Material described(const Inputs& in) {
  Material m;
  m.fresnel_error = 0.0;
  set_index(m, in);
  if (in.flag("solid", m.medium == Material::Medium::Solid)) {
    m.medium = Material::Medium::Solid;
    m.k_tp_rg = 1.0;
  } else {
    m.medium = Material::Medium::Opaque;
  }
  m.c = in.get("c", m.c);
  if (in.has("sigma")) m.sigma = in["sigma"];
  m.k_df = in.get("k_df", 0.0);
  m.k_rg = in.get("k_rg", 1.0);
  if (in.flag("coupled", false)) m.combination = Material::Combination::Coupled;
  if (in.has("rho")) {
    const std::vector<double> rho = in.numbers("rho");
    m.body_reflectance = make_rgb(rho[0], rho[1], rho[2]);
  }
  material::validate(m, "material");
  return m;
}

Vec3f viewer(const Inputs& in) {
  const Vec3d b = viewer_above(in);
  if (!(b.z() > 0.0)) throw Error("z of b is 0, must be above 0");
  return b.cast<float>().normalized();
}

std::vector<double> values_of(const Rgb& rgb) { return {rgb.lane.begin(), rgb.lane.end()}; }

/// The BSDF of a query; holds what the BSDF refers to.
struct Described {
  Material material;
  material::ResolvedMaterial<3> resolved;
  Bsdf bsdf;
  explicit Described(const Inputs& in)
      : material(described(in)),
        resolved(material::resolve_material<3>(material, material::SpectralBasis::rgb())),
        bsdf(resolved, true, Rgb::one(), Rgb::one(), 1.0f) {}
  Described(const Described&) = delete;
  Described& operator=(const Described&) = delete;
};

void bsdf(const Inputs& in, Answer& out) {
  const Vec3f b = viewer(in), l = in.direction("l").cast<float>().normalized();
  const Described d(in);
  const auto f = d.bsdf.eval(b, l);
  out.numbers("f", values_of(f.sum()));
  out.numbers("diffuse", values_of(f.diffuse));
  out.numbers("lobe", values_of(f.lobe));
  out.number("pdf", static_cast<double>(d.bsdf.pdf(b, l)));
  out.numbers("albedo", values_of(d.bsdf.albedo(b, material::kAllEvents)));
}

const char* name_of(material::Event event) {
  switch (event) {
    case material::kDiffuseReflection:
      return "diffuse reflection";
    case material::kDiffuseTransmission:
      return "diffuse transmission";
    case material::kLobeReflection:
      return "lobe reflection";
    case material::kLobeTransmission:
      return "lobe transmission";
    case material::kMirror:
      return "mirror";
    case material::kRefraction:
      return "refraction";
    default:
      return "pane";
  }
}

void bsdf_sample(const Inputs& in, Answer& out) {
  const Described d(in);
  const std::vector<double> u = in.numbers("u");
  // Rounding to float must not reach 1.
  const auto below_one = [](double x) { return std::min(static_cast<float>(x), 0x1.fffffep-1f); };
  const auto sample =
      d.bsdf.sample(viewer(in), below_one(u[0]), Vec2f(below_one(u[1]), below_one(u[2])));
  if (!sample) {
    out.text("event", "absorbed");
    return;
  }
  out.text("event", name_of(sample->event));
  const Vec3d l = sample->wi.cast<double>();
  out.numbers("l", {l.x(), l.y(), l.z()});
  out.numbers("weight", values_of(sample->weight));
  out.number("pdf", static_cast<double>(sample->pdf));
}

std::vector<Input> description() {
  const auto flag = [](std::string_view name, std::string_view meaning) {
    return Input{name, meaning, Input::Type::Flag, {}, false};
  };
  Input c = roughness();
  c.range.infinite = true;
  Input rho{"rho", "body reflectance, linear RGB", Input::Type::Numbers, between(0.0, 1.0), false};
  rho.count = 3;
  return {{"material", "name, or `n` and `kappa`", Input::Type::Text, {}, false},
          optional(number("n", "absolute index", above(0.0))),
          optional(number("kappa", "index of absorption, 0 if missing", at_least(0.0))),
          optional(c),
          optional(number("sigma", "rms height [m]: keeps a mirror part", at_least(0.0))),
          optional(share("k_df", "body, 0 if missing")),
          optional(share("k_rg", "interface, 1 if missing")),
          rho,
          flag("coupled", "the body lies under the interface"),
          flag("solid", "light passes; if missing: glasses and liquids do")};
}

}  // namespace

std::vector<Kind> bsdf_kinds() {
  std::vector<Input> eval = description(), sample = description();
  eval.insert(eval.begin(), {to_light(), to_viewer()});
  Range half_open = between(0.0, 1.0);
  half_open.high_open = true;
  Input u{"u", "choice of event, two for the direction", Input::Type::Numbers, half_open};
  u.count = 3;
  sample.insert(sample.begin(), {to_viewer(), u});
  return {
      {"bsdf", "a material as the renderer has it: linear RGB, single precision", eval,
       "`f`, `diffuse`, `lobe` (arrays of 3) [1/sr], `pdf` of sampling l [1/sr], `albedo` "
       "(estimate, mirror parts included)",
       bsdf},
      {"bsdf_sample", "a direction sampled from it", sample,
       "`event` (`absorbed` alone, or with), `l`, `weight` = f |cos| / pdf, `pdf` [1/sr] (0 for "
       "mirror and refraction)",
       bsdf_sample}};
}

}  // namespace atrium::material_query
