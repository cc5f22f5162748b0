#include "model_budget.h"

#include <array>
#include <cstdio>

#include "material/error.h"
#include "scene/limits.h"

namespace atrium::scene {
namespace {

template <class T>
std::uint64_t bytes_of(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

}  // namespace

std::uint64_t bytes_of(const MeshData& m) {
  std::uint64_t sum = bytes_of(m.positions) + bytes_of(m.normals) + bytes_of(m.uvs) +
                      bytes_of(m.colors) + bytes_of(m.triangles);
  if (m.cage) sum += bytes_of(m.cage->face_sizes) + bytes_of(m.cage->face_indices);
  return sum;
}

std::string megabytes(std::uint64_t bytes) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.1f MB", 1e-6 * static_cast<double>(bytes));
  return text.data();
}

void ModelBudget::count() {
  for (; meshes_ < model_.meshes.size(); ++meshes_) mesh_bytes_ += bytes_of(model_.meshes[meshes_]);
  for (; textures_ < model_.textures.size(); ++textures_)
    texture_bytes_ += bytes_of(model_.textures[textures_].pixels);
}

void ModelBudget::need(std::uint64_t bytes, const std::string& what) {
  if (limit_ == 0) return;
  count();
  const std::uint64_t held = mesh_bytes_ + texture_bytes_;
  if (held > limit_ || bytes > limit_ - held)
    throw RuntimeFailure(what + ": needs " + megabytes(bytes) + " beside " + megabytes(held) +
                         " of geometry and textures; a memory limit of " + megabytes(limit_) +
                         " does not hold them");
}

void ModelBudget::need_texture(std::uint64_t bytes, const std::string& what) {
  need(bytes, what);
  count();
  if (texture_bytes_ > limits::kTextureBytes || bytes > limits::kTextureBytes - texture_bytes_)
    throw Error(what + ": all textures together would be larger than " +
                megabytes(limits::kTextureBytes));
}

}  // namespace atrium::scene
