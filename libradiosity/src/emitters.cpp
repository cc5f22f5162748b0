#include "emitters.h"

#include <cmath>
#include <numbers>

#include "scene/vertex_colors.h"

namespace atrium::radiosity {

template <int N>
std::vector<Emitter<N>> find_emitters(const Problem<N>& problem) {
  constexpr std::size_t kMostPairs = 2000000;
  const scene::Scene& scene = problem.shading.scene();
  std::vector<Emitter<N>> list;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const scene::ObjectId id(o);
    const material::Material& m = scene.material_of(id);
    if (!m.emissive()) continue;
    if (m.emission_texture.texture.valid() ||
        (scene::vertex_colors_emit(m) && !scene.mesh_of(id).colors.empty()))
      return {};
    for (std::uint32_t t = 0; t < scene.mesh_of(id).triangles.size(); ++t)
      for (const bool back : {false, true}) {
        if (back && !m.emits_both_sides) continue;
        const scene::SurfacePoint p = scene::surface_point(scene, id, t, 0.3f, 0.3f);
        const Vec3f up = back ? Vec3f(-p.ng) : p.ng;
        list.push_back({triangle_patch(scene, id, t, back),
                        problem.shading.lights().emitted(p, up) * std::numbers::pi_v<float>});
        if (list.size() * problem.sides.active.size() > kMostPairs) return {};
      }
  }
  return list;
}

bool only_surfaces_emit(const scene::Scene& scene) {
  return scene.lights.empty() && !scene.environment;
}

template <int N>
FluxBalance emission_balance(const Problem<N>& problem, const std::vector<Emitter<N>>& emitters,
                             const Photons<N>& photons) {
  if (emitters.empty() || !only_surfaces_emit(problem.shading.scene()))
    return {.emitted = static_cast<double>(problem.shading.lights().flux().mean()),
            .absorbed = lane_mean(photons.absorbed),
            .escaped = lane_mean(photons.escaped),
            .in_medium = lane_mean(photons.in_medium),
            .standard_error = std::sqrt(photons.variance)};
  FluxBalance f;
  LaneValues<N> beyond{};
  for (const Emitter<N>& e : emitters)
    for (std::size_t lane = 0; lane < N; ++lane) {
      const double exitance = static_cast<double>(e.exitance[static_cast<int>(lane)]);
      f.emitted += exitance * e.patch.area / N;
      beyond[lane] += exitance * (e.patch.area - e.received[lane]);
    }
  for (std::size_t lane = 0; lane < N; ++lane) {
    const double lost = photons.escaped[lane] + photons.absorbed[lane] + photons.in_medium[lane];
    const double absorbed = lost > 0.0 ? beyond[lane] * photons.absorbed[lane] / lost : 0.0;
    const double in_medium = lost > 0.0 ? beyond[lane] * photons.in_medium[lane] / lost : 0.0;
    f.absorbed += absorbed / N;
    f.in_medium += in_medium / N;
    f.escaped += (beyond[lane] - absorbed - in_medium) / N;
  }
  return f;
}

#define ATRIUM_INSTANTIATE(N)                                                              \
  template std::vector<Emitter<N>> find_emitters(const Problem<N>&);                       \
  template FluxBalance emission_balance(const Problem<N>&, const std::vector<Emitter<N>>&, \
                                        const Photons<N>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
