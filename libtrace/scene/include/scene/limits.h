#pragma once

#include <cstddef>
#include <cstdint>

/// What readers refuse, so that a small file cannot ask for a large machine: each of these is
/// checked before anything is allocated, and the message names file and place. None is near what
/// real models have. What a file really contains is bounded by its size, and by --memory-limit.
namespace atrium::scene::limits {

// ---- any file ----

/// Of a model, mesh or buffer [bytes]; the parsers count in 32 bits.
inline constexpr std::uintmax_t kFileBytes = 0xFFFFFFFFu;
/// Of a luminaire or weather file [bytes].
inline constexpr std::uintmax_t kTableBytes = 64u << 20;
/// Triangles of a scene, those of every copy counted.
inline constexpr std::uint64_t kSceneTriangles = std::uint64_t{1} << 28;

// ---- scene files (YAML) ----

inline constexpr std::uintmax_t kYamlBytes = 16u << 20;
inline constexpr std::size_t kYamlDepth = 64;             ///< levels, those within aliases counted
inline constexpr std::size_t kYamlValues = 2'000'000;     ///< aliases and what they may name again
inline constexpr int kCopies = 100'000;                   ///< of one object
inline constexpr std::size_t kPlaced = 2'000'000;         ///< objects, those of every group counted
inline constexpr std::size_t kShapeCorners = 10'000'000;  ///< vertices of boxes, spheres, cages ...
inline constexpr std::size_t kCageCorners = 1000;         ///< of a face, and faces round a vertex

// ---- glTF ----

inline constexpr int kJsonDepth = 100;
/// Buffers without a file of their own times the binary chunk [bytes]: only one should be it.
inline constexpr std::uint64_t kBufferCopies = std::uint64_t{1} << 30;
/// Elements of an accessor without data of their own (all zero, or sparse).
inline constexpr std::size_t kElementsWithoutData = 1'000'000;
/// Numbers that are read through accessors per byte of the buffers: many may share one.
inline constexpr std::uint64_t kReadsPerByte = 256;

// ---- VTP, VTU ----

inline constexpr std::uintmax_t kMeshFileBytes = std::uintmax_t{1} << 34;
/// Numbers per byte of a compressed file, at most: 12 bytes of a point shrink to a byte or two.
inline constexpr std::uint64_t kPackedNumbersPerByte = 64;

// ---- OBJ ----

inline constexpr std::size_t kPolygonCorners = 100'000;

// ---- images ----

/// Values of one image: 256 MB as bytes, 1 GB as floats; 16k x 4k in RGBA.
inline constexpr std::uint64_t kImageValues = std::uint64_t{1} << 28;
/// An image cannot be larger than this many values per byte of its file: deflate and run lengths
/// stay below 1032:1, JPEG below that.
inline constexpr std::uint64_t kValuesPerByte = 2048;
/// Bytes of all textures of a model.
inline constexpr std::uint64_t kTextureBytes = std::uint64_t{4} << 30;

}  // namespace atrium::scene::limits
