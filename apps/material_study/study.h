#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "material_study/lobes.h"
#include "material_study/tile.h"
#include "material_study/timing.h"
#include "material_study/waves.h"

namespace atrium::study {

struct StudyOptions {
  std::filesystem::path folder;        ///< gets material-study.md and images/study/*.png
  std::vector<std::string> materials;  ///< empty: all
  TileOptions tile;
  bool quick = false;   ///< fewer models and wave cases
  std::string command;  ///< that makes it again, for the text
};

/// One model on one surface.
struct ModelResult {
  Model model = Model::Facets;
  ImageDifference image[3];  ///< by Stage; only those rendered
  bool rendered[3] = {false, false, false};
  LobeDifference lobe;  ///< at 45 degrees, reference: facets
};
struct SurfaceResult {
  std::string substance;
  Roughness roughness;
  std::vector<ModelResult> models;  ///< without the reference
  double noise[3] = {0.0, 0.0, 0.0};
};
struct Picture {
  std::string file;  ///< relative to the folder
  std::string caption;
};
struct StudyResult {
  std::vector<SurfaceResult> surfaces;
  std::vector<Timing> timings;
  std::vector<WaveResult> waves;
  std::vector<Picture> sheets, lobes, wave_pictures;
  bool complete = true;
};

/// Renders, compares, writes pictures and the text. Everything but the times is the same for the
/// same options at any number of threads. Interrupted: pictures that are finished stay, no text.
/// \throws Error  for unknown materials, folders that are not there.
StudyResult run_study(const StudyOptions& options, const scene::Control& control);

/// The study as Markdown.
[[nodiscard]] std::string report(const StudyOptions& options, const StudyResult& result);

}  // namespace atrium::study
