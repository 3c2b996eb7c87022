// A mesh with flat faces and sharp edges.
#pragma once

#include <array>
#include <map>

#include "tracking/extraction/marching_cubes.h"

namespace flowskin::tracking::test {

/// The box [0, n]^3, each face of n x n squares, each square of two triangles.
inline SurfaceGeometry welded_box(int n) {
  SurfaceGeometry box;
  std::map<std::array<int, 3>, int> number;
  const auto vertex = [&](const std::array<int, 3>& place) {
    const auto [found, is_new] = number.try_emplace(place, static_cast<int>(box.positions.size()));
    if (is_new) box.positions.emplace_back(place[0], place[1], place[2]);
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        for (const int height : {0, n}) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> place{};
            place[axis] = height, place[(axis + 1) % 3] = i + u, place[(axis + 2) % 3] = j + v;
            return vertex(place);
          };
          const int a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          if (height > 0) {
            box.triangles.insert(box.triangles.end(), {{a, b, c}, {a, c, d}});
          } else {
            box.triangles.insert(box.triangles.end(), {{a, c, b}, {a, d, c}});
          }
        }
      }
    }
  }
  return box;
}

}  // namespace flowskin::tracking::test
