#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

#include "glb_buffer.h"
#include "gltf_document.h"
#include "light_code.h"
#include "material/error.h"
#include "scene/baked_model.h"
#include "scene/image_io.h"
#include "scene/output_file.h"

namespace atrium::scene {
namespace {

using Kind = BakedModel::Material::Kind;
using tinygltf::Value;

Value numbers(std::initializer_list<double> list) {
  Value::Array array;
  for (const double v : list) array.emplace_back(v);
  return Value(array);
}

Value rgb_value(const Rgb& c) {
  return numbers({static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])});
}

Value names_value(const std::vector<std::string>& names) {
  Value::Array array;
  for (const std::string& n : names) array.emplace_back(n);
  return Value(array);
}

float encode_srgb(float v) {
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
}

/// In sRGB and 8 bits, up or down by chance so that the mean over texels is right: rounded values
/// show as bands wherever light changes slowly in the dark.
std::uint8_t dithered(float linear, std::uint64_t place) {
  std::uint64_t h = (place + 1) * 0x9e3779b97f4a7c15ULL;
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ULL;
  const auto chance = static_cast<float>((h ^ (h >> 32)) & 0xffffffU) * 0x1p-24f;
  return static_cast<std::uint8_t>(std::min(255.0f, 255.0f * encode_srgb(linear) + chance));
}

class Encoder {
 public:
  Encoder(const BakedModel& model, const GlbOptions& options)
      : source_(model), options_(options), buffer_(out_) {}

  std::vector<std::uint8_t> encode() {
    out_.asset.version = "2.0";
    out_.asset.generator = options_.generator;
    out_.scenes.emplace_back();
    out_.defaultScene = 0;
    choose_positions();
    choose_codes();
    add_textures();
    for (const BakedModel::Material& m : source_.materials) add_material(m);
    for (const BakedModel::Primitive& p : source_.primitives) add_primitive(p);
    for (const Camera& c : source_.cameras) add_camera(c);
    add_extras();
    out_.extensionsUsed.assign(extensions_.begin(), extensions_.end());
    if (quantised_) out_.extensionsRequired = {"KHR_mesh_quantization"};
    return bytes();
  }
  [[nodiscard]] GlbStatistics statistics() const {
    return {values_ > 0 ? static_cast<double>(clipped_) / static_cast<double>(values_) : 0.0};
  }

 private:
  /// The page's positions in 16 bits where that is finer than a millimetre.
  void choose_positions() {
    for (const BakedModel::Primitive& p : source_.primitives)
      if (!p.backdrop)
        for (const Vec3f& v : p.positions) box_.extend(v.cast<double>());
    if (box_.isEmpty()) return;
    step_ = std::max(box_.sizes().maxCoeff() / 65535.0, 1e-9);
    quantised_ = options_.page && step_ <= 1e-3;
    if (quantised_) extensions_.insert("KHR_mesh_quantization");
  }

  void choose_codes() {
    codes_.resize(source_.group_names.size());
    for (const BakedModel::Primitive& p : source_.primitives)
      for (std::size_t g = 0; g < p.groups.size(); ++g)
        for (const BakedModel::GroupLight& v : p.groups[g]) {
          codes_[g][0].largest =
              std::max(codes_[g][0].largest, static_cast<double>(v.radiance.max()));
          codes_[g][1].largest = std::max(codes_[g][1].largest, static_cast<double>(v.illuminance));
        }
  }

  // ---- pictures ----

  int add_image(const material::Texture& texture, const std::string& name, bool exact) {
    const bool png = exact || texture.channels == 2 || texture.channels == 4;
    tinygltf::Image image;
    image.name = name;
    image.mimeType = png ? "image/png" : "image/jpeg";
    const std::vector<std::uint8_t> encoded = encode_texture(texture, png ? ".png" : ".jpg");
    image.bufferView = buffer_.add_view(encoded, 0);
    out_.images.push_back(std::move(image));
    return static_cast<int>(out_.images.size() - 1);
  }

  int add_texture(int image, material::Texture::Wrap u, material::Texture::Wrap v) {
    const auto wrap = [](material::Texture::Wrap w) {
      return w == material::Texture::Wrap::Repeat   ? TINYGLTF_TEXTURE_WRAP_REPEAT
             : w == material::Texture::Wrap::Mirror ? TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT
                                                    : TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    };
    tinygltf::Sampler sampler;
    sampler.wrapS = wrap(u);
    sampler.wrapT = wrap(v);
    // The atlas has no coarser levels: they would mix charts.
    sampler.minFilter = image == atlas_image_ ? TINYGLTF_TEXTURE_FILTER_LINEAR
                                              : TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    out_.samplers.push_back(sampler);
    tinygltf::Texture texture;
    texture.sampler = static_cast<int>(out_.samplers.size() - 1);
    texture.source = image;
    out_.textures.push_back(texture);
    return static_cast<int>(out_.textures.size() - 1);
  }

  void add_textures() {
    for (std::size_t i = 0; i < source_.textures.size(); ++i) {
      const material::Texture& t = source_.textures[i];
      add_texture(add_image(t, "texture " + std::to_string(i), false), t.wrap_u, t.wrap_v);
    }
    if (source_.atlas.radiance.empty()) return;
    atlas_image_ = static_cast<int>(out_.images.size());
    add_image(atlas_texture(), "light", true);
    atlas_ =
        add_texture(atlas_image_, material::Texture::Wrap::Clamp, material::Texture::Wrap::Clamp);
  }

  material::Texture atlas_texture() {
    const BakedModel::Atlas& atlas = source_.atlas;
    material::Texture t;
    t.width = atlas.width;
    t.height = atlas.height;
    t.channels = atlas.alpha.empty() ? 3 : 4;
    t.pixels.reserve(atlas.radiance.size() * static_cast<std::size_t>(t.channels));
    for (std::size_t i = 0; i < atlas.radiance.size(); ++i) {
      const Rgb c = relative(atlas.radiance[i]);
      for (std::size_t k = 0; k < 3; ++k) t.pixels.push_back(dithered(c.lane[k], 3 * i + k));
      if (t.channels == 4) t.pixels.push_back(atlas.alpha[i]);
    }
    return t;
  }

  /// Radiance as a share of white, in [0, 1].
  Rgb relative(const Rgb& radiance) {
    ++values_;
    Rgb c;
    bool clipped = false;
    for (int k = 0; k < 3; ++k) {
      const double v = static_cast<double>(radiance[k]) / options_.white;
      clipped = clipped || v > 1.0;
      c[k] = static_cast<float>(std::clamp(v, 0.0, 1.0));
    }
    clipped_ += clipped ? 1 : 0;
    return c;
  }

  // ---- materials ----

  void add_material(const BakedModel::Material& m) {
    tinygltf::Material out;
    out.name = m.name;
    out.doubleSided = m.double_sided;
    auto& pbr = out.pbrMetallicRoughness;
    pbr.metallicFactor = m.kind == Kind::Metal ? 1.0 : 0.0;
    const bool matte = m.kind == Kind::Unlit && !(m.gloss.max() > 0.0f);
    pbr.roughnessFactor = matte ? 0.9 : static_cast<double>(m.roughness);
    pbr.baseColorFactor = {1.0, 1.0, 1.0, 1.0};
    if (m.kind != Kind::Unlit)
      for (int k = 0; k < 3; ++k)
        pbr.baseColorFactor[static_cast<std::size_t>(k)] = static_cast<double>(m.color[k]);
    pbr.baseColorTexture.index = m.atlas ? atlas_ : m.texture;
    if (m.alpha_cutoff > 0.0f) {
      out.alphaMode = "MASK";
      out.alphaCutoff = static_cast<double>(m.alpha_cutoff);
    }
    if (m.kind == Kind::Unlit) extend(out, "KHR_materials_unlit", {});
    // No extension of gloss may stand beside unlit: for programs that know it, and for people.
    if (m.kind == Kind::Unlit && !matte)
      out.extras = Value(Value::Object{
          {"atrium",
           Value(Value::Object{{"lobe_reflectance", rgb_value(m.gloss)},
                               {"lobe_roughness", Value(static_cast<double>(m.roughness))}})}});
    if (m.kind == Kind::Glass) {
      extend(out, "KHR_materials_transmission", {{"transmissionFactor", Value(1.0)}});
      extend(out, "KHR_materials_ior", {{"ior", Value(static_cast<double>(m.ior))}});
      if (m.thickness > 0.0f)
        extend(out, "KHR_materials_volume",
               {{"thicknessFactor", Value(static_cast<double>(m.thickness))},
                {"attenuationDistance", Value(1.0)},
                {"attenuationColor", rgb_value(m.attenuation)}});
    }
    out_.materials.push_back(std::move(out));
  }

  void extend(tinygltf::Material& m, const std::string& name, const Value::Object& content) {
    m.extensions[name] = Value(content);
    extensions_.insert(name);
  }

  // ---- geometry ----

  void add_primitive(const BakedModel::Primitive& p) {
    tinygltf::Primitive out;
    out.mode = TINYGLTF_MODE_TRIANGLES;
    out.material = static_cast<int>(p.material);
    out.attributes["POSITION"] = positions(p);
    if (!p.normals.empty()) out.attributes["NORMAL"] = vectors(p.normals);
    if (!p.uvs.empty()) out.attributes["TEXCOORD_0"] = vectors(p.uvs);
    if (options_.page) {
      for (std::size_t g = 0; g < p.groups.size(); ++g)
        out.attributes["_LIGHT_" + std::to_string(g)] = group_light(p.groups[g], codes_[g]);
    } else if (!p.radiance.empty()) {
      out.attributes["COLOR_0"] = colors(p.radiance);
      add_group_colors(p, out);
    }
    out.indices = indices(p);
    tinygltf::Mesh mesh;
    mesh.name = p.name;
    mesh.primitives.push_back(std::move(out));
    out_.meshes.push_back(std::move(mesh));
    tinygltf::Node node;
    node.name = p.name;
    node.mesh = static_cast<int>(out_.meshes.size() - 1);
    const bool quantised = quantised_ && !p.backdrop;
    const Vec3d shift = source_.origin + (quantised ? box_.min() : Vec3d(Vec3d::Zero()));
    if (!shift.isZero(0.0)) node.translation.assign(shift.data(), shift.data() + 3);
    if (quantised) node.scale = {step_, step_, step_};
    add_node(std::move(node));
  }

  void add_node(tinygltf::Node node) {
    out_.scenes[0].nodes.push_back(static_cast<int>(out_.nodes.size()));
    out_.nodes.push_back(std::move(node));
  }

  int positions(const BakedModel::Primitive& p) {
    if (!quantised_ || p.backdrop)
      return buffer_.add_accessor(flat(p.positions),
                                  {TINYGLTF_COMPONENT_TYPE_FLOAT, 3, false, true});
    // Elements of vertices start at multiples of four bytes: a fourth number that is not used.
    std::vector<std::uint16_t> values;
    for (const Vec3f& v : p.positions) {
      const Vec3d q = (v.cast<double>() - box_.min()) / step_;
      for (int k = 0; k < 3; ++k) values.push_back(static_cast<std::uint16_t>(std::lround(q[k])));
      values.push_back(0);
    }
    const int accessor =
        buffer_.add_accessor(values, {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 4, false, true});
    tinygltf::Accessor& a = out_.accessors[static_cast<std::size_t>(accessor)];
    a.type = TINYGLTF_TYPE_VEC3;
    a.minValues.resize(3);
    a.maxValues.resize(3);
    out_.bufferViews.back().byteStride = 8;
    return accessor;
  }

  template <class V>
  static std::vector<float> flat(const std::vector<V>& list) {
    std::vector<float> out;
    out.reserve(list.size() * static_cast<std::size_t>(V::RowsAtCompileTime));
    for (const V& v : list) out.insert(out.end(), v.data(), v.data() + V::RowsAtCompileTime);
    return out;
  }
  template <class V>
  int vectors(const std::vector<V>& list) {
    return buffer_.add_accessor(flat(list),
                                {TINYGLTF_COMPONENT_TYPE_FLOAT, int{V::RowsAtCompileTime}});
  }

  int colors(const std::vector<Rgb>& radiance) {
    std::vector<std::uint16_t> values;
    values.reserve(4 * radiance.size());
    for (const Rgb& r : radiance) {
      for (const float v : relative(r).lane)
        values.push_back(static_cast<std::uint16_t>(std::lround(65535.0f * v)));
      values.push_back(65535);
    }
    return buffer_.add_accessor(values, {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 4, true});
  }

  int group_light(const std::vector<BakedModel::GroupLight>& light,
                  const std::array<LightCode, 2>& code) {
    std::vector<std::uint16_t> values;
    values.reserve(4 * light.size());
    for (const BakedModel::GroupLight& v : light) {
      for (const float c : v.radiance.lane)
        values.push_back(code[0].encode(static_cast<double>(c)));
      values.push_back(code[1].encode(static_cast<double>(v.illuminance)));
    }
    return buffer_.add_accessor(values, {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 4, true});
  }

  void add_group_colors(const BakedModel::Primitive& p, tinygltf::Primitive& out) {
    std::vector<Rgb> radiance(p.positions.size());
    for (std::size_t g = 0; g < p.groups.size(); ++g) {
      for (std::size_t i = 0; i < radiance.size(); ++i) radiance[i] = p.groups[g][i].radiance;
      out.attributes["COLOR_" + std::to_string(g + 1)] = colors(radiance);
    }
  }

  int indices(const BakedModel::Primitive& p) {
    constexpr int kTarget = TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER;
    if (p.positions.size() < 65535) {
      const std::vector<std::uint16_t> small(p.indices.begin(), p.indices.end());
      return buffer_.add_accessor(
          small, {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 1, false, false, kTarget});
    }
    return buffer_.add_accessor(p.indices,
                                {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, 1, false, false, kTarget});
  }

  // ---- cameras, remarks ----

  void add_camera(const Camera& c) {
    if (c.kind == Camera::Kind::Panorama) return;  // glTF has none
    const double reach = std::max(1.0, box_.isEmpty() ? 0.0 : box_.diagonal().norm());
    tinygltf::Camera out;
    out.name = c.name;
    if (c.kind == Camera::Kind::Orthographic) {
      out.type = "orthographic";
      out.orthographic.ymag = 0.5 * c.height;
      out.orthographic.xmag = out.orthographic.ymag * (c.aspect > 0.0 ? c.aspect : 4.0 / 3.0);
      out.orthographic.znear = 0.0;
      out.orthographic.zfar = 4.0 * reach;
    } else {
      out.type = "perspective";
      out.perspective.yfov = c.yfov;
      out.perspective.aspectRatio = c.aspect;
      out.perspective.znear = 0.02;
      out.perspective.zfar = 4.0 * reach;
    }
    out_.cameras.push_back(out);
    tinygltf::Node node;
    node.name = c.name;
    node.camera = static_cast<int>(out_.cameras.size() - 1);
    Eigen::Matrix4d m = c.to_scene.matrix();
    m.topRightCorner<3, 1>() += source_.origin;
    node.matrix.assign(m.data(), m.data() + 16);
    add_node(std::move(node));
  }

  void add_extras() {
    const bool nits = source_.unit == RadianceUnit::Nit;
    Value::Object o{{"radiance_of_white", Value(options_.white)},
                    {"unit", Value(std::string(nits ? "cd/m^2" : "W/(sr m^2)"))},
                    {"exposure_ev", Value(options_.ev)},
                    {"radiosity", Value(std::string("pi * radiance_of_white * linear colour"))},
                    {"lightmap_texel_m", Value(source_.atlas.texel_size)},
                    {"clipped_share", Value(statistics().clipped_share)}};
    if (options_.page) {
      Value::Array groups;
      for (std::size_t g = 0; g < codes_.size(); ++g)
        groups.emplace_back(Value::Object{{"name", Value(source_.group_names[g])},
                                          {"largest_radiance", Value(codes_[g][0].largest)},
                                          {"largest_lux", Value(codes_[g][1].largest)}});
      o["groups"] = Value(groups);
      o["steps"] = Value(LightCode::kSteps);
      o["octaves"] = Value(LightCode::kOctaves);
    } else if (!source_.group_names.empty()) {
      o["light_groups"] = names_value(source_.group_names);
    }
    out_.asset.extras = Value(Value::Object{{"atrium", Value(o)}});
  }

  std::vector<std::uint8_t> bytes() {
    std::vector<unsigned char>& data = out_.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4, 0);
    if (data.size() > 0x7fffffffU) throw RuntimeFailure("glTF: more than 2 GB in one file");
    return encode_gltf(out_);
  }

  const BakedModel& source_;
  const GlbOptions& options_;
  tinygltf::Model out_;
  GlbBuffer buffer_;
  std::set<std::string> extensions_;
  Bounds box_;
  double step_ = 1.0;  // of quantised positions [m]
  bool quantised_ = false;
  std::vector<std::array<LightCode, 2>> codes_;  // by group: radiance, illuminance
  int atlas_image_ = -1, atlas_ = -1;
  std::uint64_t values_ = 0, clipped_ = 0;
};

}  // namespace

std::vector<std::uint8_t> encode_glb(const BakedModel& model, const GlbOptions& options,
                                     GlbStatistics* statistics) {
  if (!(options.white > 0.0)) throw std::invalid_argument("encode_glb: white must be above 0");
  Encoder encoder(model, options);
  std::vector<std::uint8_t> bytes = encoder.encode();
  if (statistics != nullptr) *statistics = encoder.statistics();
  return bytes;
}

void write_bytes(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& file) {
  OutputFile out(file);
  std::ofstream stream(out.path(), std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw RuntimeFailure(file.string() + ": writing failed");
  out.commit();
}

}  // namespace atrium::scene
