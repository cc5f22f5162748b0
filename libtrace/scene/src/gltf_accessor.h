#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gltf_document.h"

namespace atrium::scene {

/// Bytes of a buffer view, every index and range checked.
[[nodiscard]] std::span<const unsigned char> gltf_view_bytes(const GltfDocument& document, int view,
                                                             const std::string& who);

/// An attribute as floats, `components` per element: any component type, normalised or not, any
/// stride, sparse, or without a buffer view (zeros).
/// \param only  elements to read, in increasing order and below gltf_count(); null: all.
/// \throws Error that names the accessor, for indices, types, counts or ranges that do not fit.
[[nodiscard]] std::vector<float> gltf_attribute(const GltfDocument& document, int accessor,
                                                int components,
                                                const std::vector<std::uint32_t>* only = nullptr);

/// Number of elements, all of which the buffers hold. \throws Error  as gltf_attribute().
[[nodiscard]] std::size_t gltf_count(const GltfDocument& document, int accessor);

/// Number of components of an accessor (1 to 4). \throws Error if there is no such accessor.
[[nodiscard]] int gltf_components(const GltfDocument& document, int accessor);

/// Indices, all checked to be below `vertices`.
[[nodiscard]] std::vector<std::uint32_t> gltf_indices(const GltfDocument& document, int accessor,
                                                      std::size_t vertices);

}  // namespace atrium::scene
