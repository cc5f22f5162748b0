#include "adjacency.h"

#include <algorithm>
#include <bit>

namespace atrium::scene {
namespace {

std::uint64_t hash_position(const Vec3f& p) {
  std::uint64_t h = 0x9E3779B97F4A7C15u;
  for (int k = 0; k < 3; ++k) {
    // + 0 makes the negative zero the positive one.
    h = (h ^ std::bit_cast<std::uint32_t>(p[k] + 0.0f)) * 0xBF58476D1CE4E5B9u;
    h ^= h >> 31;
  }
  return h;
}

}  // namespace

Weld weld_positions(const std::vector<Vec3f>& positions) {
  Weld weld;
  weld.id.resize(positions.size());
  const std::size_t size = std::bit_ceil(positions.size() * 2 + 2);
  std::vector<std::uint32_t> table(size, Adjacency::kNone);  // open addressing: first vertex there
  for (std::size_t i = 0; i < positions.size(); ++i) {
    std::size_t at = hash_position(positions[i]) & (size - 1);
    while (table[at] != Adjacency::kNone && positions[table[at]] != positions[i])
      at = (at + 1) & (size - 1);
    if (table[at] == Adjacency::kNone) {
      table[at] = static_cast<std::uint32_t>(i);
      weld.id[i] = weld.count++;
    } else {
      weld.id[i] = weld.id[table[at]];
    }
  }
  return weld;
}

Adjacency find_adjacency(const std::vector<Triangle>& triangles, const Weld& weld) {
  Adjacency out;
  out.uses.reserve(triangles.size() * 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint64_t a = weld.id[triangles[t][e]];
      const std::uint64_t b = weld.id[triangles[t][(e + 1) % 3]];
      const std::uint64_t key = std::min(a, b) << 32 | std::max(a, b);
      out.uses.push_back({key, static_cast<std::uint32_t>(3 * t + e), a < b});
    }
  }
  std::sort(out.uses.begin(), out.uses.end(), [](const auto& x, const auto& y) {
    return x.key != y.key ? x.key < y.key : x.slot < y.slot;
  });
  out.across.assign(triangles.size() * 3, Adjacency::kNone);
  out.for_each_edge([&](const Adjacency::EdgeUse* first, const Adjacency::EdgeUse* last) {
    if (last - first == 2) {
      out.across[first[0].slot] = first[1].slot;
      out.across[first[1].slot] = first[0].slot;
    } else if (last - first > 2) {
      ++out.non_manifold;
    }
  });
  return out;
}

Parts connected_parts(const Adjacency& adjacency) {
  Parts parts;
  const std::size_t triangles = adjacency.across.size() / 3;
  parts.of_triangle.assign(triangles, Adjacency::kNone);
  std::vector<std::uint32_t> open;
  for (std::size_t seed = 0; seed < triangles; ++seed) {
    if (parts.of_triangle[seed] != Adjacency::kNone) continue;
    parts.of_triangle[seed] = parts.count;
    open.assign(1, static_cast<std::uint32_t>(seed));
    while (!open.empty()) {
      const std::size_t t = open.back();
      open.pop_back();
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t slot = adjacency.across[3 * t + e];
        if (slot == Adjacency::kNone || parts.of_triangle[slot / 3] != Adjacency::kNone) continue;
        parts.of_triangle[slot / 3] = parts.count;
        open.push_back(slot / 3);
      }
    }
    ++parts.count;
  }
  return parts;
}

}  // namespace atrium::scene
