#pragma once

#include <vector>

#include "material_study/waves.h"
#include "plot/plot.h"

// The study's charts.
namespace atrium::study {

/// Lobes of a substance at 45 degrees: smooth over the angle, medium and rough as polar charts.
[[nodiscard]] std::vector<plot::Panel> lobe_panels(const Substance& substance);
[[nodiscard]] plot::Picture lobe_picture();

/// Pictures by facets and by waves over sigma / lambda.
[[nodiscard]] plot::SheetChart wave_sheet(const std::vector<WaveResult>& results);
/// Errors over sigma / lambda.
[[nodiscard]] std::vector<plot::Panel> wave_error_panels(const std::vector<WaveResult>& results);
[[nodiscard]] plot::Picture wave_error_picture();
/// Lobes of some of the cases.
[[nodiscard]] std::vector<plot::Panel> wave_lobe_panels(bool quick);
[[nodiscard]] plot::Picture wave_lobe_picture();

/// "0.05", "10": without trailing zeros.
[[nodiscard]] std::string short_number(double value);

}  // namespace atrium::study
