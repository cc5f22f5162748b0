#include "commands.h"
#include "material/error.h"
#include "scene/output_file.h"
#include "scene/solution_io.h"

namespace atrium::app {

int run_reweight(const ReweightCommand& c) {
  if (scene::file_ending(c.output) != ".atrium")
    throw Error(c.output + ": unknown format (known: .atrium)");
  scene::check_output(c.output);
  scene::Solution solution = scene::read_solution(c.solution);
  if (solution.groups.empty())
    throw Error(c.solution +
                ": holds one light group only; solve with --light-groups, or name light_group in "
                "the scene");
  try {
    scene::dim(solution, c.factors);
  } catch (const Error& e) {
    throw Error(c.solution + ": " + e.what());
  }
  scene::write_solution(solution, c.output);
  return 0;
}

}  // namespace atrium::app
