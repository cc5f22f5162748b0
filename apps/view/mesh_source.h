#pragma once

#include <optional>
#include <string>

#include "mesh.h"

namespace atrium::view {

/// Where newer states of a mesh come from while it is looked at.
class MeshSource {
 public:
  struct Status {
    std::string text;       ///< for people: what is being done, since when, how good it is
    bool finished = false;  ///< nothing new will come
  };
  virtual ~MeshSource() = default;
  /// The newest state, if there is one that was not taken yet.  \throws what made it fail.
  [[nodiscard]] virtual std::optional<Mesh> take() = 0;
  [[nodiscard]] virtual Status status() const = 0;
};

}  // namespace atrium::view
