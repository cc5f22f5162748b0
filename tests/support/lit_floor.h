#pragma once

namespace atrium::test {

/// A floor of 2 m x 2 m under a lamp and a bulb, each in a light group of its own.
inline constexpr const char* kLitFloor =
    R"(atrium: 1
materials:
  white: {body: 0.5}
  lamp: {body: 0, emission: {radiance: 100}}
objects:
  - {name: floor, material: white, polygon: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]}
  - {name: lamp, light_group: lamp, material: lamp,
     polygon: [[-0.2, 2, -0.2], [0.2, 2, -0.2], [0.2, 2, 0.2], [-0.2, 2, 0.2]]}
lights:
  - {name: bulb, light_group: bulb, point: {position: [0.5, 1, 0], intensity: 100}}
)";

}  // namespace atrium::test
