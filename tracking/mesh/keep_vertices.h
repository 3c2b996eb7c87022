// Drops vertices of a mesh with all that they carry.
#pragma once

#include <vector>

#include "tracking/mesh/vertex_attributes.h"

namespace flowskin::tracking {

/// The values of the vertices that remain, in their order. @param number new index of each vertex, ascending; -1: drops
template <class T>
void keep_numbered(const std::vector<int>& number, std::vector<T>& values) {
  std::size_t count = 0;
  for (std::size_t vertex = 0; vertex < number.size(); ++vertex) {
    if (number[vertex] >= 0) values[count++] = values[vertex];
  }
  values.resize(count);
}

/// Of everything that vertices carry but their positions.
inline void keep_attributes(const std::vector<int>& number, SurfaceMesh& mesh) {
  for_each_attribute(mesh, [&](Carried, std::string_view, auto& values) { keep_numbered(number, values); });
}

}  // namespace flowskin::tracking
