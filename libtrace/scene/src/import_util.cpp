#include "import_util.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "material/error.h"
#include "scene/image_io.h"

namespace atrium::scene {

std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& file, std::uintmax_t limit) {
  std::error_code code;
  const auto status = std::filesystem::status(file, code);
  if (code || !std::filesystem::exists(status)) throw Error(file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw Error(file.string() + ": not a file");
  const std::uintmax_t size = std::filesystem::file_size(file, code);
  if (code) throw Error(file.string() + ": cannot be read: " + code.message());
  if (size == 0) throw Error(file.string() + ": the file is empty");
  if (size > limit)
    throw Error(file.string() + ": larger than " + std::to_string(limit) + " bytes");
  std::ifstream in(file, std::ios::binary);
  std::vector<std::uint8_t> bytes(size);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) throw Error(file.string() + ": cannot be read");
  return bytes;
}

std::filesystem::path file_beside(const std::filesystem::path& model, const std::string& name) {
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  const std::filesystem::path relative(slashes);
  const bool climbs = std::any_of(relative.begin(), relative.end(),
                                  [](const std::filesystem::path& part) { return part == ".."; });
  const bool drive = (slashes.size() > 1 && slashes[1] == ':') || slashes.starts_with("file:") ||
                     slashes.find("://") != std::string::npos;
  if (relative.empty() || relative.has_root_path() || climbs || drive ||
      slashes.find('\0') != std::string::npos) {
    throw Error(model.string() + ": '" + name +
                "' does not lie beside the model or below it (relative path without '..')");
  }
  return model.parent_path() / relative;
}

std::string one_line(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\r') continue;
    if (c != '\n') {
      out += c;
    } else if (!out.empty() && out.back() != ';') {
      out += ';';
    }
  }
  while (!out.empty() && (out.back() == ';' || out.back() == ' ')) out.pop_back();
  std::string spaced;
  for (std::size_t i = 0; i < out.size(); ++i) {
    spaced += out[i];
    if (out[i] == ';' && i + 1 < out.size() && out[i + 1] != ' ') spaced += ' ';
  }
  return spaced;
}

std::string percent_decode(const std::string& uri) {
  const auto hex = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escape =
        uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0;
    if (!escape) {
      out += uri[i];
      continue;
    }
    out += static_cast<char>(hex(uri[i + 1]) * 16 + hex(uri[i + 2]));
    i += 2;
  }
  return out;
}

material::Material grey_material(const std::string& name) {
  material::Material m;
  m.name = name;
  m.body_reflectance = 0.5;
  return m;
}

double unit_range(double value) { return value > 0.0 ? std::fmin(value, 1.0) : 0.0; }

Rgb unit_range(const Rgb& value) {
  return Rgb::generate([&](int i) { return unit_range(static_cast<double>(value[i])); });
}

void set_metal(material::Material& material, const Rgb& f0) {
  Rgb n;
  Rgb kappa;
  for (int i = 0; i < 3; ++i) {
    const double r = std::fmin(unit_range(static_cast<double>(f0[i])), 0.999);
    n[i] = static_cast<float>((1.0 - r) / (1.0 + r));
    kappa[i] = static_cast<float>(2.0 * std::sqrt(r) / (1.0 - r));
  }
  material.medium = material::Material::Medium::Opaque;
  material.combination = material::Material::Combination::Convex;
  material.n = n;
  material.kappa = kappa;
  material.k_rg = 1.0;
  material.k_df = 0.0;
}

void set_thin_sheet(material::Material& m, double t, const Rgb& tint, const Rgb& base, double n) {
  const auto share = static_cast<float>(t);
  m.combination = material::Material::Combination::Convex;
  m.c = std::numeric_limits<double>::infinity();
  m.n = n;
  m.kappa = 0.0;
  m.roughness_texture = {};
  m.reflectance_texture = {};
  if (t >= 0.5) {
    m.medium = material::Material::Medium::Pane;
    m.k_rg = m.k_tp_rg = 1.0;
    m.k_df = m.k_tp_df = 0.0;
    m.transmission_tint = spectral(tint * share);
    m.body_reflectance.reset();
    m.body_texture = {};
  } else {
    m.medium = material::Material::Medium::Opaque;
    m.k_rg = m.k_tp_rg = 0.0;
    m.k_df = m.k_tp_df = 1.0;
    m.body_reflectance = spectral(base * (1.0f - share));
    m.body_transmittance = spectral(tint * share);
  }
}

material::SpectralValue spectral(const Rgb& c) {
  if (c[0] == c[1] && c[1] == c[2]) return static_cast<double>(c[0]);
  return c;
}

double roughness_to_c(double roughness) {
  const double m = unit_range(roughness) * unit_range(roughness);
  return m < 1e-3 ? std::numeric_limits<double>::infinity() : 1.0 / m;
}

std::uint64_t measure_texture(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  try {
    return texture_bytes(bytes, name);
  } catch (const RuntimeFailure& e) {
    throw Error(e.what());
  }
}

material::TextureId add_texture_file(Model& model, ModelBudget& budget,
                                     const std::filesystem::path& model_file,
                                     const std::string& name, bool srgb) {
  try {
    const std::filesystem::path file = file_beside(model_file, name);
    const std::vector<std::uint8_t> bytes = read_file_bytes(file);
    budget.need_texture(measure_texture(bytes, file.string()), file.string());
    material::Texture texture = decode_texture(bytes, file.string());
    texture.srgb = srgb;
    model.textures.push_back(std::move(texture));
    return material::TextureId{static_cast<std::uint32_t>(model.textures.size() - 1)};
  } catch (const Error& e) {
    model.warnings.push_back("texture left out: " + one_line(e.what()));
    return {};
  }
}

}  // namespace atrium::scene
