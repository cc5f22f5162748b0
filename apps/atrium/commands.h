#pragma once

#include <stop_token>

#include "options.h"

namespace atrium::app {

// One file per subcommand. They return the exit code and throw Error or RuntimeFailure.
int run_render(const RenderCommand& command, std::stop_token stop);
int run_solve(const SolveCommand& command, std::stop_token stop);
int run_export(const ExportCommand& command, std::stop_token stop);
int run_reweight(const ReweightCommand& command);
int run_measure(const MeasureCommand& command, std::stop_token stop);
int run_info(const InfoCommand& command, std::stop_token stop);
int run_compare(const CompareCommand& command);
int run_material_eval(const MaterialEvalCommand& command);
int run_material_derive(const MaterialDeriveCommand& command);
int run_material_list(const MaterialListCommand& command);
int run_material_show(const MaterialShowCommand& command);
int run_material_compare(const MaterialCompareCommand& command, std::stop_token stop);

inline constexpr int kInterrupted = 130;

}  // namespace atrium::app
