#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fields.h"
#include "mesh.h"
#include "picker.h"
#include "picture_state.h"
#include "plain_things.h"
#include "statistics.h"
#include "values.h"

class vtkRenderer;

namespace atrium::view {

/// A mesh in a renderer, as a PictureState says. Only what has changed is made again.
class Picture {
 public:
  explicit Picture(vtkRenderer& renderer);
  ~Picture();
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  /// The renderer draws with the next show(). \param mesh  lives longer than this, or until the
  /// next call. \param same_geometry  only arrays have changed.
  void set_mesh(const Mesh& mesh, bool same_geometry);
  /// What is drawn beside the mesh. \param things  lives longer than this. \param factors  of
  /// light groups, from the next set_mesh() on.
  void set_things(const PlainThings& things);
  void set_factors(const std::vector<double>& factors);
  void show(const PictureState& state);

  /// Is the mesh drawn with fewer triangles while it moves?
  [[nodiscard]] bool is_large() const;
  /// Large meshes are drawn with fewer triangles while it is true.
  void moving(bool coarse);

  [[nodiscard]] const Field& field() const;
  [[nodiscard]] const std::vector<Field>& fields() const;
  /// Of the field; "no arrays" without any.
  [[nodiscard]] std::string title() const;
  [[nodiscard]] std::size_t triangle_count() const;
  /// Of the colours, as shown.
  [[nodiscard]] const Range& range() const;
  [[nodiscard]] const std::vector<double>& contour_levels() const;
  /// Labels of contours that are seen.
  [[nodiscard]] std::size_t label_count() const;
  [[nodiscard]] double ev() const;
  /// The next show() chooses automatic exposure and range for what the camera sees then.
  void look_again();

  /// What is shown of a polygon's side and at a place of it; NaN: unknown.
  [[nodiscard]] double value_at(const Picker::Hit& hit) const;
  /// First thing that is shown along a ray.
  [[nodiscard]] std::optional<Picker::Hit> pick(const Vec3d& origin, const Vec3d& direction) const;
  /// Name of a thing without values that is shown first along a ray.
  [[nodiscard]] std::optional<std::string> thing_at(const Vec3d& origin,
                                                    const Vec3d& direction) const;
  /// Elements' values of the field on the selected surfaces.
  [[nodiscard]] Statistics statistics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace atrium::view
