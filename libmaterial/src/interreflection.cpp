#include <numbers>

#include "material/bsdf.h"
#include "material/interface_albedo.h"

namespace atrium::material {

Interreflection::Interreflection(double c, Masking masking) {
  const double width = 1.0 / std::max(c, 1.0);
  width_ = static_cast<float>(width);
  scale_ = static_cast<float>((1.0 + width) * kSteps);
  for (int i = 0; i <= kSteps; ++i) {
    const double w = static_cast<double>(i) / kSteps / (1.0 + width);
    const double mu = std::clamp(width * w / (1.0 - w), 1e-4, 1.0);
    const double lost = 1.0 - white_albedo(mu, c, masking);
    loss_[static_cast<std::size_t>(i)] = static_cast<float>(std::clamp(lost, 0.0, 1.0));
  }
  constexpr int kSum = 4096;
  double sum = 0.0;
  for (int i = 0; i < kSum; ++i) {
    const double mu = (i + 0.5) / kSum;
    sum += 2.0 * mu * static_cast<double>(loss(static_cast<float>(mu))) / kSum;
  }
  mean_ = static_cast<float>(sum);
  tabulate_density();
}

// Within a step of the table the loss is taken as its mean: directions then follow the cosine, and
// their number per step is what the distribution says. Linear in between, the loss is at most twice
// the mean.
void Interreflection::tabulate_density() {
  const auto cosine_at = [&](int i) {
    const double w = static_cast<double>(i) / static_cast<double>(scale_);
    return i == kSteps ? 1.0 : static_cast<double>(width_) * w / (1.0 - w);
  };
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double a = cosine_at(i), b = cosine_at(i + 1);
    // Never 0: the loss itself is not, for a direction of light in here.
    average_[at] = std::max(0.5f * (loss_[at] + loss_[at + 1]), 1e-9f);
    sum += (b - a) * (b + a) * static_cast<double>(average_[at]);
    cosine2_[at] = static_cast<float>(a * a);
    cumulative_[at + 1] = static_cast<float>(sum);
  }
  cosine2_[kSteps] = 1.0f;
  for (float& x : cumulative_) x /= static_cast<float>(sum);
  for (float& x : average_) x /= static_cast<float>(sum);
}

float Interreflection::pdf(float mu) const {
  mu = std::clamp(mu, 0.0f, 1.0f);
  const int i = std::min(static_cast<int>(mu / (mu + width_) * scale_), kSteps - 1);
  return average_[static_cast<std::size_t>(i)] * mu * std::numbers::inv_pi_v<float>;
}

Vec3f Interreflection::sample(const Vec2f& u) const {
  const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, u.x());
  const auto i = static_cast<std::size_t>(above - cumulative_.begin()) - 1;
  const float part = cumulative_[i + 1] - cumulative_[i];
  const float t = part > 0.0f ? std::clamp((u.x() - cumulative_[i]) / part, 0.0f, 1.0f) : 0.5f;
  const float mu2 = cosine2_[i] + t * (cosine2_[i + 1] - cosine2_[i]);
  const float phi = 2.0f * std::numbers::pi_v<float> * u.y(), s = std::sqrt(1.0f - mu2);
  return {s * std::cos(phi), s * std::sin(phi), std::sqrt(mu2)};
}

float Interreflection::loss(float mu) const {
  mu = std::clamp(mu, 0.0f, 1.0f);
  const float x = mu / (mu + width_) * scale_;
  const int i = std::min(static_cast<int>(x), kSteps - 1);
  const float f = x - static_cast<float>(i);
  const auto at = static_cast<std::size_t>(i);
  return loss_[at] + f * (loss_[at + 1] - loss_[at]);
}

}  // namespace atrium::material
