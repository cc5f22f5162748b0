#include "joined_field.h"

#include <algorithm>
#include <stdexcept>

namespace atrium::radiosity {

using scene::Scene;
using scene::SurfaceField;
using Quantities = SurfaceField::Quantities;

namespace {

/// A copy of a group's arrays, dimmed, checked against the field's.
Quantities scaled(const Quantities& q, double factor, std::size_t size) {
  Quantities out = q;
  for (std::vector<float>* array : {&out.direct, &out.caustic, &out.indirect}) {
    if (!array->empty() && array->size() != size)
      throw std::invalid_argument("export: a light group of another size");
    if (factor != 1.0)
      for (float& v : *array) v *= static_cast<float>(factor);
  }
  return out;
}

/// Makes the parts sum to the whole. Slopes at rims are limited in each part by itself, so their
/// sum is not the limited slope of the sum.
void share_out(const std::vector<float>& whole, const std::vector<std::vector<float>*>& parts) {
  for (std::size_t i = 0; i < whole.size(); ++i) {
    float sum = 0.0f;
    for (const std::vector<float>* part : parts) sum += (*part)[i];
    if (sum > 0.0f)
      for (std::vector<float>* part : parts) (*part)[i] *= whole[i] / sum;
    else if (!parts.empty())
      (*parts.front())[i] = whole[i];
  }
}

}  // namespace

template <int N>
SideLight<N> JoinedField<N>::Values::at(std::size_t side) const {
  const auto read = [side](const std::vector<float>& array) {
    Spectrum<N> v;
    if (!array.empty())
      for (int k = 0; k < N; ++k) v[k] = array[side * N + static_cast<std::size_t>(k)];
    return v;
  };
  return {read(irradiance.direct), read(irradiance.caustic), read(irradiance.indirect),
          read(body.direct) + read(body.caustic) + read(body.indirect)};
}

template <int N>
JoinedField<N>::JoinedField(const Scene& scene, const Elements& elements, const SurfaceField& field,
                            GroupSpan groups)
    : scene_(scene), elements_(elements), field_(field) {
  if (field.lanes != N || field.element_count() + 1 != elements.first_piece.size())
    throw std::invalid_argument("export: the field is not one of these elements");
  mesh_ = join_pieces(scene, elements);
  cells_ = cell_corners(field);
  std::vector<std::uint32_t> element_of(elements.pieces.size());
  for (std::uint32_t e = 0; e + 1 < elements.first_piece.size(); ++e)
    for (std::uint32_t p = elements.first_piece[e]; p < elements.first_piece[e + 1]; ++p)
      element_of[p] = e;
  for (const std::uint32_t piece : mesh_.piece) element_of_.push_back(element_of[piece]);
  find_users();
  blend_.emplace(mesh_, elements, element_of_);
  add_source(field.irradiance, field.body_irradiance, 1.0);
  for (const scene::GroupField& g : groups) add_source(g.irradiance, g.body_irradiance, g.factor);
  share_corners();
}

template <int N>
void JoinedField<N>::share_corners() {
  for (const auto values : {&Values::irradiance, &Values::body})
    for (const auto array : {&Quantities::direct, &Quantities::caustic, &Quantities::indirect}) {
      std::vector<std::vector<float>*> parts;
      for (std::size_t s = 1; s < sources_.size(); ++s) {
        std::vector<float>& part = (sources_[s].corners.*values).*array;
        if (!part.empty()) parts.push_back(&part);
      }
      share_out((sources_[0].corners.*values).*array, parts);
    }
}

template <int N>
void JoinedField<N>::add_source(const Quantities& irradiance, const Quantities& body,
                                double factor) {
  const std::size_t size = 2 * std::size_t{N} * field_.element_count();
  Source s;
  s.elements = {scaled(irradiance, factor, size), scaled(body, factor, size)};
  const auto at_corners = [&](const Quantities& q) {
    return Quantities{corner_values(field_, cells_, q.direct),
                      corner_values(field_, cells_, q.caustic),
                      corner_values(field_, cells_, q.indirect)};
  };
  s.corners = {at_corners(s.elements.irradiance), at_corners(s.elements.body)};
  sources_.push_back(std::move(s));
}

template <int N>
void JoinedField<N>::find_users() {
  first_user_.assign(mesh_.position.size() + 1, 0);
  for (const std::uint32_t p : mesh_.point) ++first_user_[p + 1];
  for (std::size_t p = 0; p + 1 < first_user_.size(); ++p) first_user_[p + 1] += first_user_[p];
  std::vector<std::uint32_t> next(first_user_.begin(), first_user_.end() - 1);
  users_.resize(mesh_.point.size());
  for (std::uint32_t k = 0; k < mesh_.polygon_count(); ++k)
    for (std::uint32_t c = mesh_.first_corner[k]; c < mesh_.first_corner[k + 1]; ++c)
      users_[next[mesh_.point[c]]++] = k;
}

template <int N>
scene::SurfacePoint JoinedField<N>::surface_point(std::size_t polygon, const Vec3f& place) const {
  const ElementPiece piece = elements_.pieces[mesh_.piece[polygon]];
  const Vec2f uv = barycentric(scene_, piece, place);
  return scene::surface_point(scene_, piece.object, piece.triangle, uv.x(), uv.y());
}

template <int N>
scene::SurfacePoint JoinedField<N>::centre(std::size_t polygon) const {
  const ElementPiece piece = elements_.pieces[mesh_.piece[polygon]];
  Vec3f sum = Vec3f::Zero();
  for (const Vec3f& c : piece.corners) sum += c;
  return surface_point(polygon, sum / static_cast<float>(piece.corners.size()));
}

template <int N>
BothLights<N> JoinedField<N>::at_polygon(std::size_t polygon, std::size_t source) const {
  const std::size_t side = 2 * std::size_t{element_of_[polygon]};
  return {sources_[source].elements.at(side), sources_[source].elements.at(side + 1)};
}

template <int N>
void JoinedField<N>::at_point(std::size_t point, std::vector<BothLights<N>>& light) const {
  light.assign(sources_.size(), {});
  const std::span<const std::uint32_t> polygons = polygons_at(point);
  std::vector<std::uint32_t> facets, chosen;
  for (const std::size_t side : {0U, 1U}) {
    facets.clear();
    chosen.clear();
    for (const std::uint32_t k : polygons) {
      const std::uint32_t facet = field_.element_facet[element_of_[k]];
      if (!valid(k, side) || std::find(facets.begin(), facets.end(), facet) != facets.end())
        continue;
      facets.push_back(facet);
      chosen.push_back(element_of_[k]);
    }
    if (chosen.empty()) chosen.push_back(element_of_[polygons.front()]);
    const float share = 1.0f / static_cast<float>(chosen.size());
    for (const std::uint32_t e : chosen) {
      if (blend_->is_clump(e)) {
        add_clump(e, point, side, share, light);
        continue;
      }
      const std::array<float, 4> weight = corner_weights(field_, e, mesh_.position[point]);
      for (std::size_t s = 0; s < sources_.size(); ++s)
        for (std::size_t k = 0; k < 4; ++k) {
          const SideLight<N> v =
              sources_[s].corners.at(2 * std::size_t{cells_.of_element[e][k]} + side);
          accumulate(light[s][side], v, share * weight[k]);
        }
    }
  }
}

template <int N>
void JoinedField<N>::add_clump(std::uint32_t clump, std::size_t point, std::size_t side,
                               float share, std::vector<BothLights<N>>& light) const {
  ClumpBlend::Weights weights;
  blend_->weights(
      clump, mesh_.position[point], blend_->normal_of(polygons_at(point)),
      [&](std::uint32_t e) { return field_.valid[2 * std::size_t{e} + side] != 0; }, weights);
  for (const auto& [e, weight] : weights)
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      const SideLight<N> v = sources_[s].elements.at(2 * std::size_t{e} + side);
      accumulate(light[s][side], v, share * weight);
    }
}

template class JoinedField<1>;
template class JoinedField<3>;
template class JoinedField<4>;
template class JoinedField<8>;

}  // namespace atrium::radiosity
