#include "material_study/study_text.h"

#include <cstdio>

#include "material_study/lobe_plots.h"

namespace atrium::study::text {

namespace {

std::string number(double value, const char* format) {
  char out[32];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

/// Mean error and bias on the sphere over substances that are all interface.
struct Mean {
  double error = 0.0, bias = 0.0;
  int count = 0;
};
Mean mean_of(const StudyResult& r, Model model, const std::string& roughness) {
  Mean mean;
  for (const SurfaceResult& s : r.surfaces) {
    if (s.roughness.name != roughness || find_substance(s.substance).body) continue;
    for (const ModelResult& m : s.models) {
      if (m.model != model || !m.rendered[0]) continue;
      mean.error += m.image[0].error;
      mean.bias += m.image[0].bias;
      ++mean.count;
    }
  }
  if (mean.count > 0) mean.error /= mean.count, mean.bias /= mean.count;
  return mean;
}

std::string summary_table(const StudyResult& r) {
  std::string out =
      "| model | smooth: error % | bias % | medium: error % | bias % | rough: error % | bias % |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  for (const Model model : {Model::Paper, Model::CookTorrance, Model::He, Model::Ggx, Model::Phong,
                            Model::BlinnPhong, Model::Schlick}) {
    if (mean_of(r, model, "smooth").count == 0) continue;
    out += std::string("| ") + name_of(model) + " ";
    for (const Roughness& level : roughnesses()) {
      const Mean m = mean_of(r, model, level.name);
      out += "| " + number(100.0 * m.error, "%.1f") + " | " + number(100.0 * m.bias, "%+.1f") + " ";
    }
    out += "|\n";
  }
  return out + "\n";
}

constexpr const char* kFindings = R"(What the tables below come to:

- **The facets, Cook-Torrance and He's wave optics give the same pictures** wherever the surface is a
  few wavelengths high and its slope is moderate. The model that is evaluated in some tens of
  nanoseconds replaces the one that takes microseconds.
- **Smooth surfaces** need the mirror part (sigma), not a narrow lobe: Cook-Torrance and GGX, which
  have none, blur edges in reflections. With it the facets follow He down to the smoothest surfaces
  looked at, as the last section shows. What they lack is the haze by diffraction: He's lobe is never
  narrower than about lambda / tau, theirs is as narrow as the slope.
- **Rough surfaces** (slope 0.35) differ by shadowing: V-cavities shade less than He's factor, so that
  the facets are brighter. All single-scattering models lose light there; `facet_interreflection`
  gives it back to the facets, and is not in these pictures.
- **Phong and Blinn-Phong** are too dark towards the rim, and black at it for metals: the normalised
  forms keep energy at normal incidence only, and have no Fresnel factor. No exponent mends that.
- **GGX** with alpha equal to the slope has longer tails than a Gaussian surface and less in the core.
- **Schlick 1994** has one number for both the width of the lobe and the share of the mirror: either
  the highlight of the medium surface is right or its mirror image is not there, never both.
- **Paper mode** agrees where the surface is smooth. A rough surface in it is a sharp mirror of
  other surfaces at any roughness, without the lamps and the sky: those appear as highlights only,
  and a highlight carries a share of the light that falls with c (4 F / c^2). The medium surface is
  thus almost black but for the mirrored floor. This is what the equation says; the brightness of
  highlights has to be set by hand. Refraction is as sharp, at any roughness.
- **Plastic** is nine tenths body in the paper's sum of weights, so its highlights have a tenth of
  their physical strength and all models look alike. The coupled form, with the body under the whole
  interface, is the one to trust: its highlights are ten times as bright.

Where the facets are the worse model: the haze of smooth surfaces of fine structure (tau of a few
wavelengths), slopes above about 0.25 (shadowing by V-cavities, one scattering), and the colour of
the mirror part between the RGB lanes, which is that of three wavelengths.

)";

}  // namespace

std::string introduction(const StudyOptions& options) {
  return "# The material model beside others\n\n"
         "Made by\n\n```sh\n" +
         options.command +
         "\n```\n\nwhich renders everything again; all but the times is the same on every run and "
         "for any number of threads.\n\n";
}

std::string findings(const StudyOptions& options, const StudyResult& result) {
  std::string out =
      "## Findings\n\nDifference from the facets on the sphere, mean over metals and glass "
      "(plastic apart, see below):\n\n" +
      summary_table(result);
  // What was seen in the whole study need not hold for a part of it.
  if (!options.quick && options.materials.empty()) out += kFindings;
  return out;
}

std::string setup() {
  return R"(## What is compared

One sphere, one box and one room, always the same; only the material of the object changes. Sphere
and box stand on a chequered floor under two lamps and a grey sky; the room has a red and a green wall
and a lamp below its ceiling. Metals and glass have measured optical constants. Glass is shown twice:
as the reflection of an opaque dark body, which all models can do, and refracting, which only this
model can. Plastic is convex with k_df 0.9, k_rg 0.1; "coupled" has its body under the interface.

"facets" is this model in radiometric mode: Gaussian facets, V-cavities, mirror part by sigma. It is
the reference of all differences, not the truth. "paper mode" is the literal equation. The others
stand in the place of the facets, with the same n, kappa and weights.

Equal roughness means the same Gaussian surface of rms height sigma and correlation length tau: rms
slope m = 2 sigma / tau = 1/c, Beckmann's m in Cook-Torrance, alpha = m in GGX, p = 2/m^2 for
Blinn-Phong and 1/(2 m^2) for Phong, whose lobe is about the mirror direction and so twice as wide.
He takes sigma and tau. Schlick's r is the one whose light, mirror included, is closest to that of the
facets in patches of 10 degrees. The smooth surface is marked smooth (c infinite) for paper mode.

)";
}

std::string measures() {
  return R"(Measures, over the pixels of the object:

- error: RMS of the difference over the mean luminance of the 5 x 5 pixels around (plus 5 % of the
  median), as `atrium compare` has it; "at most" is the upper end of its 95 % interval.
- RMSE: RMS of the difference over the mean of the reference. Lamps seen in mirrors rule it.
- bias: of the mean luminance.
- noise: RMS noise of one picture. It is not in error and RMSE: every picture is two independent
  halves and the product of their differences is taken, which is free of noise on average. 0.0 says
  that the difference is lost in what noise is left.

)";
}

std::string about_pictures() {
  return "Every picture of a scene has the same exposure. Path tracing without filters; grain is "
         "noise of few samples.\n\n";
}

std::string about_lobes() {
  return R"(f cos in the plane of incidence for light from 45 degrees, without the Dirac mirror part. One
legend for the three charts of a row.

In the table the light comes from 45 degrees. Lobe difference is the integral of |f1 - f2| cos plus
the difference of the mirrors, over the albedo of the facets: 0 equal, 2 nothing in common. "As seen"
is the same after averaging over patches of 10 degrees, mirror and lobe together: a mirror and a very
narrow lobe have nothing in common but look the same.

)";
}

std::string about_differences() { return "Difference from the facets, in percent.\n\n"; }

std::string about_waves() {
  return R"(He et al. 1991 is the reference here, at one wavelength (555 nm), for aluminium and for a dark
dielectric (n = 1.5), sigma from 0.05 to 10 wavelengths at three correlation lengths. "Steep" marks
slopes above 0.5, where neither model holds: facets see each other several times, and He's shadowing
takes light away that it does not send elsewhere. Of the shortest correlation length only the slopes
below that are looked at. "D and G alone" is Cook-Torrance of the same slope against the facets
without their mirror part: what the shape of the distribution and the cavities make, waves apart.

)";
}

std::string about_verdict(const StudyOptions& options) {
  if (options.quick) return "";
  return R"(Facets with the coherent mirror part have **no lower end in sigma / lambda** at correlation lengths
of ten wavelengths and more. An error of the picture of **5 %** is kept at every sigma / lambda from
0.05 on as long as the slope stays at 0.2 or below; one of **2 %** for certain only below 0.1 lambda,
with differences of 1 to 3 % above. Below sigma = 0.3 lambda both models are mirrors with a lobe that
carries what the mirror lost, and Gamma = exp(-(4 pi sigma cos / lambda)^2) divides the light between
them as He's theory does, to 0.002. The share of the mirror, not the shape of the lobe, makes the
picture. The rule "sigma above a wavelength" is about the shape of the lobe: from sigma = 0.5 lambda
on it is the same to about 2 % while the slope is small.

What ends the agreement is the slope: the picture differs by 3 % at m = 0.2, 4 to 6 % at m = 0.25, 7
to 10 % at m = 0.4, 10 to 13 % at m = 0.5. There He's shadowing, not its waves, makes most of the
difference; the column "D and G alone" shows the like between two models without waves.

With structure as fine as tau = 3 lambda the light is diffracted wider than the slopes would send it:
the picture differs by 3 to 6 % at every sigma, and all of the light beside the mirror goes elsewhere
at sigma = 0.05 lambda (lobe difference as seen 0.23, which is all that the lobe holds). For such
surfaces 10 % is what the facets can promise.

)";
}

std::string about_times() {
  return "RGB lanes, one core of the machine at hand, random directions near the mirror direction, "
         "aluminium, medium; least of several runs. He's series depends on the roughness.\n\n";
}

}  // namespace atrium::study::text
