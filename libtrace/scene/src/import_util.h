#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "model_budget.h"
#include "scene/limits.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace atrium::scene {

/// The whole file. \throws Error "FILE: ..." if missing, no regular file, empty or above the limit.
[[nodiscard]] std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& file,
                                                        std::uintmax_t limit = limits::kFileBytes);

/// The file that a model names, by a path that uses / or \\: beside it or below.
/// \throws Error "FILE: ..." for absolute paths, drives, `..` and names that are none.
[[nodiscard]] std::filesystem::path file_beside(const std::filesystem::path& model,
                                                const std::string& name);

/// Line breaks become "; ", trailing ones vanish: messages of parsers fit on one line.
[[nodiscard]] std::string one_line(const std::string& text);

/// %20 and friends of a URI.
[[nodiscard]] std::string percent_decode(const std::string& uri);

/// The material of geometry that names none: grey, reflectance 0.5, diffuse.
[[nodiscard]] material::Material grey_material(const std::string& name);

/// Sets k_rg, (n, kappa) per channel of a metal whose reflectance at normal incidence is f0.
///
/// Gulbrandsen 2014 with edge tint 1: n = (1 - r)/(1 + r), k = 2 sqrt(r)/(1 + r), so |N| = 1 and
/// kappa = k/n = 2 sqrt(r)/(1 - r). r is limited to 0.999. (MATERIAL_MODEL 7)
void set_metal(material::Material& material, const Rgb& f0);

/// A thin sheet that passes the share t, coloured by `tint`, and has a body of colour `base`
/// beside.
///
/// t >= 1/2: a smooth pane of index n, its tint times t (a pane has no body: that share is lost).
/// t < 1/2: a translucent Lambertian sheet, reflectance (1 - t) base, transmittance t tint.
void set_thin_sheet(material::Material& material, double t, const Rgb& tint, const Rgb& base,
                    double n);

/// One number where the three channels agree, so that grey scenes need one lane only.
[[nodiscard]] material::SpectralValue spectral(const Rgb& color);

/// Roughness of glTF (0 to 1) to c [1/rad]: m = roughness^2, c = 1/m; m below 1e-3 is smooth.
[[nodiscard]] double roughness_to_c(double roughness);

/// Clamped to [0, 1]; not a number becomes 0.
[[nodiscard]] double unit_range(double value);
[[nodiscard]] Rgb unit_range(const Rgb& value);

/// texture_bytes(), but a build that cannot read images at all is an Error, too: models do without.
[[nodiscard]] std::uint64_t measure_texture(const std::vector<std::uint8_t>& bytes,
                                            const std::string& name);

/// Reads a texture that a model names. \return invalid, with a warning in the model, if that fails
/// or the file lies elsewhere (file_beside()).
[[nodiscard]] material::TextureId add_texture_file(Model& model, ModelBudget& budget,
                                                   const std::filesystem::path& model_file,
                                                   const std::string& name, bool srgb);

}  // namespace atrium::scene
