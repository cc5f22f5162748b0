#pragma once

#include <filesystem>
#include <string>

#include "material/error.h"

namespace atrium::scene {

/// Adds a folder that is searched first for the loadable modules (image and mesh files, subdivision
/// surfaces, plots). Programs of an installed or built Atrium need none: modules are found beside
/// the program (../lib, ../lib/atrium), beside the shared object that contains this library, and in
/// the folder the package was configured to be installed to. Never in the environment.
void add_module_folder(const std::filesystem::path& folder);

/// Loads NAME.so (dlopen) and returns the address of its entry point NAME; it stays loaded.
/// \throws RuntimeFailure  naming the module and the folders that were searched.
[[nodiscard]] void* module_entry(const std::string& name);

/// What that module offers. \tparam Entry  of its entry point: takes a version of the interface,
/// returns nullptr if its own is another.
/// \throws RuntimeFailure  as module_entry(), and for a module of another version.
template <class Entry>
[[nodiscard]] const auto& load_module(const std::string& name, int interface_version) {
  const auto* offered = reinterpret_cast<Entry>(module_entry(name))(interface_version);
  if (offered == nullptr) throw RuntimeFailure(name + ".so belongs to another version");
  return *offered;
}

}  // namespace atrium::scene
