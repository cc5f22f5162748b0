#include "relight.h"

#include <algorithm>

#include "light_archive.h"
#include "scene/archive.h"

namespace atrium::radiosity {

SideParents::SideParents(const std::vector<std::uint32_t>& parent, std::size_t sides)
    : parent_(parent), sides_(sides) {
  if (parent_.empty()) {
    whole_.assign(sides / 2, 1);
    return;
  }
  std::vector<std::uint32_t> parts;
  for (const std::uint32_t p : parent_) {
    if (p >= parts.size()) parts.resize(p + 1, 0);
    ++parts[p];
  }
  for (const std::uint32_t n : parts) whole_.push_back(n == 1 ? 1 : 0);
}

template <int N>
SideValues<N> without_first_light(SideValues<N> field, const HotPatches<N>& hot,
                                  std::size_t group) {
  for (const SideIndex i : hot.sides()) field[i] -= hot.source(i, group);
  return field;
}

template <int N>
std::vector<Spectrum<N>> hot_sums_of(const std::vector<Spectrum<N>>& hot, std::size_t groups,
                                     std::size_t group, std::size_t active) {
  std::vector<Spectrum<N>> sums(2 * active);
  if (hot.empty()) return sums;
  for (std::size_t k = 0; k < active; ++k)
    for (const std::size_t body : {0U, 1U})
      sums[2 * k + body] = hot[(k * groups + group) * 2 + body];
  return sums;
}

namespace {

/// What leaves every active side.
template <int N>
SideValues<N> leaving_all(const Problem<N>& problem, const SideValues<N>& field) {
  SideValues<N> b(problem.side_count());
  for (const SideIndex i : problem.sides.active)
    b[i] = leaving(problem.sides, i, field[i], field[i ^ 1U]);
  return b;
}

template <int N>
SideValues<N> difference(SideValues<N> a, const SideValues<N>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

template <int N>
RowMoments moments_of(const Rows<N>& rows, std::size_t k, const SideValues<N>& x,
                      const SideValues<N>& y) {
  const double n = rows.rays[k];
  if (n < 2.0) return {};
  double sx = 0.0, sy = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::uint64_t e = rows.first[k]; e < rows.first[k + 1]; ++e) {
    const SideIndex j = rows.entries[e].target & ~Rows<N>::kChromatic;
    const double w = static_cast<double>(rows.entries[e].weight) / n;
    const double vx = static_cast<double>(x[j].mean());
    const double vy = static_cast<double>(y[j].mean());
    sx += w * vx;
    sy += w * vy;
    xx += w * vx * vx;
    yy += w * vy * vy;
    xy += w * vx * vy;
  }
  return {std::max(0.0, xx - sx * sx) / (n - 1.0), std::max(0.0, yy - sy * sy) / (n - 1.0),
          (xy - sx * sy) / (n - 1.0)};
}

/// By active side.
template <int N>
std::vector<RowMoments> all_moments(const Rows<N>& rows, const SideValues<N>& x,
                                    const SideValues<N>& y) {
  std::vector<RowMoments> all(rows.size());
  scene::parallel_for(rows.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) all[k] = moments_of(rows, k, x, y);
  });
  return all;
}

/// Visits what is known near active side k beside itself: its neighbours, else the active sides of
/// the same object and facing before and after it, which lie close.
template <int N, class F>
void visit_near(const Problem<N>& problem, const Neighbours& neighbours, std::size_t k, F&& f) {
  const std::vector<SideIndex>& active = problem.sides.active;
  const SideIndex i = active[k];
  bool any = false;
  neighbours.visit(i, [&](SideIndex j) {
    if (problem.sides.is_active[j] == 0) return;
    any = true;
    f(static_cast<std::size_t>(std::lower_bound(active.begin(), active.end(), j) - active.begin()));
  });
  if (any) return;
  const Elements& elements = problem.elements;
  const auto object = [&](SideIndex j) {
    return elements.pieces[elements.first_piece[j / 2]].object.value;
  };
  constexpr std::size_t kReach = 4;
  for (std::size_t m = k - std::min(k, kReach); m < std::min(active.size(), k + kReach + 1); ++m)
    if (m != k && side_of(active[m]) == side_of(i) && object(active[m]) == object(i)) f(m);
}

}  // namespace

namespace {

using LightBytes = std::vector<char>;

LightBytes bytes_of_light(scene::Light light) {
  scene::ArchiveWriter writer;
  archive_light(writer, light);
  return std::move(writer.bytes);
}

/// The lights of `a` that are not in `b`.
std::vector<scene::Light> lights_without(const std::vector<scene::Light>& a,
                                         const std::vector<scene::Light>& b) {
  std::vector<LightBytes> others;
  others.reserve(b.size());
  for (const scene::Light& l : b) others.push_back(bytes_of_light(l));
  std::vector<scene::Light> rest;
  for (const scene::Light& l : a) {
    const auto it = std::find(others.begin(), others.end(), bytes_of_light(l));
    if (it == others.end())
      rest.push_back(l);
    else
      others.erase(it);
  }
  return rest;
}

/// One sample of every replicate of some lights alone.
template <int N>
Tally<N> light_of(const Problem<N>& problem, std::vector<scene::Light> lights,
                  const std::vector<SideIndex>& sides, Work& work, scene::Counters& counters) {
  Tally<N> tally(problem.side_count(), 1, problem.sides.any_coupled);
  scene::Scene alone;
  alone.lights = std::move(lights);
  alone.bounds = problem.shading.scene().bounds;
  alone.unit = problem.shading.scene().unit;
  if (alone.lights.empty()) return tally;
  const scene::LightSampler<N> sampler(alone, problem.shading.basis());
  std::vector<Draw> plan;
  plan.reserve(sides.size());
  for (const SideIndex i : sides) plan.push_back({i, 1});
  sample_lights(problem, sampler, plan, tally, work, counters);
  return tally;
}

}  // namespace

template <int N>
std::vector<SideIndex> bring_direct(const Problem<N>& problem, const Neighbours& neighbours,
                                    const std::vector<scene::Light>& before, Tally<N>& direct,
                                    Work& work, scene::Counters& counters) {
  const std::vector<SideIndex>& active = problem.sides.active;
  const std::vector<scene::Light>& now = problem.shading.scene().lights;
  std::vector<SideIndex> sampled;
  for (const SideIndex i : active)
    if (direct.valid(i) > 0) sampled.push_back(i);
  // The same numbers for both: of a lamp that was dimmed the difference has no noise of its own.
  const Tally<N> gone = light_of(problem, lights_without(before, now), sampled, work, counters);
  const Tally<N> added = light_of(problem, lights_without(now, before), sampled, work, counters);
  std::vector<SideIndex> again;
  std::vector<std::uint8_t> stays(problem.side_count(), 0);
  for (std::size_t k = 0; k < active.size(); ++k) {
    const SideIndex i = active[k];
    if (direct.valid(i) == 0) {
      again.push_back(i);
      continue;
    }
    double has = 0.0, adds = 0.0;
    bool known = false;
    visit_near(problem, neighbours, k, [&](std::size_t m) {
      const SideIndex j = active[m];
      if (direct.valid(j) == 0) return;
      known = true;
      has += direct.variance(j) * direct.valid(j) / direct.valid(i);
      adds += Tally<N>::mean_square(j, 0, added, gone) / kReplicates;
    });
    if (known && adds <= has)
      stays[i] = 1;
    else
      again.push_back(i);
  }
  for (const SideIndex i : active) {
    if (stays[i] == 0) {
      direct.forget(i);
      continue;
    }
    direct.shift(i, 0, gone, -1.0f);
    direct.shift(i, 0, added, 1.0f);
  }
  return again;
}

template <int N>
BroughtSamples<N>::BroughtSamples(const Problem<N>& problem, const Neighbours& neighbours,
                                  const Rows<N>& rows, const std::vector<ReadField<N>>& before,
                                  const std::vector<ReadField<N>>& now, Tally<N>& gathered)
    : count_(problem.side_count(), 0) {
  const std::vector<SideIndex>& active = problem.sides.active;
  const std::size_t groups = now.size();
  SideValues<N> x(problem.side_count()), y(problem.side_count());  // of all groups
  std::vector<std::vector<RowMoments>> own;
  for (std::size_t g = 0; g < groups; ++g) {
    const SideValues<N> is = leaving_all(problem, now[g].all);
    const SideValues<N> change = difference(is, leaving_all(problem, before[g].all));
    for (const SideIndex i : active) {
      x[i] += is[i];
      y[i] += change[i];
    }
    if (groups > 1) own.push_back(all_moments(rows, is, change));
  }
  own.push_back(all_moments(rows, x, y));

  // Where rows cannot say it well, samples start again.
  for (std::size_t k = 0; k < active.size(); ++k) {
    const SideIndex i = active[k];
    const double n = gathered.valid(i);
    if (n == 0.0) continue;
    double kept = 0.0, added = 0.0;
    bool known = false, lit = false;
    visit_near(problem, neighbours, k, [&](std::size_t m) {
      known = known || rows.rays[m] > 1;
      added += own.back()[m].y;
      kept += own.back()[m].x * rows.rays[m] / n;
      lit = lit || own.back()[m].x > 0.0;
    });
    if (known && lit && added <= kept && rows.rays[k] > 0)
      count_[i] = static_cast<std::uint32_t>(n);
    else
      gathered.forget(i);
  }
  for (std::size_t g = 0; g < groups; ++g) {
    const SideValues<N> change =
        difference(leaving_all(problem, now[g].entries), leaving_all(problem, before[g].entries));
    for (std::size_t k = 0; k < active.size(); ++k) {
      if (count_[active[k]] == 0) continue;
      const float per_ray = 1.0f / static_cast<float>(rows.rays[k]);
      const auto shift = [&](bool body) {
        const std::size_t at = 2 * k + (body ? 1 : 0);
        return (rows.apply(k, change, body) + now[g].hot_sums[at] - before[g].hot_sums[at]) *
               per_ray;
      };
      const Spectrum<N> plain = shift(false);
      gathered.shift(active[k], g, plain, problem.sides.any_coupled ? shift(true) : plain);
    }
  }
  // Few rays that all miss what has changed do not say that it is certain: with the neighbours'.
  for (const std::vector<RowMoments>& m : own) {
    moments_.emplace_back(problem.side_count());
    for (std::size_t k = 0; k < active.size(); ++k) {
      if (count_[active[k]] == 0) continue;
      RowMoments sum = m[k];
      double count = 1.0;
      visit_near(problem, neighbours, k, [&](std::size_t near) {
        sum.y += m[near].y;
        sum.xy += m[near].xy;
        count += 1.0;
      });
      moments_.back()[active[k]] = {0.0, sum.y / count, sum.xy / count};
    }
  }
}

template <int N>
double BroughtSamples<N>::variance(SideIndex i, std::size_t group, double fresh,
                                   const Tally<N>& gathered) const {
  if (moments_.empty() || count_[i] == 0 || gathered.valid(i) == 0) return 0.0;
  const RowMoments& m = moments_[std::min(group, moments_.size() - 1)][i];
  const double part = part_.empty() ? static_cast<double>(count_[i]) / gathered.valid(i)
                                    : gathered.first_share() * static_cast<double>(part_[i]);
  const double share = fresh * part;
  return share * share * m.y + 2.0 * share * (1.0 - fresh) * m.xy;
}

template <int N>
void BroughtSamples<N>::end_first_round(const Tally<N>& gathered) {
  part_.assign(count_.size(), 0.0f);
  for (SideIndex i = 0; i < count_.size(); ++i)
    if (count_[i] > 0)
      part_[i] = static_cast<float>(count_[i]) / static_cast<float>(gathered.valid(i));
}

template <int N>
bool BroughtSamples<N>::is_for(std::size_t sides, std::size_t groups) const {
  if (moments_.empty()) return true;
  bool ok = moments_.size() == (groups > 1 ? groups + 1 : 1) && count_.size() == sides &&
            (part_.empty() || part_.size() == sides);
  for (const std::vector<RowMoments>& m : moments_) ok = ok && m.size() == sides;
  return ok;
}

#define ATRIUM_INSTANTIATE(N)                                                                      \
  template SideValues<N> without_first_light(SideValues<N>, const HotPatches<N>&, std::size_t);    \
  template std::vector<Spectrum<N>> hot_sums_of(const std::vector<Spectrum<N>>&, std::size_t,      \
                                                std::size_t, std::size_t);                         \
  template std::vector<SideIndex> bring_direct(const Problem<N>&, const Neighbours&,               \
                                               const std::vector<scene::Light>&, Tally<N>&, Work&, \
                                               scene::Counters&);                                  \
  template class BroughtSamples<N>;
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
