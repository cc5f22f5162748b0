#include "material_study/study.h"

#include <cmath>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include "material/error.h"
#include "scene/image_io.h"
#include "scene/parallel.h"
#include "support/temp_folder.h"

namespace {

using namespace atrium;
using namespace atrium::study;
using test::TempFolder;

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(MaterialStudy, EveryMaterialIsValidAndAsRoughAsTheOthers) {
  for (const Substance& s : substances())
    for (const Roughness& r : roughnesses()) {
      std::vector<Model> models = all_models(s);
      if (s.transparent) models.insert(models.end(), {Model::Solid, Model::SolidPaper});
      for (const Model model : models) {
        const material::Material m = make_material(s, r, model);
        EXPECT_NO_THROW(material::validate(m, m.name)) << m.name;
      }
      const double m = 2.0 * r.sigma / r.tau;
      EXPECT_DOUBLE_EQ(make_material(s, r, Model::Facets).c, 1.0 / m);
      const auto phong = make_material(s, r, Model::Phong);
      EXPECT_DOUBLE_EQ(std::get<material::PhongModel>(phong.lobe).exponent, 1.0 / (2.0 * m * m));
      const auto he = make_material(s, r, Model::He);
      EXPECT_EQ(std::get<material::HeModel>(he.lobe).sigma, r.sigma);
    }
  EXPECT_THROW((void)find_substance("unobtainium"), Error);
}

material::Material body(double reflectance) {
  material::Material m;
  m.body_reflectance = reflectance;
  return m;
}

TEST(MaterialStudy, LobeDifferenceOfKnownLobes) {
  const LobeSurface half(body(0.5)), less(body(0.4));
  const LobeDifference same = lobe_difference(half, half, 45.0);
  EXPECT_EQ(same.strict, 0.0);
  EXPECT_EQ(same.seen, 0.0);
  EXPECT_NEAR(same.albedo, 0.5, 1e-3);
  const LobeDifference d = lobe_difference(half, less, 45.0);
  EXPECT_NEAR(d.strict, 0.2, 1e-5);
  EXPECT_NEAR(d.seen, 0.2, 1e-5);

  // A mirror and a lobe much narrower than a patch: nothing in common, but they look the same.
  material::Material mirror, narrow;
  for (material::Material* m : {&mirror, &narrow}) m->k_df = 0.0, m->k_rg = 1.0;
  narrow.c = 100.0;
  const LobeDifference look = lobe_difference(LobeSurface(mirror), LobeSurface(narrow), 45.0);
  EXPECT_NEAR(look.strict, 2.0, 0.02);
  EXPECT_NEAR(look.seen, 0.0, 0.01);
  EXPECT_EQ(look.mirror, 1.0);
  EXPECT_EQ(look.other_mirror, 0.0);
}

/// Two halves around `mean` with independent noise.
RenderedTile noisy(double mean, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0.0f, static_cast<float>(noise));
  RenderedTile tile;
  for (scene::Image& half : tile.half) {
    half.width = half.height = 100;
    half.channels = {"R", "G", "B"};
    for (int i = 0; i < 30000; ++i)
      half.pixels.push_back(static_cast<float>(mean) + normal(random));
  }
  tile.subject.assign(10000, true);
  return tile;
}

TEST(MaterialStudy, NoiseIsNoDifference) {
  const RenderedTile reference = noisy(1.0, 0.0, 1);
  const ImageDifference exact = difference(noisy(1.1, 0.0, 2), reference);
  EXPECT_NEAR(exact.error, 0.1 / 1.05, 1e-6);
  EXPECT_NEAR(exact.rmse, 0.1, 1e-6);
  EXPECT_NEAR(exact.bias, 0.1, 1e-6);
  EXPECT_NEAR(exact.noise, 0.0, 1e-9);

  const ImageDifference equal = difference(noisy(1.0, 0.2, 3), reference);
  EXPECT_NEAR(equal.noise, 0.2 / std::sqrt(2.0) / 1.05, 0.003);
  EXPECT_LT(equal.error, 0.03) << "a tenth of the noise of a half";
  EXPECT_LT(equal.high, 0.04);
  const ImageDifference shifted = difference(noisy(1.1, 0.2, 4), reference);
  EXPECT_NEAR(shifted.error, 0.1 / 1.05, 0.006);
  EXPECT_GT(shifted.high, shifted.error);
}

TEST(MaterialStudy, VerdictNeedsTheBoundBelowTheError) {
  std::vector<WaveResult> results(3);
  const double sigmas[] = {1.0, 0.1, 6.0}, highs[] = {0.04, 0.06, 0.01};
  for (std::size_t i = 0; i < 3; ++i) {
    results[i].wave = {grey_substance("metal", 1.0, 5.0), 10.0, sigmas[i]};
    results[i].image.low = highs[i] - 0.02;
    results[i].image.high = highs[i];
  }
  const Verdict v = verdict(results, "metal", 10.0, 0.05);
  EXPECT_EQ(v.looked_at, (std::vector<double>{0.1, 1.0})) << "the steep one is left out";
  using Answer = Verdict::Answer;
  EXPECT_EQ(v.does, (std::vector<Answer>{Answer::Open, Answer::Yes}));
  EXPECT_EQ(verdict(results, "metal", 10.0, 0.03).does,
            (std::vector<Answer>{Answer::No, Answer::Open}));
}

TEST(MaterialStudy, WritesTheSamePicturesAndTablesAgain) {
  ::unsetenv("DISPLAY");
  if (!plot::plot_available()) GTEST_SKIP() << "built without VTK";
  const TempFolder folder;
  const std::filesystem::path folders[] = {folder / "one", folder / "two"};
  StudyOptions options;
  options.materials = {"gold"};
  options.tile = {.width = 24, .height = 16, .samples = 2, .seed = 1};
  options.quick = true;
  options.command = "atrium material compare -o docs";
  std::string texts[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const scene::ThreadLimit threads(i == 0 ? 1 : 2);
    options.folder = folders[i];
    std::filesystem::create_directory(folders[i]);
    const StudyResult r = run_study(options, {});
    EXPECT_TRUE(r.complete);
    ASSERT_EQ(r.surfaces.size(), 3u);
    EXPECT_EQ(r.waves.size(), 3u);
    texts[i] = read_file(folders[i] / "material-study.md");
    texts[i].resize(std::min(texts[i].size(), texts[i].find("## Time")));
  }
  EXPECT_EQ(texts[0], texts[1]);
  EXPECT_NE(texts[0].find("atrium material compare -o docs"), std::string::npos);
  for (const char* row : {"| gold, rough | Cook-Torrance |", "| metal, tau = 10 lambda | 0.3 |"})
    EXPECT_NE(texts[0].find(row), std::string::npos) << row;
  for (const char* name :
       {"gold-sphere", "gold-box-room", "lobes-gold", "waves", "waves-error", "waves-lobes"}) {
    const std::string file = std::string("images/study/") + name + ".png";
    EXPECT_NE(texts[0].find("(" + file + ")"), std::string::npos) << file;
    const std::string first = read_file(folders[0] / file);
    EXPECT_GT(first.size(), 1000u) << file;
    EXPECT_EQ(first, read_file(folders[1] / file)) << file;
  }
}

TEST(MaterialStudy, InterruptedItWritesNoText) {
  ::unsetenv("DISPLAY");
  if (!plot::plot_available()) GTEST_SKIP() << "built without VTK";
  const TempFolder folder;
  std::stop_source stop;
  stop.request_stop();
  StudyOptions options;
  options.folder = folder.path();
  const StudyResult r = run_study(options, {.progress = {}, .stop = stop.get_token()});
  EXPECT_FALSE(r.complete);
  EXPECT_FALSE(std::filesystem::exists(folder / "material-study.md"));
}

TEST(MaterialStudy, RefusesUnknownMaterialsAndMissingFolders) {
  const TempFolder folder;
  StudyOptions options;
  options.folder = folder.path();
  options.materials = {"adamant"};
  EXPECT_THROW((void)run_study(options, {}), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "images"));
  options.folder = folder / "missing";
  options.materials = {};
  if (plot::plot_available()) {
    EXPECT_THROW((void)run_study(options, {}), Error);
  }
}

}  // namespace
