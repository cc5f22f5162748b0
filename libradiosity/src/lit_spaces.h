#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "radiosity/elements.h"
#include "scene/closed_bodies.h"

namespace atrium::radiosity {

/// The spaces that lights shine in. A space is a set of closed opaque bodies that contain it; light
/// never leaves one. The open (no body) is always lit, a room that is a closed body by the lamps in
/// it, the inside of a wall by none.
class LitSpaces {
 public:
  using Bodies = std::vector<std::uint32_t>;

  explicit LitSpaces(const scene::Scene& scene);

  /// Bodies that an element may touch or lie in; empty: it lies in the open.
  [[nodiscard]] Bodies near(const Elements& elements, std::uint32_t element) const;
  /// Can light get to a point off a surface? \param near  of its element.
  [[nodiscard]] bool contains(const Vec3f& origin, const Bodies& near) const;
  [[nodiscard]] bool contains(const Vec3f& origin) const { return lit_.contains(space_of(origin)); }
  /// By object: Side that looks into its own bodies, all unlit; 2: none (Sides::kNoInner).
  [[nodiscard]] std::vector<std::uint8_t> inner_sides() const;

 private:
  void add_lights();
  void add_emissive(scene::ObjectId object);
  [[nodiscard]] Bodies space_of(const Vec3f& point) const;

  const scene::Scene* scene_;
  scene::ClosedBodies bodies_;
  std::set<Bodies> lit_;
};

}  // namespace atrium::radiosity
