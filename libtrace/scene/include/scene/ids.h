#pragma once

#include <compare>
#include <cstdint>
#include <limits>

#include "material/material.h"

namespace atrium::scene {

/// A typed index into one of the scene's vectors.
template <class Tag>
struct Id {
  static constexpr std::uint32_t kInvalid = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t value = kInvalid;

  Id() = default;
  explicit constexpr Id(std::uint32_t v) : value(v) {}
  explicit constexpr Id(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}
  [[nodiscard]] bool valid() const { return value != kInvalid; }
  friend auto operator<=>(Id, Id) = default;
};

using MeshId = Id<struct MeshTag>;
using ObjectId = Id<struct ObjectTag>;
using MaterialId = Id<struct MaterialTag>;
using LightId = Id<struct LightTag>;
using CameraId = Id<struct CameraTag>;
using material::TextureId;

}  // namespace atrium::scene
