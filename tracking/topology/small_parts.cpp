#include "tracking/topology/small_parts.h"

#include <algorithm>
#include <cmath>

#include "tracking/mesh/mesh_measures.h"

namespace flowskin::tracking {
namespace {

// Less than this share of the small volume is nothing.
constexpr double kNothing = 1e-3;

}  // namespace

bool drop_spoilt_parts(const Projection& projection, const std::vector<int>& bad, double small_volume,
                       SurfaceMesh& mesh) {
  const MeshComponents components = mesh_components(mesh.positions, mesh.triangles);
  std::vector<char> dropped(components.count);
  for (int c = 0; c < components.count; ++c) dropped[c] = components.volumes[c] < kNothing * small_volume;
  for (int vertex : projection.failed) dropped[components.of_vertex[vertex]] = 1;
  for (int t : bad) dropped[components.of_vertex[mesh.triangles[t][0]]] = 1;
  for (int c = 0; c < components.count; ++c) {
    if (std::abs(components.volumes[c]) >= small_volume) dropped[c] = 0;
  }
  if (std::find(dropped.begin(), dropped.end(), 1) == dropped.end()) return false;

  std::vector<int> number(mesh.positions.size(), -1);
  int count = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (dropped[components.of_vertex[v]]) continue;
    mesh.positions[count] = mesh.positions[v];
    mesh.rest_positions[count] = mesh.rest_positions[v];
    mesh.velocities[count] = mesh.velocities[v];
    mesh.ids[count] = mesh.ids[v];
    number[v] = count++;
  }
  mesh.positions.resize(count);
  mesh.rest_positions.resize(count);
  mesh.velocities.resize(count);
  mesh.ids.resize(count);
  std::erase_if(mesh.triangles, [&](const Triangle& triangle) { return number[triangle[0]] < 0; });
  for (Triangle& triangle : mesh.triangles) {
    for (int& vertex : triangle) vertex = number[vertex];
  }
  return true;
}

}  // namespace flowskin::tracking
