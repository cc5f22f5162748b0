#include "material_study/lobes.h"

#include <array>
#include <cmath>
#include <numbers>

#include "material/bsdf.h"
#include "material/paper.h"

namespace atrium::study {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

// Polar coordinates about the mirror direction: distance from it grows with the third power of the
// index, so that a lobe of a hundredth of a radian has some ten nodes.
constexpr int kDistances = 120, kAzimuths = 72;
// Patches: a cap of 5 degrees, rings of 10 degrees in sectors.
constexpr int kSectors = 12, kRings = 19;

struct Nodes {
  struct Node {
    Vec3f wi;
    double weight;  // solid angle
    int patch;
  };
  std::vector<Node> nodes;

  explicit Nodes(double theta) {
    const double s = std::sin(theta), c = std::cos(theta);
    const Vec3d r(-s, 0.0, c), x(c, 0.0, s), y(0.0, 1.0, 0.0);
    for (int i = 0; i < kDistances; ++i) {
      const auto distance = [](double u) { return kPi * u * u * u; };
      const double a = distance(double{1} * i / kDistances);
      const double b = distance((i + 1.0) / kDistances);
      const double psi = distance((i + 0.5) / kDistances);
      const double solid_angle = (std::cos(a) - std::cos(b)) * 2.0 * kPi / kAzimuths;
      const int ring = psi < 5.0 * kDegree ? 0 : 1 + static_cast<int>((psi / kDegree - 5.0) / 10.0);
      for (int j = 0; j < kAzimuths; ++j) {
        const double phi = 2.0 * kPi * (j + 0.5) / kAzimuths;
        const Vec3d wi =
            std::cos(psi) * r + std::sin(psi) * (std::cos(phi) * x + std::sin(phi) * y);
        if (!(wi.z() > 0.0)) continue;
        const int sector = ring == 0 ? 0 : j * kSectors / kAzimuths;
        nodes.push_back({wi.cast<float>(), solid_angle, ring * kSectors + sector});
      }
    }
  }
};

}  // namespace

struct LobeSurface::Kind {
  virtual ~Kind() = default;
  [[nodiscard]] virtual double eval_cos(const Vec3f& wo, const Vec3f& wi) const = 0;
  [[nodiscard]] virtual double mirror(const Vec3f& wo) const = 0;
};

namespace {

template <int N>
double luminance_of(const Spectrum<N>& lanes) {
  if constexpr (N == 1)
    return static_cast<double>(lanes[0]);
  else
    return static_cast<double>(atrium::luminance(lanes));
}

template <int N, class Kind>
struct Surface final : Kind {
  material::Material material;
  material::ResolvedMaterial<N> resolved;
  material::Bsdf<N> bsdf;
  material::PaperSurface<N> paper;
  bool literal;

  Surface(const material::Material& m, trace::Mode mode, const material::SpectralBasis& basis)
      : material(m),
        resolved(material::resolve_material<N>(material, basis)),
        bsdf(resolved, true, Spectrum<N>::one(), Spectrum<N>::one(), 1.0f),
        paper(resolved, true, Spectrum<N>::one(), Spectrum<N>::one(), 1.0f),
        literal(mode == trace::Mode::Paper) {}

  double eval_cos(const Vec3f& wo, const Vec3f& wi) const override {
    if (literal) return luminance_of<N>(paper.direct(wo, wi)) * std::numbers::inv_pi;
    return luminance_of<N>(bsdf.eval(wo, wi).sum()) * static_cast<double>(wi.z());
  }
  double mirror(const Vec3f& wo) const override {
    if (literal) return luminance_of<N>(paper.mirror(wo.z()));
    if (!bsdf.has(material::kMirror)) return 0.0;
    // A sample of this event alone has probability one, so that its weight is the reflectance.
    const auto s = bsdf.sample(wo, 0.5f, Vec2f(0.5f, 0.5f), material::kMirror);
    return s ? luminance_of<N>(s->weight) : 0.0;
  }
};

}  // namespace

LobeSurface::LobeSurface(const material::Material& material, trace::Mode mode,
                         const material::SpectralBasis& basis) {
  if (basis.lanes() == 1)
    kind_ = std::make_unique<const Surface<1, Kind>>(material, mode, basis);
  else
    kind_ = std::make_unique<const Surface<3, Kind>>(material, mode, basis);
}
LobeSurface::~LobeSurface() = default;

double LobeSurface::eval_cos(const Vec3f& wo, const Vec3f& wi) const {
  return kind_->eval_cos(wo, wi);
}
double LobeSurface::mirror(const Vec3f& wo) const { return kind_->mirror(wo); }

Vec3f in_plane(double theta_deg) {
  const double t = theta_deg * kDegree;
  return Vec3d(std::sin(t), 0.0, std::cos(t)).cast<float>();
}

LobeDifference lobe_difference(const LobeSurface& reference, const LobeSurface& other,
                               double theta_deg) {
  const Nodes nodes(theta_deg * kDegree);
  const Vec3f wo = in_plane(theta_deg);
  const double mirror = reference.mirror(wo), other_mirror = other.mirror(wo);
  std::array<double, std::size_t{kSectors} * kRings> patches{};
  patches[0] = mirror - other_mirror;
  LobeDifference d;
  d.albedo = mirror;
  d.other = other_mirror;
  d.strict = std::abs(mirror - other_mirror);
  for (const Nodes::Node& node : nodes.nodes) {
    const double a = reference.eval_cos(wo, node.wi) * node.weight;
    const double b = other.eval_cos(wo, node.wi) * node.weight;
    d.albedo += a;
    d.other += b;
    d.strict += std::abs(a - b);
    patches[static_cast<std::size_t>(node.patch)] += a - b;
  }
  for (const double p : patches) d.seen += std::abs(p);
  d.strict /= d.albedo;
  d.seen /= d.albedo;
  d.mirror = mirror / d.albedo;
  d.other_mirror = d.other > 0.0 ? other_mirror / d.other : 0.0;
  return d;
}

}  // namespace atrium::study
