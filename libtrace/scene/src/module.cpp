#include "module.h"

#include <dlfcn.h>

#include <filesystem>
#include <mutex>
#include <system_error>
#include <vector>

#include "material/error.h"

namespace atrium::scene {
namespace fs = std::filesystem;

namespace {

std::mutex mutex;
std::vector<fs::path>& added_folders() {
  static std::vector<fs::path> folders;
  return folders;
}

/// Folder of the shared object (or program) that this code is linked into.
fs::path own_folder() {
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&module_entry), &info) == 0 || !info.dli_fname) {
    return {};
  }
  std::error_code ec;
  const fs::path file = fs::canonical(info.dli_fname, ec);
  return ec ? fs::path() : file.parent_path();
}

std::vector<fs::path> search_folders() {
  std::vector<fs::path> folders;
  {
    const std::lock_guard lock(mutex);
    folders = added_folders();
  }
  std::error_code ec;
  const fs::path program = fs::read_symlink("/proc/self/exe", ec).parent_path();
  for (const fs::path& base : {program / "..", own_folder()}) {
    if (base.empty() || base == "..") continue;
    folders.push_back(base / "lib");
    folders.push_back(base / ATRIUM_LIBDIR / "atrium");
  }
  folders.push_back(own_folder());
  folders.push_back(fs::path(ATRIUM_FULL_LIBDIR) / "atrium");
  return folders;
}

}  // namespace

void add_module_folder(const fs::path& folder) {
  const std::lock_guard lock(mutex);
  added_folders().insert(added_folders().begin(), folder);
}

void* module_entry(const std::string& name) {
  const std::string file_name = name + ".so";
  std::string searched;
  for (const fs::path& folder : search_folders()) {
    const fs::path file = (folder / file_name).lexically_normal();
    std::error_code ec;
    if (!file.is_absolute() || !fs::exists(file, ec)) {
      searched += (searched.empty() ? "" : ", ") + folder.lexically_normal().string();
      continue;
    }
    void* handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr)
      throw RuntimeFailure(file.string() + ": cannot be loaded: " + ::dlerror());
    void* entry = ::dlsym(handle, name.c_str());
    if (entry == nullptr) throw RuntimeFailure(file.string() + ": is no module of this program");
    return entry;
  }
  throw RuntimeFailure("module " + file_name + " is missing (searched " + searched + ")");
}

}  // namespace atrium::scene
