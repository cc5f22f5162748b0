#pragma once

#include <string>

#include "material_study/study.h"

// The words of the study.
namespace atrium::study::text {

[[nodiscard]] std::string introduction(const StudyOptions& options);
/// Only of the whole study: what follows from its numbers.
[[nodiscard]] std::string findings(const StudyOptions& options, const StudyResult& result);
[[nodiscard]] std::string setup();
[[nodiscard]] std::string measures();
[[nodiscard]] std::string about_pictures();
[[nodiscard]] std::string about_lobes();
[[nodiscard]] std::string about_differences();
[[nodiscard]] std::string about_waves();
[[nodiscard]] std::string about_verdict(const StudyOptions& options);
[[nodiscard]] std::string about_times();

}  // namespace atrium::study::text
