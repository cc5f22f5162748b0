#pragma once

#include "scene/scene.h"

namespace atrium {

/// A floor of 4 x 4 furnished rooms with doors between them: tables, chairs, shelves of books and
/// round lamps, about 130,000 triangles. Every second room has a lit ceiling panel. Watts, grey.
[[nodiscard]] scene::Scene make_building();

}  // namespace atrium
