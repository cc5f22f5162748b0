#pragma once

#include <cstddef>
#include <vector>

#include "scene/square_density.h"

namespace atrium::trace {

/// Where gather rays of one tile of the picture go: towards what earlier ones of the same place
/// found. Places are diffuse points that lie close together and face alike, behind mirrors and
/// glass too. What rays find counts from the tile's next pass on, so the mean of no ray depends on
/// what it finds.
class GatherGuide {
 public:
  /// No place; rays stay uniform.
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Place of a point, a new one if there is room.
  /// \param reach  [m] how far points of one place are apart at most.
  [[nodiscard]] std::size_t place(const Vec3f& position, const Vec3f& normal, float reach);
  [[nodiscard]] scene::SquareDensity density(std::size_t place) const {
    return scene::SquareDensity(place == kNone || !places_[place].bent ? nullptr
                                                                       : &places_[place].levels);
  }
  /// \param value  that the ray found, for uniform rays. \param where  in the square that its numbers
  /// were bent in. \param density  at that place.
  void found(std::size_t place, const Vec2f& where, float value, float density);
  /// A pass of the tile begins: what was found until now says where its rays go.
  void learn();

 private:
  struct Place {
    Vec3f position, normal;
    float reach = 0.0f;
    std::size_t rays = 0;
    double sum = 0.0;
    scene::SquareDensity::Squares squares{};
    scene::SquareDensity::Levels levels{};
    bool bent = false;
  };
  std::vector<Place> places_;
};

}  // namespace atrium::trace
