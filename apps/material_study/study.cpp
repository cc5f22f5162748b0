#include "material_study/study.h"

#include <fstream>

#include "material/error.h"
#include "material_study/lobe_plots.h"
#include "scene/output_file.h"

namespace atrium::study {

namespace {

namespace fs = std::filesystem;

constexpr const char* kPictures = "images/study";

/// Renders and counts; throws nothing on interrupts, but says so.
class Run {
 public:
  Run(const StudyOptions& options, const scene::Control& control)
      : options_(options), control_(control) {
    for (const std::string& name : options.materials) substances_.push_back(find_substance(name));
    if (substances_.empty()) substances_ = substances();
  }

  StudyResult all() {
    count_steps();
    for (const Substance& s : substances_) {
      if (!stopped()) compare_substance(s);
      if (s.transparent && !stopped()) show_solids(s);
    }
    if (!stopped()) compare_with_waves();
    if (!stopped()) {
      control_.report("timing", 0.0);
      result_.timings = measure_timings(roughnesses()[1]);
    }
    result_.complete = !stopped();
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool stopped() const { return control_.stop_requested(); }
  [[nodiscard]] std::vector<Model> models_on(Stage stage, const Substance& s) const {
    return stage == Stage::Sphere && !options_.quick ? all_models(s) : main_models();
  }

  void count_steps() {
    steps_ = wave_cases(options_.quick).size() * 4;
    for (const Substance& s : substances_) {
      for (const Stage stage : kStages) steps_ += models_on(stage, s).size() * roughnesses().size();
      if (s.transparent) steps_ += 2 * roughnesses().size() * 2;
    }
  }
  void step(const std::string& what, std::size_t count = 1) {
    control_.report("study", static_cast<double>(done_) / static_cast<double>(steps_), what);
    done_ += count;
  }

  RenderedTile render(const Substance& s, const Roughness& r, Model model, Stage stage) {
    step(s.name + ", " + r.name + ", " + name_of(model) + ", " + name_of(stage));
    return render_tile(stage, make_material(s, r, model), mode_of(model),
                       material::SpectralBasis::rgb(), options_.tile, control_);
  }

  void write(const std::vector<plot::Panel>& panels, const plot::Picture& picture,
             const std::string& name, const std::string& caption, std::vector<Picture>& list) {
    const std::string file = std::string(kPictures) + "/" + name + ".png";
    plot::write_plot(options_.folder / file, panels, picture);
    list.push_back({file, caption});
  }
  void write_sheet(const plot::SheetChart& sheet, const std::string& name,
                   const std::string& caption, std::vector<Picture>& list) {
    const auto [width, height] = plot::sheet_size(sheet);
    write({sheet}, {.width = width, .height = height, .columns = 1, .pixel_ratio = 1}, name,
          caption, list);
  }

  /// Rows of one roughness each.
  plot::SheetChart sheet_of(const std::string& title, const std::vector<Model>& models) {
    plot::SheetChart sheet;
    sheet.title = title;
    for (const Model m : models) sheet.columns.emplace_back(name_of(m));
    return sheet;
  }

  void compare_substance(const Substance& s) {
    std::vector<SurfaceResult> surfaces;
    for (const Roughness& r : roughnesses()) {
      surfaces.push_back({.substance = s.name, .roughness = r, .models = {}});
      for (const Model m : models_on(Stage::Sphere, s))
        if (m != Model::Facets) surfaces.back().models.emplace_back().model = m;
      compare_lobes(s, surfaces.back());
    }
    plot::SheetChart sphere = sheet_of(s.name + ": sphere", models_on(Stage::Sphere, s));
    plot::SheetChart rest = sheet_of(s.name + ": box and room", main_models());
    for (const Stage stage : kStages)
      for (SurfaceResult& surface : surfaces)
        compare_row(s, stage, surface, stage == Stage::Sphere ? sphere : rest);
    if (stopped()) return;
    write_sheet(sphere, s.name + "-sphere", "The sphere in " + s.name + ".", result_.sheets);
    write_sheet(rest, s.name + "-box-room", "Box and room in " + s.name + ".", result_.sheets);
    write(lobe_panels(s), lobe_picture(), "lobes-" + s.name, "Lobes of " + s.name + ".",
          result_.lobes);
    result_.surfaces.insert(result_.surfaces.end(), surfaces.begin(), surfaces.end());
  }

  void compare_lobes(const Substance& s, SurfaceResult& surface) {
    const LobeSurface reference(make_material(s, surface.roughness, Model::Facets));
    for (ModelResult& m : surface.models)
      m.lobe = lobe_difference(
          reference, LobeSurface(make_material(s, surface.roughness, m.model), mode_of(m.model)),
          45.0);
  }

  void compare_row(const Substance& s, Stage stage, SurfaceResult& surface,
                   plot::SheetChart& sheet) {
    const auto at = static_cast<std::size_t>(stage);
    sheet.rows.push_back(std::string(name_of(stage)) + ", " + surface.roughness.name);
    RenderedTile reference;
    for (const Model model : models_on(stage, s)) {
      if (stopped()) return;
      const RenderedTile tile = render(s, surface.roughness, model, stage);
      sheet.tiles.push_back(show(tile));
      if (model == Model::Facets) {
        reference = tile;
        surface.noise[at] = difference(tile, tile).noise;
        continue;
      }
      for (ModelResult& m : surface.models) {
        if (m.model != model) continue;
        m.image[at] = difference(tile, reference);
        m.rendered[at] = true;
      }
    }
  }

  /// What the models of the literature cannot show: light that passes.
  void show_solids(const Substance& s) {
    const std::vector<Model> models{Model::Solid, Model::SolidPaper};
    plot::SheetChart sheet;
    sheet.title = "refracting " + s.name;
    for (const Stage stage : {Stage::Sphere, Stage::Box})
      for (const Model m : models)
        sheet.columns.push_back(std::string(name_of(stage)) + (m == Model::Solid ? "" : ", paper"));
    for (const Roughness& r : roughnesses()) {
      sheet.rows.push_back(r.name);
      for (const Stage stage : {Stage::Sphere, Stage::Box})
        for (const Model m : models) {
          if (stopped()) return;
          sheet.tiles.push_back(show(render(s, r, m, stage)));
        }
    }
    write_sheet(sheet, s.name + "-solid", "A refracting body of " + s.name + ".", result_.sheets);
  }

  void compare_with_waves() {
    for (const WaveCase& wave : wave_cases(options_.quick)) {
      if (stopped()) return;
      step("waves: " + wave.substance.name + ", sigma/lambda " + std::to_string(wave.sigma), 4);
      result_.waves.push_back(compare_waves(wave, options_.tile, control_));
    }
    if (stopped()) return;
    write_sheet(wave_sheet(result_.waves), "waves",
                "Facets and wave optics by sigma / lambda, grey, 555 nm.", result_.wave_pictures);
    write(wave_error_panels(result_.waves), wave_error_picture(), "waves-error",
          "Difference of facets and wave optics in lobe and picture.", result_.wave_pictures);
    write(wave_lobe_panels(options_.quick), wave_lobe_picture(), "waves-lobes",
          "Lobes of facets and wave optics (metal, 30 degrees).", result_.wave_pictures);
  }

  const StudyOptions& options_;
  const scene::Control& control_;
  std::vector<Substance> substances_;
  std::size_t steps_ = 1, done_ = 0;
  StudyResult result_;
};

void write_text(const fs::path& file, const std::string& text) {
  scene::OutputFile out(file);
  std::ofstream stream(out.path(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw RuntimeFailure(file.string() + ": writing failed");
  out.commit();
}

}  // namespace

StudyResult run_study(const StudyOptions& options, const scene::Control& control) {
  for (const std::string& name : options.materials) (void)find_substance(name);
  if (!fs::is_directory(options.folder))
    throw Error("-o " + options.folder.string() + ": is not a folder");
  if (!plot::plot_available())
    throw RuntimeFailure("material compare: pictures cannot be drawn (built without VTK)");
  std::error_code failed;
  fs::create_directories(options.folder / kPictures, failed);
  if (failed)
    throw Error((options.folder / kPictures).string() + ": cannot be made: " + failed.message());
  scene::check_output(options.folder / "material-study.md");
  StudyResult result = Run(options, control).all();
  if (result.complete) write_text(options.folder / "material-study.md", report(options, result));
  return result;
}

}  // namespace atrium::study
