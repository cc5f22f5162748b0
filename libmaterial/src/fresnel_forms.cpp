#include "material/fresnel_forms.h"

#include <cmath>
#include <string>
#include <vector>

namespace atrium::material {
namespace {

using fresnel_detail::ExactLanes;
using fresnel_detail::kWidth;
using fresnel_detail::Lanes;
using fresnel_detail::Order0Lanes;
using fresnel_detail::Order1Lanes;
using fresnel_detail::Order2Lanes;
using fresnel_detail::SchlickCorrectedLanes;
using fresnel_detail::SchlickLanes;
using fresnel_detail::TableLanes;
using fresnel_detail::unit_range;
using fresnel_detail::unpolarised;

// ---- Evaluation. Loops over the padded lanes without branches: the compiler vectorises them. ----

template <int N, class F>
Spectrum<N> per_lane(F&& f) {
  Lanes<N> r;
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = f(i);
  Spectrum<N> out;
  for (int i = 0; i < N; ++i) out[i] = r[static_cast<std::size_t>(i)];
  return out;
}

// Eq. F5, Real = float for rendering; t = n^2 - k^2 - s^2. A call would keep the loop over lanes
// from being vectorised, and the compiler takes it for too large to be inlined by itself.
template <class Real>
[[gnu::always_inline]] inline Real exact(Real t, Real nk, Real contrast, Real c, Real s2) {
  constexpr Real tiny = std::numeric_limits<Real>::min();
  const Real modulus = std::sqrt(t * t + Real(4) * nk * nk);
  const Real big2 = Real(0.5) * (modulus + std::abs(t));
  const Real a = (t >= Real(0) ? big2 : nk) / (std::sqrt(big2) + tiny);
  const Real e = Real(2) * a * c;
  const Real cc = c * c;
  const Real r = contrast / (modulus + cc + e + tiny);
  const Real p = modulus * cc + s2 * s2 + tiny;
  return std::min(r * r * (p / (p + e * s2)), Real(1));
}

template <int N>
Spectrum<N> evaluate(const ExactLanes<N>& l, float c) {
  const float s2 = (1.0f - c) * (1.0f + c);
  const double cd = c, c2 = cd * cd;
  // Summed in double: next to total reflection the terms cancel, and F follows the root of what is
  // left. A loop of its own, as lanes of two types do not share a vector.
  Lanes<N> t;
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = static_cast<float>(l.q[i] + c2);
  return per_lane<N>([&](std::size_t i) { return exact(t[i], l.nk[i], l.contrast[i], c, s2); });
}

template <int N>
Spectrum<N> evaluate(const SchlickLanes<N>& l, float c) {
  const float x = 1.0f - c, x2 = x * x, x5 = x2 * x2 * x;
  return per_lane<N>([&](std::size_t i) { return l.f0[i] + (1.0f - l.f0[i]) * x5; });
}

template <int N>
Spectrum<N> evaluate(const SchlickCorrectedLanes<N>& l, float c) {
  const float x = 1.0f - c, x2 = x * x, x5 = x2 * x2 * x, y = c * x5 * x;
  return per_lane<N>(
      [&](std::size_t i) { return unit_range(l.f0[i] + (1.0f - l.f0[i]) * x5 - l.a[i] * y); });
}

template <int N>
Spectrum<N> evaluate(const Order0Lanes<N>& l, float c) {
  const float c2 = c * c;
  return per_lane<N>([&](std::size_t i) {
    const float e = l.twice_n[i] * c;
    const float ds = l.modulus[i] + c2, dp = l.modulus[i] * c2 + 1.0f;
    // Mean of (d - e) / (d + e); rounding takes it below 0 for N = 1, but never above 1.
    return std::max(ds * dp - e * e, 0.0f) / ((ds + e) * (dp + e));
  });
}

template <int N>
Spectrum<N> evaluate(const Order1Lanes<N>& l, float c) {
  const float s2 = (1.0f - c) * (1.0f + c);
  return per_lane<N>([&](std::size_t i) {
    const float h = l.h[i] * s2;
    const float a = std::max(l.n[i] - l.n[i] * h, 0.0f), b = l.k[i] + l.k[i] * h;
    return unpolarised(a * a + b * b, a, c, s2);
  });
}

template <int N>
Spectrum<N> evaluate(const Order2Lanes<N>& l, float c) {
  const float s2 = (1.0f - c) * (1.0f + c);
  return per_lane<N>([&](std::size_t i) {
    const float a = std::max(l.n[i] - s2 * (l.a1[i] + s2 * l.a2[i]), 0.0f);
    const float b = l.k[i] - s2 * (l.b1[i] + s2 * l.b2[i]);
    return unpolarised(a * a + b * b, a, c, s2);
  });
}

template <int N>
Spectrum<N> evaluate(const TableLanes<N>& l, float c) {
  const float x = std::sqrt(c) * static_cast<float>(TableLanes<N>::kSteps);
  const int j = std::min(static_cast<int>(x), TableLanes<N>::kSteps - 1);
  const float t = x - static_cast<float>(j);
  const Lanes<N>& f0 = (*l.f)[static_cast<std::size_t>(j)];
  const Lanes<N>& f1 = (*l.f)[static_cast<std::size_t>(j) + 1];
  return per_lane<N>([&](std::size_t i) { return f0[i] + t * (f1[i] - f0[i]); });
}

// ---- Making a form ----

template <int N>
struct Index {
  Lanes<N, double> n, k;
};

template <int N>
Index<N> padded(const Spectrum<N>& n, const Spectrum<N>& k) {
  Index<N> index;
  for (std::size_t i = 0; i < index.n.size(); ++i) {
    const int lane = std::min(static_cast<int>(i), N - 1);
    if (!(n[lane] > 0.0f && std::isfinite(n[lane])))
      throw std::invalid_argument("FresnelTerm: n must be above 0 and finite, is " +
                                  std::to_string(n[lane]));
    if (!(k[lane] >= 0.0f && std::isfinite(k[lane])))
      throw std::invalid_argument("FresnelTerm: k must be at least 0 and finite, is " +
                                  std::to_string(k[lane]));
    constexpr double most = 1e9;  // as fresnel<float>: keeps every square inside float
    index.n[i] = std::min(static_cast<double>(n[lane]), most);
    index.k[i] = std::min(static_cast<double>(k[lane]), most);
  }
  return index;
}

double exact_contrast(double n, double k) {
  return std::sqrt((n - 1.0) * (n - 1.0) + k * k) * std::sqrt((n + 1.0) * (n + 1.0) + k * k);
}
double exact_square(double n, double k) { return (n - 1.0) * (n + 1.0) - k * k; }

template <int N>
void fill(ExactLanes<N>& l, std::size_t i, double n, double k) {
  l.q[i] = exact_square(n, k);
  l.nk[i] = static_cast<float>(n * k);
  l.contrast[i] = static_cast<float>(exact_contrast(n, k));
}
template <int N>
void fill(SchlickLanes<N>& l, std::size_t i, double n, double k) {
  l.f0[i] = static_cast<float>(fresnel_normal(n, k));
}
template <int N>
void fill(SchlickCorrectedLanes<N>& l, std::size_t i, double n, double k) {
  constexpr double at = 1.0 / 7.0, peak = 46656.0 / 823543.0;  // c (1 - c)^6 at 1/7, its maximum
  l.f0[i] = static_cast<float>(fresnel_normal(n, k));
  l.a[i] = static_cast<float>((fresnel_schlick(at, n, k) - fresnel_unpolarised(at, n, k)) / peak);
}
template <int N>
void fill(Order0Lanes<N>& l, std::size_t i, double n, double k) {
  l.modulus[i] = static_cast<float>(n * n + k * k);
  l.twice_n[i] = static_cast<float>(2.0 * n);
}
template <int N>
void fill(Order1Lanes<N>& l, std::size_t i, double n, double k) {
  l.n[i] = static_cast<float>(n);
  l.k[i] = static_cast<float>(k);
  l.h[i] = static_cast<float>(0.5 / (n * n + k * k));
}
template <int N>
void fill(Order2Lanes<N>& l, std::size_t i, double n, double k) {
  const double m = n * n + k * k;
  l.n[i] = static_cast<float>(n);
  l.k[i] = static_cast<float>(k);
  l.a1[i] = static_cast<float>(0.5 * n / m);
  l.b1[i] = static_cast<float>(-0.5 * k / m);
  const double a = n / m, b = -k / m;  // 1 / N
  l.a2[i] = static_cast<float>(0.125 * a * (a * a - 3.0 * b * b));
  l.b2[i] = static_cast<float>(0.125 * b * (3.0 * a * a - b * b));
}

template <int N, class L>
L make(const Index<N>& index) {
  L lanes{};
  if constexpr (std::is_same_v<L, TableLanes<N>>) {
    auto f = std::make_shared<typename TableLanes<N>::Values>();
    for (std::size_t j = 0; j < f->size(); ++j) {
      const double u = static_cast<double>(j) / TableLanes<N>::kSteps;
      for (std::size_t i = 0; i < index.n.size(); ++i)
        (*f)[j][i] = static_cast<float>(fresnel_unpolarised(u * u, index.n[i], index.k[i]));
    }
    lanes.f = std::move(f);
  } else {
    for (std::size_t i = 0; i < index.n.size(); ++i) fill(lanes, i, index.n[i], index.k[i]);
  }
  return lanes;
}

template <class Variant, int N>
Variant make_form(const Index<N>& index, FresnelForm form) {
  switch (form) {
    case FresnelForm::Exact:
      break;
    case FresnelForm::Schlick:
      return make<N, SchlickLanes<N>>(index);
    case FresnelForm::SchlickCorrected:
      return make<N, SchlickCorrectedLanes<N>>(index);
    case FresnelForm::Order0:
      return make<N, Order0Lanes<N>>(index);
    case FresnelForm::Order1:
      return make<N, Order1Lanes<N>>(index);
    case FresnelForm::Order2:
      return make<N, Order2Lanes<N>>(index);
    case FresnelForm::Table:
      return make<N, TableLanes<N>>(index);
  }
  return make<N, ExactLanes<N>>(index);
}

// From cheap to dear, as measured by benchmarks/material_benchmark.cpp. A table that lies in the
// cache costs packs of lanes no more than order 0; it comes after the forms that need none.
constexpr std::array kCheapFirst{FresnelForm::Schlick,          FresnelForm::Order0,
                                 FresnelForm::SchlickCorrected, FresnelForm::Table,
                                 FresnelForm::Order1,           FresnelForm::Order2};

// The root's series in s^2 / N^2 converge at every angle for |N| > 1. Elsewhere their error has
// peaks too narrow to be measured.
bool is_series(FresnelForm form) {
  return form == FresnelForm::Order1 || form == FresnelForm::Order2;
}
template <int N>
bool series_converge(const Index<N>& index) {
  for (std::size_t i = 0; i < index.n.size(); ++i)
    if (!(index.n[i] * index.n[i] + index.k[i] * index.k[i] > 1.0)) return false;
  return true;
}

// ---- Measuring ----

// Cosines at which forms are measured: even steps of sqrt(c), as F rises towards grazing; half
// octaves down to 2^-40 for very large k and indices next to 1.
const std::vector<float>& common_cosines() {
  static const std::vector<float> cosines = [] {
    constexpr int kSteps = 256;
    std::vector<float> c;
    for (int i = 0; i <= kSteps; ++i) {
      const float u = static_cast<float>(i) / kSteps;
      c.push_back(u * u);
    }
    for (int j = 32; j <= 80; ++j) c.push_back(std::exp2(-0.5f * static_cast<float>(j)));
    return c;
  }();
  return cosines;
}

template <int N>
struct Reference {
  std::vector<float> cosines;
  std::vector<Lanes<N, double>> f;
};

template <int N>
Reference<N> measure_exact(const Index<N>& index) {
  Reference<N> r;
  r.cosines = common_cosines();
  for (std::size_t i = 0; i < static_cast<std::size_t>(N); ++i) {
    const double n = index.n[i];
    if (n >= 1.0 || index.k[i] >= 1.0) continue;
    // Next to total reflection F leaves 1 along a root, rounded by k.
    const double edge = std::sqrt((1.0 - n) * (1.0 + n));
    for (double step = 1.0; step > 1e-5; step *= 0.5) {
      r.cosines.push_back(static_cast<float>(edge + (1.0 - edge) * step));
      r.cosines.push_back(static_cast<float>(edge - edge * step));
    }
  }
  Lanes<N, double> q, nk, contrast;
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] = exact_square(index.n[i], index.k[i]);
    nk[i] = index.n[i] * index.k[i];
    contrast[i] = exact_contrast(index.n[i], index.k[i]);
  }
  r.f.resize(r.cosines.size());
  for (std::size_t j = 0; j < r.f.size(); ++j) {
    const double c = r.cosines[j], s2 = (1.0 - c) * (1.0 + c);
    for (std::size_t i = 0; i < q.size(); ++i)
      r.f[j][i] = exact(q[i] + c * c, nk[i], contrast[i], c, s2);
  }
  return r;
}

// The true maximum may lie between the angles measured. With this margin it stayed below 0.98 of
// the bound in ten thousand random choices.
constexpr float kBetweenAngles = 1.05f;
constexpr float kNeverEnough = std::numeric_limits<float>::max();

// Largest error of a form; stops at the first above `enough`.
template <int N, class Variant>
float largest_error(const Variant& form, const Reference<N>& reference, float enough) {
  const auto measure = [&](const auto& lanes) {
    double worst = 0.0;
    for (std::size_t j = 0; j < reference.f.size() && worst <= static_cast<double>(enough); ++j) {
      const Spectrum<N> f = evaluate(lanes, reference.cosines[j]);
      for (int i = 0; i < N; ++i) {
        const double exact = reference.f[j][static_cast<std::size_t>(i)];
        worst = std::max(worst, std::abs(static_cast<double>(f[i]) - exact));
      }
    }
    return static_cast<float>(worst);
  };
  return std::visit(measure, form);
}

}  // namespace

std::string_view name(FresnelForm form) {
  constexpr std::array<std::string_view, 7> names{
      "exact", "schlick", "schlick-corrected", "order-0", "order-1", "order-2", "table"};
  return names[static_cast<std::size_t>(form)];
}

template <int N>
FresnelTerm<N>::FresnelTerm() : FresnelTerm(Spectrum<N>::one(), Spectrum<N>::zero(), 0.0f) {}

template <int N>
FresnelTerm<N>::FresnelTerm(const Spectrum<N>& n, const Spectrum<N>& k, float bound) {
  if (!(bound >= 0.0f))
    throw std::invalid_argument("FresnelTerm: bound must be at least 0, is " +
                                std::to_string(bound));
  const Index<N> index = padded(n, k);
  const Reference<N> reference = measure_exact<N>(index);
  if (bound > 0.0f)
    for (const FresnelForm form : kCheapFirst) {
      if (is_series(form) && !series_converge<N>(index)) continue;
      lanes_ = make_form<Variant>(index, form);
      error_ = largest_error(lanes_, reference, bound);
      if (kBetweenAngles * error_ <= bound) return;
    }
  lanes_ = make_form<Variant>(index, FresnelForm::Exact);
  error_ = largest_error(lanes_, reference, kNeverEnough);
}

template <int N>
FresnelTerm<N>::FresnelTerm(const Spectrum<N>& n, const Spectrum<N>& k, FresnelForm form) {
  const Index<N> index = padded(n, k);
  lanes_ = make_form<Variant>(index, form);
  error_ = largest_error(lanes_, measure_exact<N>(index), kNeverEnough);
}

template <int N>
Spectrum<N> FresnelTerm<N>::operator()(float c) const {
  c = std::min(std::max(c, 0.0f), 1.0f);
  return std::visit([c](const auto& lanes) { return evaluate(lanes, c); }, lanes_);
}

template class FresnelTerm<1>;
template class FresnelTerm<3>;
template class FresnelTerm<4>;
template class FresnelTerm<8>;

}  // namespace atrium::material
