#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/memory_use.h"

namespace atrium::radiosity {

template <class T, class A>
[[nodiscard]] std::uint64_t bytes_of(const std::vector<T, A>& v) {
  return static_cast<std::uint64_t>(v.capacity()) * sizeof(T);
}
[[nodiscard]] std::uint64_t bytes_of(const scene::Scene& scene);
[[nodiscard]] std::uint64_t bytes_of(const scene::SurfaceField& field);
[[nodiscard]] std::uint64_t bytes_of(const Elements& elements);

/// What a solve holds against what it may hold, by counted bytes of its arrays. What has to be
/// decided before an array exists is predicted from above.
class MemoryBudget {
 public:
  enum class Part { Scene, Bvh, Elements, Samples, Photons, Rows, Fields, Count_ };

  /// \param limit  [bytes]; 0: none.
  explicit MemoryBudget(std::uint64_t limit = 0) : limit_(limit) {}

  /// A part holds so much now. What it held before is replaced.
  void hold(Part part, std::uint64_t bytes) {
    held_[static_cast<std::size_t>(part)] = bytes;
    most_[static_cast<std::size_t>(part)] = std::max(most_[static_cast<std::size_t>(part)], bytes);
    peak_ = std::max(peak_, held());
  }
  [[nodiscard]] std::uint64_t held() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t b : held_) sum += b;
    return sum;
  }
  /// What a part may grow to while the others stay as they are.
  [[nodiscard]] std::uint64_t room(Part part) const {
    if (limit_ == 0) return std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t others = held() - held_[static_cast<std::size_t>(part)];
    return limit_ > others ? limit_ - others : 0;
  }

  [[nodiscard]] std::uint64_t limit() const { return limit_; }
  /// Says that less was done than asked for, and what.
  void give_up(std::string what) { given_up_.push_back(std::move(what)); }
  [[nodiscard]] const std::vector<std::string>& given_up() const { return given_up_; }

  [[nodiscard]] MemoryUse use() const {
    const auto most = [&](Part p) { return most_[static_cast<std::size_t>(p)]; };
    return {most(Part::Scene),   most(Part::Bvh),  most(Part::Elements), most(Part::Samples),
            most(Part::Photons), most(Part::Rows), most(Part::Fields),   peak_};
  }

 private:
  std::uint64_t limit_;
  std::array<std::uint64_t, static_cast<std::size_t>(Part::Count_)> held_{}, most_{};
  std::uint64_t peak_ = 0;
  std::vector<std::string> given_up_;
};

/// "12.3 MB" (1e6 bytes), for messages.
[[nodiscard]] std::string megabytes(std::uint64_t bytes);

}  // namespace atrium::radiosity
