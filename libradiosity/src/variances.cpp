#include "variances.h"

#include <cmath>

#include "hot_light.h"

namespace atrium::radiosity {
namespace {

template <int N>
float caustic_variance(const RowState<N>& s, SideIndex i, GroupChoice group) {
  float sum = 0.0f;
  for (std::size_t g = first_of(group); g < s.end_of(group); ++g)
    sum += s.photons.caustic[g].variance[i];
  return sum;
}

/// Rays taken as independent: an upper bound for stratified ones.
template <int N>
double row_variance(const RowState<N>& s, std::size_t k, const GroupLight<N>& g) {
  const double n = s.rows.rays[k];
  if (n < 2.0) return 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (std::uint64_t e = s.rows.first[k]; e < s.rows.first[k + 1]; ++e) {
    const auto& entry = s.rows.entries[e];
    const SideIndex j = entry.target & ~Rows<N>::kChromatic;
    const double value = static_cast<double>(leaving(s.problem.sides, j, g.source[j] + g.bounced[j],
                                                     g.source[j ^ 1U] + g.bounced[j ^ 1U])
                                                 .mean());
    const double weight = s.rows.mean_weight(entry);
    sum += weight * value;
    squares += weight * value * value;
  }
  return std::max(0.0, squares / n - sum * sum / (n * n)) / (n - 1.0);
}

/// What errors of other sides' light make of the variance of each: the common one of hot patches,
/// and those of what a side sees, as far as they do not average out.
template <int N>
std::vector<double> passed_on_variance(const RowState<N>& s, const std::vector<double>& total,
                                       GroupChoice group) {
  std::vector<double> result(s.problem.side_count(), 0.0);
  const double common = hot_flux_variance(s, group);
  if (common > 0.0)
    for (const SideIndex i : s.problem.sides.active) {
      const double first = total_of(s.shot, i, group);
      result[i] = common * first * first;
    }
  std::vector<double> leaving_variance(s.problem.side_count(), 0.0);
  for (const SideIndex i : s.problem.sides.active) {
    const double rho = static_cast<double>(s.problem.sides.reflectance[i].mean());
    const double tau = static_cast<double>(s.problem.sides.transmittance[i].mean());
    leaving_variance[i] =
        rho * rho * (total[i] + result[i]) + tau * tau * (total[i ^ 1U] + result[i ^ 1U]);
  }
  for (std::size_t k = 0; k < s.rows.size(); ++k)
    result[s.problem.sides.active[k]] += s.rows.apply_squared(k, leaving_variance);
  return result;
}

/// Variances of the means of one group, or of the sum of all.
template <int N>
Variances variances(const RowState<N>& s, const RowVariances& rows, GroupChoice group) {
  const auto of = [&](const Tally<N>& tally) {
    return mean_variance(s.problem, s.regions, tally, group);
  };
  const std::vector<double> direct = of(s.direct);
  const std::vector<double> fresh = of(s.gathered);
  const std::vector<double> shot = of(s.shot);
  const std::vector<float> none(s.problem.side_count(), 0.0f);
  Variances v{none, none, none, none};
  std::vector<double> total(s.problem.side_count(), 0.0);
  for (std::size_t k = 0; k < s.rows.size(); ++k) {
    const SideIndex i = s.problem.sides.active[k];
    v.direct[i] = static_cast<float>(direct[i]);
    v.caustic[i] = caustic_variance(s, i, group);
    const double share = s.fresh_share_of(i);
    const double row = std::max(0.0, std::pow(1.0 - share, 2) * row_variance(s, rows, i, group) +
                                         brought_variance(s, i, group, share));
    v.indirect[i] = static_cast<float>(row + share * share * fresh[i] + shot[i]);
    v.rest[i] = v.caustic[i] + static_cast<float>(row);
    total[i] = static_cast<double>(v.direct[i]) + static_cast<double>(v.caustic[i]) +
               static_cast<double>(v.indirect[i]);
  }
  const std::vector<double> passed_on = passed_on_variance(s, total, group);
  for (const SideIndex i : s.problem.sides.active) {
    v.indirect[i] += static_cast<float>(passed_on[i]);
    v.rest[i] += static_cast<float>(passed_on[i]);
  }
  return v;
}

}  // namespace

template <int N>
std::vector<double> row_variances(const RowState<N>& s, const GroupLight<N>& g) {
  std::vector<double> variance(s.problem.side_count(), 0.0);
  scene::parallel_for(s.rows.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      variance[s.problem.sides.active[k]] = row_variance(s, k, g);
  });
  return variance;
}

template <int N>
RowVariances row_variances(const RowState<N>& s) {
  RowVariances all;
  for (const GroupLight<N>& g : s.groups) all.push_back(row_variances(s, g));
  return all;
}

template <int N>
std::vector<Variances> all_variances(const RowState<N>& s, const RowVariances& rows) {
  std::vector<Variances> all;
  for (std::size_t g = 0; g < s.groups.size(); ++g) all.push_back(variances(s, rows, g));
  if (s.groups.size() > 1) all.push_back(variances(s, rows, kAllGroups));
  return all;
}

#define ATRIUM_INSTANTIATE(N)                                                           \
  template std::vector<double> row_variances(const RowState<N>&, const GroupLight<N>&); \
  template RowVariances row_variances(const RowState<N>&);                              \
  template std::vector<Variances> all_variances(const RowState<N>&, const RowVariances&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
