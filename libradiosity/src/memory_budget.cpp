#include "memory_budget.h"

#include <cstdio>

namespace atrium::radiosity {

std::uint64_t bytes_of(const scene::Scene& scene) {
  std::uint64_t sum = 0;
  for (const scene::Mesh& m : scene.meshes)
    sum += bytes_of(m.positions) + bytes_of(m.normals) + bytes_of(m.uvs) + bytes_of(m.colors) +
           bytes_of(m.triangles);
  for (const material::Texture& t : scene.textures) sum += bytes_of(t.pixels);
  return sum + bytes_of(scene.objects);
}

std::uint64_t bytes_of(const scene::SurfaceField& f) {
  const auto quantities = [](const scene::SurfaceField::Quantities& q) {
    return bytes_of(q.direct) + bytes_of(q.caustic) + bytes_of(q.indirect);
  };
  return bytes_of(f.facets) + bytes_of(f.nodes) + bytes_of(f.triangle_facet) +
         bytes_of(f.element_facet) + bytes_of(f.element_level) + bytes_of(f.element_x) +
         bytes_of(f.element_y) + bytes_of(f.element_area) + quantities(f.irradiance) +
         quantities(f.body_irradiance) + bytes_of(f.standard_error) + bytes_of(f.valid);
}

std::uint64_t bytes_of(const Elements& elements) {
  return bytes_of(elements.layout) + elements.pieces.bytes() + bytes_of(elements.first_piece);
}

std::string megabytes(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f MB", 1e-6 * static_cast<double>(bytes));
  return text;
}

}  // namespace atrium::radiosity
