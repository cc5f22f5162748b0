#include <algorithm>
#include <optional>

#include "gltf_accessor.h"
#include "gltf_material.h"
#include "import_util.h"
#include "material/error.h"
#include "scene/image_io.h"
#include "scene/parallel.h"

namespace atrium::scene {
namespace {

using Wrap = material::Texture::Wrap;

Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::Clamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::Mirror : Wrap::Repeat;
}

/// An image as its file holds it.
struct Encoded {
  std::vector<std::uint8_t> bytes;
  std::string name;  ///< for messages
};

Encoded find_image(const GltfDocument& document, int index) {
  const auto& images = document.model.images;
  const std::string who = "image " + std::to_string(index);
  if (index < 0 || static_cast<std::size_t>(index) >= images.size())
    throw Error(document.at(who + " does not exist"));
  const tinygltf::Image& image = images[static_cast<std::size_t>(index)];
  if (image.bufferView >= 0) {
    const auto bytes = gltf_view_bytes(document, image.bufferView, who);
    return {{bytes.begin(), bytes.end()}, document.at(who)};
  }
  if (!image.image.empty()) return {image.image, document.at(who)};
  const std::filesystem::path file = file_beside(document.file, percent_decode(image.uri));
  return {read_file_bytes(file), file.string()};
}

int source_of(const GltfDocument& document, int texture) {
  const auto& textures = document.model.textures;
  if (static_cast<std::size_t>(texture) >= textures.size())
    throw Error(document.at("texture " + std::to_string(texture) + " does not exist"));
  return textures[static_cast<std::size_t>(texture)].source;
}

material::Texture decode(const GltfDocument& document, int index, bool srgb) {
  const auto& model = document.model;
  const Encoded image = find_image(document, source_of(document, index));
  material::Texture out = decode_texture(image.bytes, image.name);
  out.srgb = srgb;
  const tinygltf::Texture& texture = model.textures[static_cast<std::size_t>(index)];
  if (texture.sampler >= 0 && static_cast<std::size_t>(texture.sampler) < model.samplers.size()) {
    const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(texture.sampler)];
    out.wrap_u = wrap_of(sampler.wrapS);
    out.wrap_v = wrap_of(sampler.wrapT);
  }
  return out;
}

}  // namespace

GltfTextures::GltfTextures(const GltfDocument& document, const std::set<int>& materials,
                           Model& model, ModelBudget& budget) {
  for (const int material : materials) {
    const tinygltf::Material& m = document.model.materials[static_cast<std::size_t>(material)];
    const auto want = [&](int index, bool srgb) {
      if (index >= 0) ids_[{index, srgb}] = {};
    };
    want(m.pbrMetallicRoughness.baseColorTexture.index, true);
    want(m.emissiveTexture.index, true);
    want(m.pbrMetallicRoughness.metallicRoughnessTexture.index, false);
    want(m.normalTexture.index, false);
  }
  std::vector<std::pair<int, bool>> wanted;
  for (const auto& [key, id] : ids_) wanted.push_back(key);
  std::vector<std::optional<material::Texture>> decoded(wanted.size());
  std::vector<std::string> failures(wanted.size());
  // Sizes first and one by one: what does not fit is the same whatever the threads do.
  std::uint64_t coming = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    try {
      const Encoded image = find_image(document, source_of(document, wanted[i].first));
      const std::uint64_t bytes = measure_texture(image.bytes, image.name);
      budget.need_texture(coming + bytes, image.name);
      coming += bytes;
    } catch (const Error& e) {
      failures[i] = e.what();
    }
  }
  parallel_for(wanted.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!failures[i].empty()) continue;
      try {
        decoded[i] = decode(document, wanted[i].first, wanted[i].second);
      } catch (const Error& e) {
        failures[i] = e.what();
      }
    }
  });
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (decoded[i]) {
      ids_[wanted[i]] = material::TextureId{static_cast<std::uint32_t>(model.textures.size())};
      model.textures.push_back(std::move(*decoded[i]));
    } else {
      model.warnings.push_back(document.at("texture " + std::to_string(wanted[i].first) +
                                           " left out: " + one_line(failures[i])));
    }
  }
}

material::TextureId GltfTextures::find(int texture, bool srgb) const {
  const auto it = ids_.find({texture, srgb});
  return it == ids_.end() ? material::TextureId{} : it->second;
}

}  // namespace atrium::scene
