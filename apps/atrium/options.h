#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/effort.h"
#include "scene/camera.h"
#include "scene/light_groups.h"
#include "trace/render.h"
#include "trace/tone_map.h"

// What the command line says, as values. Every default exists once: here.
namespace atrium::app {

struct CommonOptions {
  int threads = 0;  ///< 0: one per core
  bool quiet = false;
  bool verbose = false;
  std::string stats;         ///< JSON file; empty: none
  std::string command_line;  ///< as typed, for metadata
};

struct SceneOptions {
  std::vector<std::string> files;
  double nits_per_emissive_unit = 1.0;
  bool pane_detection = true;
  std::string spectrum = "auto";
};

enum class SolverChoice { Rows, Shooting, Matrix };
enum class IndirectChoice { Auto, Mesh, Gather };

/// A picture that a solution is made for.
struct PictureView {
  scene::Camera camera;
  double aspect = 4.0 / 3.0;
  std::array<double, 4> crop{0.0, 0.0, 1.0, 1.0};
};

struct SolveSettings {
  SolverChoice solver = SolverChoice::Rows;
  Quality quality = Quality::Normal;
  double time_limit = 0.0;    ///< [s] for everything but writing; 0: none
  double memory_limit = 0.0;  ///< [MB, 1e6 bytes] for scene and radiosity; 0: none
  std::uint64_t seed = 1;
  double error = 0.0;              ///< RMS of irradiance asked for; 0: the effort of the quality
  std::uint32_t max_elements = 0;  ///< 0: as the quality
  int probes = 0;                  ///< points of the certificate
  bool paper_weights = false;      ///< --mode paper
  scene::Grouping light_groups = scene::Grouping::One;
  bool keep_state = false;         ///< a solution is written, from which a later run may go on
  bool keep_rows = false;          ///< with the rows
  std::vector<PictureView> views;  ///< all that will use the solution; empty: anything may
};

struct RenderCommand {
  CommonOptions common;
  SceneOptions scene;
  SolveSettings solve;
  std::vector<std::string> outputs;
  std::string camera;  ///< name, index or "all"; empty: the first, or a view that is chosen
  std::optional<std::array<int, 2>> size;
  std::array<double, 4> crop{0.0, 0.0, 1.0, 1.0};
  trace::Method method = trace::Method::Hybrid;
  trace::Mode mode = trace::Mode::Radiometric;
  IndirectChoice indirect = IndirectChoice::Auto;
  int samples = 0;           ///< 0: from the quality; with an error asked for the most
  double error = 0.0;        ///< RMS of the picture asked for, per pixel; 0: none
  double block_error = 0.0;  ///< ... after averaging 8x8 pixels
  bool components = false;
  bool classes = false;  ///< layers by class of light paths
  bool no_filter = false;
  trace::ToneMapOptions tone;
  std::string solution;  ///< read
  std::string save_solution;
  std::string checkpoint;  ///< read if it is there, written
  // A walk: many views along a path.
  std::string path;         ///< file; empty: no walk
  int frames = 0;           ///< 0: as fps says
  double fps = 0.0;         ///< [1/s], for a path with times; 0: as frames says
  std::string frame_range;  ///< A-B, from 1; empty: all
  std::string preview;      ///< picture so far, rewritten; empty: none
};

/// How files for other programs are written.
struct ExportSettings {
  std::optional<double> ev;    ///< absent: automatic
  std::uint32_t lightmap = 0;  ///< edge of the atlas of .glb [texels]; 0: vertex colours
  bool group_colours = false;  ///< of .glb: the light of every group, too
  std::string title;           ///< of web pages
};

struct SolveCommand {
  CommonOptions common;
  SceneOptions scene;
  SolveSettings solve;
  ExportSettings exports;
  std::string solution;  ///< to go on from; may be empty
  std::vector<std::string> outputs;
};

/// `atrium export`.
struct ExportCommand {
  CommonOptions common;
  SceneOptions scene;
  ExportSettings exports;
  bool paper_weights = false;  ///< --mode paper
  std::string solution;
  std::vector<std::string> outputs;
};

/// `atrium reweight`.
struct ReweightCommand {
  std::string solution;
  std::vector<std::pair<std::string, double>> factors;  ///< by group
  std::string output;
};

/// A parallelogram cut into cells[0] x cells[1] cells.
struct SensorGrid {
  std::array<double, 3> origin{}, u{}, v{};  ///< corner and edges [m]
  std::array<int, 2> cells{};
};

struct MeasureCommand {
  CommonOptions common;
  SceneOptions scene;
  SolveSettings solve;
  // Where: one of these.
  std::string points;  ///< file
  std::optional<SensorGrid> grid;
  std::optional<double> work_plane;  ///< height y [m]
  double spacing = 0.25;             ///< of the work plane [m]
  double error = 0.01;               ///< relative standard error of a sensor
  std::string output;                ///< .csv .json; empty: CSV on standard output
  std::string solution;              ///< read
};

struct InfoCommand {
  SceneOptions scene;
  bool json = false;
};

struct CompareCommand {
  std::string image, reference;
  std::string difference;   ///< output, may be empty
  double full_scale = 0.2;  ///< of a difference shown in 8 bits
  bool json = false;
};

/// `atrium material eval`.
struct MaterialEvalCommand {
  std::string input = "-";  ///< "-": standard input
  std::string output;       ///< empty: standard output
  std::string kinds;        ///< "markdown" or "json": describe the queries instead
};

/// `atrium material derive`.
struct MaterialDeriveCommand {
  double sigma = 0.0, tau = 0.0;  ///< [m]
  std::string material;           ///< name of a table; empty: n and kappa
  double n = 1.5, kappa = 0.0;
  std::vector<double> wavelengths_nm;
  double scattering = 0.0;  ///< of the bulk [1/m]
  double thickness = 0.0;   ///< [m]
  bool json = false, csv = false;
};

/// `atrium material list`.
struct MaterialListCommand {
  bool json = false;
};

/// `atrium material show`.
struct MaterialShowCommand {
  std::string name;
  std::string output;  ///< picture, .svg or .png; may be empty
  bool json = false;
};

/// `atrium material compare`.
struct MaterialCompareCommand {
  CommonOptions common;
  std::string folder;                  ///< is there already
  std::vector<std::string> materials;  ///< empty: all
  std::array<int, 2> size{80, 60};     ///< of a picture
  int samples = 64;                    ///< of a pixel, even
  std::uint64_t seed = 1;
  bool quick = false;
};

/// Nothing left to do but to leave with a code (help, version, configuration printed).
struct Finished {
  int code = 0;
};

using Command = std::variant<Finished, RenderCommand, SolveCommand, ExportCommand, ReweightCommand,
                             MeasureCommand, InfoCommand, CompareCommand, MaterialEvalCommand,
                             MaterialDeriveCommand, MaterialListCommand, MaterialShowCommand,
                             MaterialCompareCommand>;

/// \throws Error  on wrong usage, one line.
[[nodiscard]] Command parse_command_line(int argc, char** argv);

}  // namespace atrium::app
