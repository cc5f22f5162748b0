#pragma once

#include "scene/modules.h"

namespace atrium::scene {

/// Version of the interfaces in *_module.h; a module of another build is refused.
inline constexpr int kModuleInterface = 3;

}  // namespace atrium::scene
