#include <gtest/gtest.h>

#include "material/cie.h"
#include "material/error.h"
#include "material/optical_constants.h"
#include "scene/features.h"

namespace atrium::scene {
namespace {

using material::Material;
using material::SampledSpectrum;
using material::SpectralBasis;

Material body(material::SpectralValue colour) {
  Material m;
  m.name = "body";
  m.body_reflectance = std::move(colour);
  return m;
}

Material conductor(const char* name) {
  const material::OpticalConstants& table = *material::find_optical_constants(name);
  Material m;
  m.name = name;
  m.n = table.n;
  SampledSpectrum kappa = table.k;
  for (std::size_t i = 0; i < kappa.value.size(); ++i) kappa.value[i] /= table.n.value[i];
  m.kappa = kappa;
  m.k_df = 0.0;
  m.k_rg = 1.0;
  return m;
}

// One triangle per material under a point light.
Scene scene_of(const std::vector<Material>& materials, material::SpectralValue light) {
  Model model;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    MeshData mesh;
    const double x = 2.0 * static_cast<double>(i);
    mesh.positions = {Vec3d(x, 0, 0), Vec3d(x + 1, 0, 0), Vec3d(x, 0, 1)};
    mesh.triangles = {{0, 1, 2}};
    model.meshes.push_back(mesh);
    model.materials.push_back(materials[i]);
    Model::Node node;
    node.mesh = MeshId(i);
    node.material = MaterialId(i);
    model.nodes.push_back(node);
  }
  Light point;
  point.name = "lamp";
  point.kind = PointLight{std::move(light), {}};
  model.lights.push_back(point);
  return build_scene(std::move(model));
}

BasisChoice automatic(const Scene& scene, double bound = kJustNoticeable) {
  return choose_basis(scene, find_features(scene), "auto", bound);
}

SampledSpectrum relative(const char* illuminant) {
  SampledSpectrum s;
  for (double nm = 380.0; nm <= 730.0; nm += 5.0) {
    s.wavelength_nm.push_back(nm);
    s.value.push_back(material::find_illuminant(illuminant)->at(nm) /
                      material::find_illuminant("D65")->at(nm));
  }
  return s;
}

// Counted: without samples nothing is predicted.
TEST(ChooseBasis, ScenesWithoutSamplesPayNothing) {
  const BasisChoice grey = automatic(scene_of({body(0.5), body(0.2)}, 100.0));
  EXPECT_EQ(grey.basis.kind(), SpectralBasis::Kind::Grey);
  EXPECT_EQ(grey.colours_compared, 0u);
  const BasisChoice rgb =
      automatic(scene_of({body(make_rgb(0.8, 0.1, 0.1))}, make_rgb(1, 0.8, 0.5)));
  EXPECT_EQ(rgb.basis.kind(), SpectralBasis::Kind::Rgb);
  EXPECT_EQ(rgb.colours_compared, 0u);
  EXPECT_TRUE(rgb.within_bound);
  // Sampled materials that nothing wears are not looked at either.
  Scene unused = scene_of({body(0.5)}, 100.0);
  unused.materials.push_back(conductor("Au"));
  EXPECT_EQ(automatic(unused).colours_compared, 0u);
}

TEST(ChooseBasis, FollowsThePredictedError) {
  // Silver is nearly grey; gold under incandescent light is not.
  const BasisChoice silver = automatic(scene_of({conductor("Ag")}, 100.0));
  EXPECT_EQ(silver.basis.kind(), SpectralBasis::Kind::Rgb);
  EXPECT_GT(silver.colours_compared, 0u);
  const Scene gold = scene_of({conductor("Au")}, relative("A"));
  EXPECT_EQ(automatic(gold, 20.0).basis.lanes(), 3);
  EXPECT_EQ(automatic(gold, 1.6).basis.lanes(), 8);
  const BasisChoice missed = automatic(gold, 0.1);
  EXPECT_EQ(missed.basis.lanes(), 8);
  EXPECT_FALSE(missed.within_bound);
  EXPECT_NE(missed.reason.find("Au, reflection"), std::string::npos) << missed.reason;
  EXPECT_NE(missed.reason.find("light lamp"), std::string::npos) << missed.reason;
}

// A sampled light alone: exact in RGB on grey bodies, not on coloured ones.
TEST(ChooseBasis, SampledLightsCountWithTheColoursTheyFallOn) {
  const BasisChoice grey = automatic(scene_of({body(0.5)}, relative("F2")));
  EXPECT_EQ(grey.basis.kind(), SpectralBasis::Kind::Rgb) << grey.reason;
  const BasisChoice green = automatic(scene_of({body(make_rgb(0.1, 0.4, 0.12))}, relative("F2")));
  EXPECT_EQ(green.basis.lanes(), 8) << green.reason;
  EXPECT_NE(green.reason.find("body, body, light lamp"), std::string::npos) << green.reason;
  // Vertex colours are colours too, though the material is white.
  Scene painted = scene_of({body(1.0)}, relative("F2"));
  painted.meshes[0].colors.assign(painted.meshes[0].positions.size(), Vec3f(1, 0, 0));
  EXPECT_EQ(automatic(painted).basis.lanes(), 8);
}

TEST(ChooseBasis, RequestsAreTakenAndUnknownOnesRefused) {
  const Scene scene = scene_of({conductor("Au")}, 1.0);
  const Features f = find_features(scene);
  EXPECT_EQ(choose_basis(scene, f, "grey").basis.lanes(), 1);
  EXPECT_EQ(choose_basis(scene, f, "rgb").basis.lanes(), 3);
  EXPECT_EQ(choose_basis(scene, f, "4").basis.lanes(), 4);
  EXPECT_EQ(choose_basis(scene, f, "8").basis.lanes(), 8);
  EXPECT_EQ(choose_basis(scene, f, "16").basis.lanes(), 16);
  EXPECT_EQ(choose_basis(scene, f, "32").basis.lanes(), 32);
  EXPECT_EQ(choose_basis(scene, f, "8").colours_compared, 0u);
  for (const char* bad : {"", "3", "64", "RGB"})
    EXPECT_THROW((void)choose_basis(scene, f, bad), Error) << bad;
}

}  // namespace
}  // namespace atrium::scene
