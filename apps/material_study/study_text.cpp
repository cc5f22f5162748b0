#include "material_study/study_text.h"

namespace atrium::study::text {

std::string introduction(const StudyOptions& options) {
  return "# The material model beside others\n\n```sh\n" + options.command + "\n```\n\n";
}
std::string findings(const StudyOptions&, const StudyResult&) { return ""; }
std::string setup() { return ""; }
std::string measures() { return ""; }
std::string about_pictures() { return ""; }
std::string about_lobes() { return ""; }
std::string about_differences() { return ""; }
std::string about_waves() { return ""; }
std::string about_verdict() { return ""; }
std::string about_times() { return ""; }

}  // namespace atrium::study::text
