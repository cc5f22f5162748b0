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
