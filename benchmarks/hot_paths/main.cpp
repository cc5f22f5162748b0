// Rays against bare Embree, look-ups in a solved field, choice of lights, solving of rows: one
// thread.
//
//   hot_paths --benchmark_format=json --benchmark_repetitions=5
//   --benchmark_enable_random_interleaving=true
#include <benchmark/benchmark.h>

#include "hot_paths.h"
#include "scene/parallel.h"

int main(int argc, char** argv) {
  const atrium::scene::ThreadLimit one(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  atrium::bench::register_rays();
  atrium::bench::register_look_ups();
  atrium::bench::register_lights();
  atrium::bench::register_rows();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
