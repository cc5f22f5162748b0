// Ray rate of the radiosity pass against bare Embree on the same rays in the same run: hemisphere
// rays of the elements of a 16-room building, ROBUST scene, CPU time of one thread. Every round
// runs all cases in turn; printed are medians over the rounds, of rates and of ratios by round.
//
// Then the parallel efficiency of trace_rows: measured at 2 threads if nothing else runs, and by
// the times of its chunks put onto more threads: each takes the next chunk, all wait after a wave.
//
//   row_rays [--rounds N] [--sides N] [--rays N] [--size METRES]
#include <ctime>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "bare_embree.h"
#include "building.h"
#include "hemisphere.h"
#include "passes.h"

namespace {

using namespace atrium;
using namespace atrium::radiosity;
using scene::Counter;
using scene::Counters;
using scene::Ray;

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double wall_seconds() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

struct Case {
  std::string name;
  std::function<std::size_t()> run;  ///< returns the rays traced
  std::vector<double> rates{};       ///< [Mray/s], by round
};

void print(std::vector<Case>& cases, int rounds) {
  for (int round = 0; round < rounds; ++round)
    for (Case& c : cases) {
      const double start = cpu_seconds();
      const std::size_t rays = c.run();
      c.rates.push_back(1e-6 * static_cast<double>(rays) / (cpu_seconds() - start));
    }
  std::printf(
      "\n| rays of one thread | Mray/s | ns per ray | cost against bare |\n"
      "| --- | ---: | ---: | ---: |\n");
  for (const Case& c : cases) {
    std::vector<double> ratio(c.rates.size());
    for (std::size_t r = 0; r < ratio.size(); ++r) ratio[r] = cases[0].rates[r] / c.rates[r];
    const double rate = median(c.rates);
    std::printf("| %s | %.2f | %.0f | %.2f |\n", c.name.c_str(), rate, 1e3 / rate, median(ratio));
  }
}

/// Runs of 128 sides in order, as a chunk of a solve has them, from everywhere in the scene.
std::vector<SideIndex> spread(const std::vector<SideIndex>& all, std::size_t count) {
  constexpr std::size_t kRun = 128;
  const std::size_t runs = all.size() / kRun;
  const std::size_t wanted = std::clamp<std::size_t>(count / kRun, 1, runs);
  std::vector<SideIndex> some;
  for (std::size_t r = 0; r < wanted; ++r) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(r * runs / wanted * kRun);
    some.insert(some.end(), first, first + kRun);
  }
  return some;
}

template <int N>
void measure(const scene::RayQuery& query, const material::SpectralBasis& basis, int rounds,
             std::size_t sides, int per_side, double size) {
  const scene::Scene& scene = query.scene();
  const scene::Shading<N> shading(query, basis);
  const SolveOptions options{.element_size = size, .row_rays = 0, .gather_rays = per_side};
  const Elements elements = make_elements(scene, {.element_size = size});
  Problem<N> problem(shading, elements, options);
  std::vector<SideIndex>& active = problem.sides.active;
  std::printf("\n%d lane(s): %llu triangles, %zu elements, %zu sides; ", N,
              static_cast<unsigned long long>(scene.triangle_count()),
              elements.layout.element_count(), active.size());
  active = spread(active, sides);
  std::vector<Ray> rays;
  const auto generate = [&] {
    rays.clear();
    for (const SideIndex i : active)
      for (int first = 0; first < per_side; first += HemisphereRays<N>::kMost) {
        const HemisphereRays<N> some(problem, i, options.seed, i, static_cast<std::uint32_t>(first),
                                     std::min(HemisphereRays<N>::kMost, per_side - first));
        for (std::size_t k = 0; k < some.size(); ++k) rays.push_back(some.ray(k));
      }
    return rays.size();
  };
  generate();
  std::printf("%zu rays, %d per side\n", rays.size(), per_side);

  const bench::BareEmbree bare(scene);
  const scene::Control control;
  Work work(control, 0.0);
  Counters counters;
  const std::vector<std::uint8_t> all(active.size(), 1);
  const SideValues<N> field(problem.side_count(), Spectrum<N>::one());
  std::size_t hits = 0;
  const auto counted = [&](auto&& f) {
    return [&rays, &hits, f] {
      hits += f();
      return rays.size();
    };
  };
  const auto group = static_cast<std::size_t>(per_side);
  std::vector<Case> cases{
      {"bare rtcIntersect1", counted([&] { return bare.single(rays); })},
      {"bare rtcIntersect8, sorted by octant", counted([&] { return bare.packets(rays, group); })},
      {"bare rtcIntersect1M", counted([&] { return bare.stream(rays, group); })},
      {"RayQuery::closest", counted([&] {
         std::size_t n = 0;
         for (const Ray& r : rays) n += query.closest(r, counters, Counter::RaysRow) ? 1U : 0U;
         return n;
       })},
      {"making the rays", generate},
      {"trace_rows",
       [&] {
         Counters c;
         const Rows<N> rows = trace_rows<N>(problem, {}, {}, all, 0, per_side, work, c);
         hits += rows.entries.size();
         return static_cast<std::size_t>(c[Counter::RaysRow]);
       }},
      {"gather", [&] {
         Counters c;
         Tally<N> tally(problem.side_count(), 1, problem.sides.any_coupled);
         sample_gather<N>(problem, {field}, {}, {}, top_up(problem, tally, active, per_side), tally,
                          work, c);
         hits += tally.valid(active.front());
         return static_cast<std::size_t>(c[Counter::RaysRow]);
       }}};
  print(cases, rounds);
  std::printf("(%zu)\n", hits);  // keeps the compiler from leaving anything out
}

/// Time that `threads` take for the chunks in waves of `wave`.
double schedule(const std::vector<double>& chunks, std::size_t wave, std::size_t threads) {
  double total = 0.0;
  for (std::size_t first = 0; first < chunks.size(); first += wave) {
    std::vector<double> busy(threads, 0.0);
    for (std::size_t c = first; c < std::min(first + wave, chunks.size()); ++c)
      *std::min_element(busy.begin(), busy.end()) += chunks[c];
    total += *std::max_element(busy.begin(), busy.end());
  }
  return total;
}

void measure_parallel(const scene::RayQuery& query, int per_side, double size) {
  constexpr std::size_t kGrain = 32;  // of trace_rows
  const scene::Shading<1> shading(query, material::SpectralBasis::grey());
  const SolveOptions options{.element_size = size};
  const Elements elements = make_elements(query.scene(), {.element_size = size});
  Problem<1> problem(shading, elements, options);
  const std::vector<SideIndex> all = problem.sides.active;
  const scene::Control control;
  Work work(control, 0.0);
  Counters counters;
  const auto trace = [&](bool wanted) {
    const std::vector<std::uint8_t> sides(problem.sides.active.size(), wanted ? 1 : 0);
    return trace_rows<1>(problem, {}, {}, sides, 0, per_side, work, counters).entries.size();
  };
  double wall[2] = {}, cpu[2] = {};
  for (const int threads : {1, 2}) {
    const scene::ThreadLimit limit(threads);
    const double start = wall_seconds(), cpu_start = cpu_seconds();
    (void)trace(true);
    wall[threads - 1] = wall_seconds() - start;
    cpu[threads - 1] = cpu_seconds() - cpu_start;
  }
  std::printf("\nall %zu sides: wall %.2f s and CPU %.2f s at 1 thread, %.2f and %.2f at 2\n",
              all.size(), wall[0], cpu[0], wall[1], cpu[1]);

  const scene::ThreadLimit one(1);
  const auto least_of_three = [&](bool wanted) {
    double least = 1e30;
    for (int i = 0; i < 3; ++i) {
      const double start = cpu_seconds();
      (void)trace(wanted);
      least = std::min(least, cpu_seconds() - start);
    }
    return least;
  };
  // All but rays and entries, as if none of it were parallel: an upper bound of what is serial. The
  // entries are put together by all threads.
  const double serial = least_of_three(false);
  std::vector<double> chunks;
  double sum = 0.0;
  for (std::size_t first = 0; first < all.size(); first += kGrain) {
    problem.sides.active.assign(
        all.begin() + static_cast<std::ptrdiff_t>(first),
        all.begin() + static_cast<std::ptrdiff_t>(std::min(first + kGrain, all.size())));
    chunks.push_back(least_of_three(true));
    sum += chunks.back();
  }
  std::printf("%zu chunks of %.2f ms, longest %.2f ms; serial at most %.1f ms\n\n", chunks.size(),
              1e3 * sum / static_cast<double>(chunks.size()),
              1e3 * *std::max_element(chunks.begin(), chunks.end()), 1e3 * serial);
  std::printf(
      "| threads | efficiency, waves of 256 chunks | waves of 64 |\n"
      "| ---: | ---: | ---: |\n");
  for (const std::size_t threads : {2U, 4U, 8U, 16U, 32U, 64U}) {
    const auto efficiency = [&](std::size_t wave) {
      return 100.0 * (sum + serial) /
             (static_cast<double>(threads) * (schedule(chunks, wave, threads) + serial));
    };
    std::printf("| %zu | %.0f %% | %.0f %% |\n", threads, efficiency(Work::kWave), efficiency(64));
  }
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 7, rays = 64;
  std::size_t sides = 8000;
  double size = 0.2;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--rounds") rounds = std::max(1, std::atoi(argv[i + 1]));
    if (name == "--rays") rays = std::max(8, std::atoi(argv[i + 1]));
    if (name == "--sides") sides = static_cast<std::size_t>(std::max(1, std::atoi(argv[i + 1])));
    if (name == "--size") size = std::max(0.01, std::atof(argv[i + 1]));
  }
  const scene::Scene scene = make_building();
  const scene::RayQuery query(scene);
  measure_parallel(query, rays, size);
  const scene::ThreadLimit one(1);
  measure<1>(query, material::SpectralBasis::grey(), rounds, sides, rays, size);
  measure<3>(query, material::SpectralBasis::rgb(), rounds, sides, rays, size);
}
