#pragma once

#include <string>

#include "material/error.h"
#include "scene/modules.h"

namespace atrium::scene {

/// Version of the interfaces in *_module.h; a module of another build is refused.
inline constexpr int kModuleInterface = 3;

/// What the module NAME.so offers by its entry point NAME.
/// \throws RuntimeFailure  if it is not found or of another build.
template <class Entry>
[[nodiscard]] const auto& load_interface(const std::string& name) {
  const auto entry = reinterpret_cast<Entry>(load_module(name + ".so", name.c_str()));
  const auto* offered = entry(kModuleInterface);
  if (offered == nullptr) throw RuntimeFailure(name + ".so belongs to another version");
  return *offered;
}

}  // namespace atrium::scene
