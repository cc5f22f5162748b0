// What the program `atrium` reads beside models: sensors, and options in a file.
#include <array>
#include <string>

#include "atrium/options.h"
#include "fuzz/readers.h"
#include "material_query/query.h"
#ifdef ATRIUM_WITH_RADIOSITY
#include "atrium/sensor_file.h"
#endif

namespace atrium::fuzz {
namespace {

/// A command line that is complete but for options, by the section that the file begins with.
std::vector<std::string> command_line(Bytes config) {
  const std::string text(config.begin(), config.end());
  if (text.starts_with("[solve]")) return {"solve", "a.glb", "-o", "a.vtp"};
  if (text.starts_with("[measure]")) return {"measure", "a.glb"};
  if (text.starts_with("[compare]")) return {"compare", "a.pfm", "b.pfm"};
  if (text.starts_with("[material.derive]")) return {"material", "derive"};
  return {"render", "a.glb", "-o", "a.pfm"};
}

}  // namespace

void read_config(const std::filesystem::path& folder, Bytes input) {
  std::vector<std::string> words = command_line(input);
  words.insert(words.begin(), "atrium");
  words.insert(words.end(), {"--config", put(folder, "input.ini", input).string()});
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  static_cast<void>(app::parse_command_line(static_cast<int>(pointers.size()), pointers.data()));
}

void read_material(const std::filesystem::path&, Bytes input) {
  static_cast<void>(material_query::answer_queries(std::string(input.begin(), input.end())));
}

#ifdef ATRIUM_WITH_RADIOSITY
void read_sensors(const std::filesystem::path& folder, Bytes input) {
  static_cast<void>(app::read_sensors(put(folder, "input.csv", input).string()));
}
#endif

}  // namespace atrium::fuzz
