#include "write_text.h"

#include <fstream>

#include "material/error.h"
#include "scene/output_file.h"

namespace atrium::bench {

void write_text(const std::filesystem::path& file, const std::string& text) {
  scene::OutputFile out(file);
  std::ofstream stream(out.path(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw RuntimeFailure(file.string() + ": writing failed");
  out.commit();
}

}  // namespace atrium::bench
