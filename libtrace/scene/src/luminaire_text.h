#pragma once

#include <filesystem>
#include <string>

namespace atrium::scene {

/// A file that says more is wrong; the flux still fits into single precision [cd].
inline constexpr double kMostCandela = 1e30;
/// Angles closer than this are the same [deg].
inline constexpr double kLeastStep = 1e-6;

/// The whole of a luminaire file. \throws Error  if it is missing or larger than
/// limits::kTableBytes.
[[nodiscard]] std::string read_luminaire_text(const std::filesystem::path& file);

}  // namespace atrium::scene
