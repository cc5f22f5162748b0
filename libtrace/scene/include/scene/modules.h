#pragma once

#include <filesystem>
#include <string>

namespace atrium::scene {

/// Adds a folder that is searched first for the loadable modules (image and mesh
/// files, subdivision surfaces, plots). Programs of an installed or built Atrium need none: modules are found beside the program (../lib,
/// ../lib/atrium), beside the shared object that contains this library, and in the folder the
/// package was configured to be installed to. Never in the environment.
void add_module_folder(const std::filesystem::path& folder);

/// Loads a module (dlopen) and returns the address of its entry point; it stays loaded.
/// \throws RuntimeFailure  naming the module and the folders that were searched.
[[nodiscard]] void* load_module(const std::string& file_name, const char* entry_point);

}  // namespace atrium::scene
