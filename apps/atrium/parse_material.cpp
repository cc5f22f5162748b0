#include "command_parser.h"
#include "option_text.h"
#include "shared_options.h"

namespace atrium::app {

namespace {

/// `atrium material ...`: a subcommand each.
class MaterialParser : public CommandParser {
 public:
  void add_to(CLI::App& material) override {
    material.require_subcommand(1);
    material.fallthrough();
    add_eval(*material.add_subcommand("eval", "answer queries: a JSON array in, a JSON array out"));
    add_derive(*material.add_subcommand("derive", "the model's parameters of a surface as made"));
    material.add_subcommand("list", "materials and illuminants known")
        ->add_flag("--json", list_.json, "for programs");
    add_show(*material.add_subcommand("show", "data sheet of a material"));
    add_compare(*material.add_subcommand(
        "compare", "study: this model beside others, in pictures, lobes, numbers and times"));
  }

  Command finish(const CLI::App& material, const std::string& command_line) override {
    const CLI::App& sub = *material.get_subcommands().front();
    const std::string& name = sub.get_name();
    if (name == "eval") return eval_;
    if (name == "derive") return finished_derive(sub);
    if (name == "list") return list_;
    if (name == "compare") return finished_compare(command_line);
    return show_;
  }

 private:
  void add_eval(CLI::App& sub) {
    sub.add_option("queries", eval_.input, "JSON file; -: standard input")
        ->type_name("FILE")
        ->capture_default_str();
    sub.add_option("-o,--output", eval_.output, "answers; default: standard output")
        ->type_name("FILE");
    sub.add_option("--kinds", eval_.kinds,
                   "describe all kinds of queries instead: markdown or json")
        ->check(CLI::IsMember({"markdown", "json"}));
  }

  void add_derive(CLI::App& sub) {
    sub.add_option("--sigma", sigma_, "rms height: 0.2um, 200nm, 2e-7 [m]")
        ->required()
        ->type_name("LENGTH");
    sub.add_option("--tau", tau_, "correlation length of the heights")
        ->required()
        ->type_name("LENGTH");
    CLI::Option* material =
        sub.add_option("--material", derive_.material, "named optical constants")
            ->type_name("NAME");
    sub.add_option("--n", derive_.n, "absolute index of refraction")
        ->check(CLI::Range(1e-6, 1e6))
        ->excludes(material);
    sub.add_option("--kappa", derive_.kappa, "index of absorption k/n")
        ->check(CLI::Range(0.0, 1e6))
        ->excludes(material)
        ->capture_default_str();
    sub.add_option("--wavelengths", wavelengths_, "in vacuum [nm]: FIRST:LAST:STEP or A,B,C")
        ->type_name("NM")
        ->capture_default_str();
    sub.add_option("--mu-s", derive_.scattering, "scattering of the bulk [1/m]")
        ->check(CLI::Range(0.0, 1e12))
        ->capture_default_str();
    sub.add_option("--thickness", thickness_, "of a transmitting body")
        ->type_name("LENGTH")
        ->capture_default_str();
    CLI::Option* json = sub.add_flag("--json", derive_.json, "for programs");
    sub.add_flag("--csv", derive_.csv, "for tables")->excludes(json);
  }
  [[nodiscard]] MaterialDeriveCommand finished_derive(const CLI::App& sub) const {
    MaterialDeriveCommand o = derive_;
    o.sigma = parse_length("--sigma", sigma_);
    o.tau = parse_length("--tau", tau_);
    if (!(o.tau > 0.0)) throw Error("--tau " + tau_ + ": must be above 0");
    o.thickness = parse_length("--thickness", thickness_);
    o.wavelengths_nm = parse_wavelengths(wavelengths_);
    if (o.material.empty() && sub.count("--n") == 0)
      throw Error("--material NAME, or --n N and --kappa K, is required");
    return o;
  }

  void add_show(CLI::App& sub) {
    sub.add_option("name", show_.name, "see atrium material list")->required()->type_name("NAME");
    sub.add_option("-o,--output", show_.output, "picture of curves and colours: .svg .png")
        ->type_name("FILE");
    sub.add_flag("--json", show_.json, "for programs");
  }

  void add_compare(CLI::App& sub) {
    sub.add_option("-o,--output", compare_.folder,
                   "folder; gets material-study.md and images/study/*.png")
        ->required()
        ->type_name("DIR");
    sub.add_option("--materials", compare_.materials,
                   "some of gold,copper,aluminium,plastic,glass; default: all")
        ->delimiter(',')
        ->type_name("NAMES");
    sub.add_option("--size", compare_size_, "of each picture, 16x16 to 1000x1000")
        ->type_name("WxH")
        ->capture_default_str();
    sub.add_option("--samples", compare_.samples, "of a pixel")
        ->check(CLI::Range(2, 1 << 20))
        ->capture_default_str();
    cli::add_seed(sub, compare_.seed);
    sub.add_flag("--quick", compare_.quick, "fewer models and cases, for a try");
    cli::add_threads(sub, compare_.common.threads);
    cli::add_quiet(sub, compare_.common.quiet);
  }
  [[nodiscard]] MaterialCompareCommand finished_compare(const std::string& command_line) const {
    MaterialCompareCommand o = compare_;
    o.common.command_line = command_line;
    o.size = parse_size(compare_size_);
    for (const int side : o.size)
      if (side < 16 || side > 1000)
        throw Error("--size " + compare_size_ + ": is not within 16x16 and 1000x1000");
    return o;
  }

  MaterialEvalCommand eval_;
  MaterialDeriveCommand derive_;
  MaterialListCommand list_;
  MaterialShowCommand show_;
  MaterialCompareCommand compare_;
  std::string sigma_, tau_, thickness_ = "0", wavelengths_ = "380:780:10";
  std::string compare_size_ = "80x60";
};

}  // namespace

std::unique_ptr<CommandParser> material_parser() { return std::make_unique<MaterialParser>(); }

}  // namespace atrium::app
