#include <numeric>

#include "passes.h"
#include "scene/parallel.h"

namespace atrium::radiosity {
namespace {

constexpr double kEnough = 64.0;      // photons: 12 % standard error
constexpr float kReach = 4.0f;        // largest kernel radius, in elements
constexpr float kSameFacing = 0.85f;  // cosine between normals of neighbours
constexpr float kSamePlane = 0.35f;   // distance from the plane over distance

/// Element sides in space, for neighbours within a radius.
struct Places {
  std::vector<Vec3f> position, normal;  // by side
  std::vector<float> size;              // by element

  template <int N>
  explicit Places(const Problem<N>& problem) {
    const scene::SurfaceField& f = problem.elements.layout;
    position.resize(problem.side_count());
    normal.resize(problem.side_count());
    size.resize(f.element_count());
    for (std::uint32_t e = 0; e < f.element_count(); ++e) {
      const scene::SurfaceField::Facet& facet = f.facets[f.element_facet[e]];
      Vec3f sum = Vec3f::Zero();
      float area = 0.0f;
      for (std::uint32_t p = problem.elements.first_piece[e];
           p < problem.elements.first_piece[e + 1]; ++p) {
        const ElementPiece piece = problem.elements.pieces[p];
        Vec3f center = Vec3f::Zero();
        for (const Vec3f& c : piece.corners) center += c;
        sum += center * (piece.area / static_cast<float>(piece.corners.size()));
        area += piece.area;
      }
      const Vec3f n = facet.axis_u.cross(facet.axis_v).normalized();
      const std::size_t front = 2 * std::size_t{e}, back = front + 1;
      position[front] = position[back] = area > 0.0f ? Vec3f(sum / area) : facet.origin;
      normal[front] = n;
      normal[back] = -n;
      size[e] = f.element_size(e);
    }
  }
};

/// Sides sorted by the cell of a uniform grid whose cells are as wide as the largest kernel.
class Grid {
 public:
  Grid(const Places& places, const std::vector<SideIndex>& sides, float width)
      : places_(places), width_(width) {
    for (const SideIndex i : sides) entries_.push_back({key(cell(places.position[i])), i});
    std::sort(entries_.begin(), entries_.end());
  }
  template <class F>
  void visit(const Vec3f& p, F&& f) const {
    const Eigen::Vector3i c = cell(p);
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const std::uint64_t k = key(c + Eigen::Vector3i(x, y, z));
          auto it = std::lower_bound(entries_.begin(), entries_.end(), std::pair(k, SideIndex{0}));
          for (; it != entries_.end() && it->first == k; ++it) f(it->second);
        }
  }

 private:
  [[nodiscard]] Eigen::Vector3i cell(const Vec3f& p) const {
    return (p / width_).array().floor().cwiseMax(-1e6f).cwiseMin(1e6f).cast<int>();
  }
  static std::uint64_t key(const Eigen::Vector3i& c) {
    const auto part = [](int v) { return static_cast<std::uint64_t>(v + (1 << 20)) & 0x1fffffU; };
    return part(c.x()) << 42U | part(c.y()) << 21U | part(c.z());
  }
  const Places& places_;
  float width_;
  std::vector<std::pair<std::uint64_t, SideIndex>> entries_;
};

/// Could two photon counts come from the same flux density? Three standard errors, with one
/// photon's worth of doubt where none arrived.
bool alike(double count_a, double area_a, double count_b, double area_b) {
  const double difference = count_a / area_a - count_b / area_b;
  const double variance = (count_a + 1.0) / (area_a * area_a) + (count_b + 1.0) / (area_b * area_b);
  return difference * difference <= 9.0 * variance;
}

float median_size(std::vector<float> size) {
  if (size.empty()) return 1.0f;
  std::nth_element(size.begin(), size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2),
                   size.end());
  return size[size.size() / 2];
}

}  // namespace

template <int N>
void smooth_photons(const Problem<N>& problem, const std::vector<std::uint32_t>& photons,
                    Estimate<N>& caustic) {
  const Places places(problem);
  const float width = kReach * median_size(places.size);
  const std::vector<SideIndex>& sides = problem.sides.active;
  const Grid grid(places, sides, width);
  const Estimate<N> before = caustic;
  const bool body = !caustic.irradiance.body.empty();

  scene::parallel_for(sides.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<std::pair<float, SideIndex>> near;
    for (std::size_t k = begin; k < end; ++k) {
      const SideIndex i = sides[k];
      if (photons[i] >= kEnough) continue;
      near.clear();
      const float reach = std::min(width, kReach * places.size[i / 2]);
      grid.visit(places.position[i], [&](SideIndex j) {
        const Vec3f d = places.position[j] - places.position[i];
        const float distance = d.norm();
        if (j == i || distance > reach || places.normal[i].dot(places.normal[j]) < kSameFacing ||
            std::abs(d.dot(places.normal[i])) > kSamePlane * distance ||
            !alike(photons[i], static_cast<double>(problem.area(i)), photons[j],
                   static_cast<double>(problem.area(j))))
          return;
        near.emplace_back(distance, j);
      });
      std::sort(near.begin(), near.end());  // ties by index: the same at any thread count
      double count = photons[i];
      float area = problem.area(i);
      Spectrum<N> flux = before.irradiance.plain[i] * area;
      Spectrum<N> body_flux = body ? before.irradiance.body[i] * area : Spectrum<N>::zero();
      float variance = before.variance[i] * area * area;
      for (const auto& [distance, j] : near) {
        if (count >= kEnough) break;
        const float a = problem.area(j);
        count += photons[j];
        area += a;
        flux += before.irradiance.plain[j] * a;
        if (body) body_flux += before.irradiance.body[j] * a;
        variance += before.variance[j] * a * a;
      }
      caustic.irradiance.plain[i] = flux / area;
      if (body) caustic.irradiance.body[i] = body_flux / area;
      caustic.variance[i] = variance / (area * area);
    }
  });

  // Averages of neighbours move flux a little; the whole keeps what the photons brought.
  Spectrum<N> old_flux, new_flux;
  for (const SideIndex i : sides) {
    old_flux += before.irradiance.plain[i] * problem.area(i);
    new_flux += caustic.irradiance.plain[i] * problem.area(i);
  }
  const Spectrum<N> scale = Spectrum<N>::generate(
      [&](int c) { return new_flux[c] > 0.0f ? old_flux[c] / new_flux[c] : 1.0f; });
  for (const SideIndex i : sides) {
    caustic.irradiance.plain[i] *= scale;
    if (body) caustic.irradiance.body[i] *= scale;
  }
}

#define ATRIUM_INSTANTIATE(N) \
  template void smooth_photons(const Problem<N>&, const std::vector<std::uint32_t>&, Estimate<N>&);
ATRIUM_INSTANTIATE(1)
ATRIUM_INSTANTIATE(3)
ATRIUM_INSTANTIATE(4)
ATRIUM_INSTANTIATE(8)
#undef ATRIUM_INSTANTIATE

}  // namespace atrium::radiosity
