#include "fuzz/readers.h"
#include "mesh.h"
#include "scene/mesh_io.h"

namespace atrium::fuzz {
namespace {

/// As the viewer and `atrium info` do.
void read(const std::filesystem::path& file) {
  static_cast<void>(view::read_mesh(file));
  static_cast<void>(scene::summarise_mesh_file(file));
}

}  // namespace

void read_vtp(const std::filesystem::path& folder, Bytes input) {
  read(put(folder, "input.vtp", input));
}
void read_vtu(const std::filesystem::path& folder, Bytes input) {
  read(put(folder, "input.vtu", input));
}

}  // namespace atrium::fuzz
