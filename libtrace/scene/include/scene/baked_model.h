#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "material/texture.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace atrium::scene {

/// A solved scene as viewers without light show it: triangles that carry their radiance.
struct BakedModel {
  static constexpr std::int32_t kNone = -1;

  /// How a viewer shows a surface.
  struct Material {
    enum class Kind {
      Unlit,  ///< radiance of the vertices times texture or atlas
      Metal,  ///< mirrors and rough metals: what they show depends on the viewer
      Glass   ///< panes and solids
    };
    std::string name;
    Kind kind = Kind::Unlit;
    std::int32_t texture = kNone;  ///< into textures; multiplies
    bool atlas = false;            ///< the radiance is BakedModel::atlas at the uvs
    float alpha_cutoff = 0.0f;     ///< points of the texture with less alpha are not there
    bool double_sided = false;     ///< else backs are not seen
    Rgb color{1.0f};               ///< Metal: reflectance at normal incidence. Glass: transmittance
    float roughness = 0.0f;        ///< of glTF, Metal, and Unlit with gloss
    Rgb gloss{0.0f};               ///< Unlit: reflectance at normal incidence of the lobe left out
    float ior = 1.5f;              ///< Glass
    float thickness = 0.0f;        ///< [m] of a solid, roughly; 0: a pane
    Rgb attenuation{1.0f};         ///< transmittance of 1 m of a solid
  };
  /// Radiance and irradiance due to one light group.
  struct GroupLight {
    Rgb radiance;
    float illuminance = 0.0f;  ///< [lx]
  };
  struct Primitive {
    std::string name;  ///< of the object
    std::uint32_t material = 0;
    std::vector<Vec3f> positions;  ///< relative to origin [m]
    std::vector<Vec3f> normals;    ///< where a viewer's own light falls (Metal, Glass)
    std::vector<Vec2f> uvs;        ///< of the texture or the atlas, or empty
    std::vector<Rgb> radiance;     ///< of vertices, Unlit without atlas; before the texture
    /// By group, then vertex; empty if not asked for. In files COLOR_1, COLOR_2, ...
    std::vector<std::vector<GroupLight>> groups;
    std::vector<std::uint32_t> indices;  ///< triangles
    bool backdrop = false;               ///< the sky, far away: no part of the scene's extent
  };
  /// A picture of radiance that unlit surfaces look up.
  struct Atlas {
    int width = 0, height = 0;
    double texel_size = 0.0;          ///< [m]
    std::vector<Rgb> radiance;        ///< rows from the top
    std::vector<std::uint8_t> alpha;  ///< 0 where a cut-out surface is not there; or empty: 255
  };

  std::vector<Primitive> primitives;
  std::vector<Material> materials;
  std::vector<material::Texture> textures;
  Atlas atlas;
  std::vector<Camera> cameras;  ///< relative to origin
  Vec3d origin = Vec3d::Zero();
  RadianceUnit unit = RadianceUnit::Nit;
  std::vector<std::string> group_names;
  std::vector<std::string> warnings;  ///< what could not be kept, one line each
};

/// How a baked model is written.
struct GlbOptions {
  /// Radiance [unit of the scene] that becomes 1, the brightest that 8-bit viewers show.
  double white = 1.0;
  double ev = 0.0;    ///< that `white` follows from, for the record
  bool page = false;  ///< for the web page: group lights as attributes, small
  std::string generator = "Atrium";
};

struct GlbStatistics {
  double clipped_share = 0.0;  ///< of the vertices or texels brighter than white
};

/// Binary glTF 2.0: KHR_materials_unlit with linear COLOR_0 (16 bit) or an sRGB atlas inside (8
/// bit, as browsers read them whatever is stored; dithered, so that dark gradients have no bands).
/// `asset.extras` says what radiance white stands for (docs/web.md, docs/mesh_files.md).
/// \throws RuntimeFailure  if there are textures and no image module.
[[nodiscard]] std::vector<std::uint8_t> encode_glb(const BakedModel& model,
                                                   const GlbOptions& options,
                                                   GlbStatistics* statistics = nullptr);

/// Complete or absent. \throws Error, RuntimeFailure.
void write_bytes(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& file);

}  // namespace atrium::scene
