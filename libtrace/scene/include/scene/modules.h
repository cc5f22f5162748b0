#pragma once

#include <filesystem>

namespace atrium::scene {

/// Adds a folder that is searched first for the loadable modules (image and mesh files). Programs
/// of an installed or built Atrium need none: modules are found beside the program (../lib,
/// ../lib/atrium), beside the shared object that contains this library, and in the folder the
/// package was configured to be installed to. Never in the environment.
void add_module_folder(const std::filesystem::path& folder);

}  // namespace atrium::scene
