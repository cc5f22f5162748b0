#include "commands.h"
#include "material_study/study.h"
#include "session.h"

namespace atrium::app {

int run_material_compare(const MaterialCompareCommand& c, std::stop_token stop) {
  Session session(c.common, std::move(stop));
  study::StudyOptions options;
  options.folder = c.folder;
  options.materials = c.materials;
  options.tile = {.width = c.size[0], .height = c.size[1], .samples = c.samples, .seed = c.seed};
  options.quick = c.quick;
  options.command = c.common.command_line;
  const study::StudyResult result = study::run_study(options, session.control("study"));
  if (!result.complete) return kInterrupted;
  session.progress.note("wrote " + (options.folder / "material-study.md").string());
  return 0;
}

}  // namespace atrium::app
