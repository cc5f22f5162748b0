#pragma once

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace atrium::scene {

/// The one buffer of a GLB file, filled view by view, and the accessors on it.
class GlbBuffer {
 public:
  explicit GlbBuffer(tinygltf::Model& model) : model_(model) { model_.buffers.emplace_back(); }

  /// A view at a multiple of four bytes. \param target  TINYGLTF_TARGET_..., 0: none (images).
  int add_view(std::span<const std::uint8_t> bytes, int target) {
    std::vector<unsigned char>& data = model_.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4, 0);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = bytes.size();
    view.target = target;
    data.insert(data.end(), bytes.begin(), bytes.end());
    model_.bufferViews.push_back(std::move(view));
    return static_cast<int>(model_.bufferViews.size() - 1);
  }

  struct Kind {
    int component_type;  ///< TINYGLTF_COMPONENT_TYPE_...
    int components;      ///< 1 to 4; an element's bytes are a multiple of four for vertices
    bool normalized = false;
    bool bounds = false;  ///< min and max are stated (positions)
    int target = TINYGLTF_TARGET_ARRAY_BUFFER;
  };
  template <class T>
  int add_accessor(const std::vector<T>& values, const Kind& kind) {
    tinygltf::Accessor a;
    const auto components = static_cast<std::size_t>(kind.components);
    a.bufferView =
        add_view({reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)},
                 kind.target);
    a.componentType = kind.component_type;
    a.type = components == 1 ? TINYGLTF_TYPE_SCALAR : kind.components;  // TINYGLTF_TYPE_VEC2 is 2
    a.count = values.size() / components;
    a.normalized = kind.normalized;
    if (kind.bounds)
      for (std::size_t k = 0; k < components; ++k) {
        double low = static_cast<double>(values[k]);
        double high = low;
        for (std::size_t i = k; i < values.size(); i += components) {
          low = std::min(low, static_cast<double>(values[i]));
          high = std::max(high, static_cast<double>(values[i]));
        }
        a.minValues.push_back(low);
        a.maxValues.push_back(high);
      }
    model_.accessors.push_back(std::move(a));
    return static_cast<int>(model_.accessors.size() - 1);
  }

 private:
  tinygltf::Model& model_;
};

}  // namespace atrium::scene
