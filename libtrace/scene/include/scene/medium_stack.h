#pragma once

#include <array>
#include <cstddef>

#include "scene/ids.h"

namespace atrium::scene {

/// The bodies that a path is in, one in another, by their materials: the innermost absorbs.
class MediumStack {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// The innermost; not when empty.
  [[nodiscard]] MaterialId current() const { return material_[size_ - 1]; }
  void enter(MaterialId material) {
    if (size_ < kDeepest) material_[size_++] = material;  // deeper nests absorb like the last
  }
  void leave(MaterialId material) {
    for (std::size_t i = size_; i-- > 0;)
      if (material_[i] == material) {
        for (std::size_t k = i; k + 1 < size_; ++k) material_[k] = material_[k + 1];
        --size_;
        return;
      }
  }

 private:
  static constexpr std::size_t kDeepest = 64;
  std::size_t size_ = 0;
  std::array<MaterialId, kDeepest> material_;
};

}  // namespace atrium::scene
