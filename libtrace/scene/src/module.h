#pragma once

#include <string>

namespace atrium::scene {

/// Loads a module (dlopen) and returns the address of its entry point; it stays loaded.
/// \throws RuntimeFailure  naming the module and the folders that were searched.
[[nodiscard]] void* load_module(const std::string& file_name, const char* entry_point);

/// Version of the interfaces in *_module.h; a module of another build is refused.
inline constexpr int kModuleInterface = 1;

}  // namespace atrium::scene
