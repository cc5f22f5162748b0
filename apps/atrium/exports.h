#pragma once

#include <span>
#include <string>
#include <vector>

#include "options.h"
#include "scene/light_groups.h"
#include "session.h"

namespace atrium::app {

/// Does the ending name a file that other programs open: .vtp .vtu .glb .html?
[[nodiscard]] bool is_export(const std::string& file);

/// Can this build write it? Asked before hours of work.  \throws RuntimeFailure  if not.
void check_export(const std::string& file);

/// Options that none of the files has a use for are mistakes.  \throws Error.
void check_export_options(const ExportSettings& settings, const std::vector<std::string>& files);

/// A solution to write.
struct ExportSource {
  const LoadedScene& loaded;
  const scene::SurfaceField& field;
  std::span<const scene::GroupField> groups;  ///< empty with one
};

/// Writes the files among these that are exports. No ray is traced.
/// \throws Error, RuntimeFailure.
void write_exports(Session& session, const ExportSource& source,
                   const std::vector<std::string>& files, const ExportSettings& settings);

}  // namespace atrium::app
