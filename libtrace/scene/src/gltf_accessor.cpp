#include "gltf_accessor.h"

#include <algorithm>
#include <cstring>

#include "material/error.h"
#include "scene/limits.h"

namespace atrium::scene {
namespace {

std::string name_of(int accessor) { return "accessor " + std::to_string(accessor); }

const tinygltf::Accessor& checked_accessor(const GltfDocument& document, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= document.model.accessors.size()) {
    throw Error(document.at(name_of(index) + " does not exist"));
  }
  return document.model.accessors[static_cast<std::size_t>(index)];
}

std::size_t component_bytes(const GltfDocument& document, int type, const std::string& who) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      throw Error(
          document.at(who + ": component type " + std::to_string(type) + " is not one of glTF's"));
  }
}

template <class T>
T load(const unsigned char* p) {
  T value;
  std::memcpy(&value, p, sizeof(T));
  return value;
}

/// One component as a number; normalised integers by the formulas of the glTF specification 3.11.
float component(const unsigned char* p, int type, bool normalized) {
  const auto signed_unit = [](float v, float most) { return std::max(v / most, -1.0f); };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const auto v = static_cast<float>(load<std::int8_t>(p));
      return normalized ? signed_unit(v, 127.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const auto v = static_cast<float>(*p);
      return normalized ? v / 255.0f : v;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const auto v = static_cast<float>(load<std::int16_t>(p));
      return normalized ? signed_unit(v, 32767.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const auto v = static_cast<float>(load<std::uint16_t>(p));
      return normalized ? v / 65535.0f : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return static_cast<float>(load<std::uint32_t>(p));
    default:
      return load<float>(p);
  }
}

std::uint32_t unsigned_value(const unsigned char* p, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *p;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(p);
    default:
      return load<std::uint32_t>(p);
  }
}

/// Where the elements of an accessor (or of its sparse parts) lie.
struct Elements {
  const unsigned char* first = nullptr;  ///< null: all zero
  std::size_t count = 0;
  std::size_t stride = 0;
  [[nodiscard]] const unsigned char* at(std::size_t i) const { return first + i * stride; }
};

Elements locate(const GltfDocument& document, int view, std::size_t offset, std::size_t count,
                std::size_t element_bytes, bool may_stride, const std::string& who) {
  const std::span<const unsigned char> bytes = gltf_view_bytes(document, view, who);
  const std::size_t given = document.model.bufferViews[static_cast<std::size_t>(view)].byteStride;
  const std::size_t stride = may_stride && given != 0 ? given : element_bytes;
  if (stride < element_bytes)
    throw Error(document.at(who + ": byteStride is smaller than an element"));
  // All sizes are far below 2^64 / 2^32, so that the products below cannot wrap.
  const bool fits =
      count == 0 || (offset <= bytes.size() && element_bytes <= bytes.size() - offset &&
                     (count - 1) <= (bytes.size() - offset - element_bytes) / stride);
  if (!fits) {
    throw Error(document.at(who + ": " + std::to_string(count) +
                            " elements do not fit into bufferView " + std::to_string(view) + " (" +
                            std::to_string(bytes.size()) + " bytes)"));
  }
  return {bytes.data() + (count == 0 ? 0 : offset), count, stride};
}

Elements locate_base(const GltfDocument& document, const tinygltf::Accessor& a,
                     std::size_t element_bytes, const std::string& who) {
  if (a.bufferView >= 0) {
    return locate(document, a.bufferView, a.byteOffset, a.count, element_bytes, true, who);
  }
  if (a.count > limits::kElementsWithoutData) {
    throw Error(document.at(who + ": " + std::to_string(a.count) + " elements without data"));
  }
  return {nullptr, a.count, element_bytes};
}

/// Calls write(element, pointer) for every value that a sparse accessor replaces.
template <class F>
void for_each_sparse(const GltfDocument& document, const tinygltf::Accessor& a,
                     std::size_t element_bytes, const std::string& who, F&& write) {
  if (!a.sparse.isSparse) return;
  const int type = a.sparse.indices.componentType;
  const std::size_t index_bytes = component_bytes(document, type, who + ", sparse indices");
  if (a.sparse.count < 0 || static_cast<std::size_t>(a.sparse.count) > a.count) {
    throw Error(document.at(who + ": more sparse values than elements"));
  }
  const auto count = static_cast<std::size_t>(a.sparse.count);
  const auto offset = [&](int bytes) {
    if (bytes < 0) throw Error(document.at(who + ": negative sparse byteOffset"));
    return static_cast<std::size_t>(bytes);
  };
  const Elements where =
      locate(document, a.sparse.indices.bufferView, offset(a.sparse.indices.byteOffset), count,
             index_bytes, false, who + ", sparse indices");
  const Elements what =
      locate(document, a.sparse.values.bufferView, offset(a.sparse.values.byteOffset), count,
             element_bytes, false, who + ", sparse values");
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t element = unsigned_value(where.at(i), type);
    if (element >= a.count) {
      throw Error(document.at(who + ": sparse index " + std::to_string(element) +
                              " is out of range (" + std::to_string(a.count) + " elements)"));
    }
    write(element, what.at(i));
  }
}

}  // namespace

std::span<const unsigned char> gltf_view_bytes(const GltfDocument& document, int view,
                                               const std::string& who) {
  const auto& model = document.model;
  if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size()) {
    throw Error(document.at(who + ": bufferView " + std::to_string(view) + " does not exist"));
  }
  const tinygltf::BufferView& v = model.bufferViews[static_cast<std::size_t>(view)];
  if (v.buffer < 0 || static_cast<std::size_t>(v.buffer) >= model.buffers.size()) {
    throw Error(document.at(who + ": buffer " + std::to_string(v.buffer) + " does not exist"));
  }
  const std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(v.buffer)].data;
  if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset) {
    throw Error(document.at(who + ": bufferView " + std::to_string(view) +
                            " reaches beyond buffer " + std::to_string(v.buffer) + " (" +
                            std::to_string(data.size()) + " bytes)"));
  }
  return {data.data() + v.byteOffset, v.byteLength};
}

int gltf_components(const GltfDocument& document, int accessor) {
  switch (checked_accessor(document, accessor).type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    default:
      throw Error(document.at(name_of(accessor) + ": is no vector"));
  }
}

std::size_t gltf_count(const GltfDocument& document, int accessor) {
  const tinygltf::Accessor& a = checked_accessor(document, accessor);
  const std::string who = name_of(accessor);
  const auto components = static_cast<std::size_t>(gltf_components(document, accessor));
  const std::size_t bytes = component_bytes(document, a.componentType, who);
  static_cast<void>(locate_base(document, a, components * bytes, who));
  return a.count;
}

std::vector<float> gltf_attribute(const GltfDocument& document, int accessor, int components,
                                  const std::vector<std::uint32_t>* only) {
  const tinygltf::Accessor& a = checked_accessor(document, accessor);
  const std::string who = name_of(accessor);
  if (gltf_components(document, accessor) != components) {
    throw Error(document.at(who + ": has not " + std::to_string(components) + " components"));
  }
  const auto width = static_cast<std::size_t>(components);
  const std::size_t bytes = component_bytes(document, a.componentType, who);
  const Elements base = locate_base(document, a, bytes * width, who);
  const std::size_t count = only == nullptr ? a.count : only->size();
  std::vector<float> out(count * width, 0.0f);
  const auto write = [&](std::size_t place, const unsigned char* p) {
    float* to = out.data() + place * width;
    for (std::size_t k = 0; k < width; ++k)
      to[k] = component(p + k * bytes, a.componentType, a.normalized);
  };
  if (base.first != nullptr) {
    for (std::size_t i = 0; i < count; ++i) write(i, base.at(only == nullptr ? i : (*only)[i]));
  }
  for_each_sparse(document, a, bytes * width, who,
                  [&](std::uint32_t element, const unsigned char* p) {
                    if (only == nullptr) return write(element, p);
                    const auto at = std::lower_bound(only->begin(), only->end(), element);
                    if (at != only->end() && *at == element)
                      write(static_cast<std::size_t>(at - only->begin()), p);
                  });
  return out;
}

std::vector<std::uint32_t> gltf_indices(const GltfDocument& document, int accessor,
                                        std::size_t vertices) {
  const tinygltf::Accessor& a = checked_accessor(document, accessor);
  const std::string who = name_of(accessor);
  const bool is_unsigned = a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (!is_unsigned || a.type != TINYGLTF_TYPE_SCALAR) {
    throw Error(document.at(who + ": indices must be unsigned integers"));
  }
  const std::size_t bytes = component_bytes(document, a.componentType, who);
  const Elements base = locate_base(document, a, bytes, who);
  std::vector<std::uint32_t> out(a.count, 0);
  const auto write = [&](std::size_t i, const unsigned char* p) {
    out[i] = unsigned_value(p, a.componentType);
  };
  if (base.first != nullptr) {
    for (std::size_t i = 0; i < a.count; ++i) write(i, base.at(i));
  }
  for_each_sparse(document, a, bytes, who, write);
  for (const std::uint32_t index : out) {
    if (index >= vertices) {
      throw Error(document.at(who + ": index " + std::to_string(index) + " is out of range (" +
                              std::to_string(vertices) + " vertices)"));
    }
  }
  return out;
}

}  // namespace atrium::scene
