#include "element_edges.h"

#include <algorithm>

namespace atrium::view {

std::vector<std::array<std::uint32_t, 2>> element_edges(const Mesh& mesh,
                                                        const std::vector<std::uint8_t>& shown) {
  struct Edge {
    std::array<std::uint32_t, 2> ends;
    float element;
  };
  const Array* id = find_array(mesh.polygons.cell_arrays, "element_id");
  std::vector<Edge> edges;
  for (std::size_t k = 0; k < mesh.polygon_count(); ++k) {
    if (!shown.empty() && shown[k] == 0) continue;
    const auto corners = mesh.corners(k);
    const float element = id != nullptr ? id->values[k] : static_cast<float>(k);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t a = corners[i];
      const std::uint32_t b = corners[(i + 1) % corners.size()];
      edges.push_back({{std::min(a, b), std::max(a, b)}, element});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
  std::vector<std::array<std::uint32_t, 2>> result;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t next = i;
    while (next < edges.size() && edges[next].ends == edges[i].ends) ++next;
    const bool inside = id != nullptr && next - i > 1 &&
                        std::all_of(edges.begin() + static_cast<std::ptrdiff_t>(i),
                                    edges.begin() + static_cast<std::ptrdiff_t>(next),
                                    [&](const Edge& e) { return e.element == edges[i].element; });
    if (!inside && edges[i].ends[0] != edges[i].ends[1]) result.push_back(edges[i].ends);
    i = next;
  }
  return result;
}

}  // namespace atrium::view
