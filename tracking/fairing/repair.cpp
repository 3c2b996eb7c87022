#include "tracking/fairing/repair.h"

#include "tracking/fairing/bad_triangles.h"
#include "tracking/fairing/relaxation.h"

namespace flowskin::tracking {
namespace {

constexpr int kRounds = 4;
constexpr int kRings = 2;
constexpr int kRelaxations = 5;

std::vector<int> surroundings(const std::vector<int>& failed, const std::vector<int>& bad,
                              const MeshAdjacency& topology, const std::vector<Triangle>& triangles) {
  std::vector<char> marked(topology.vertex_count(), 0);
  for (int vertex : failed) marked[vertex] = 1;
  for (int t : bad) {
    for (int vertex : triangles[t]) marked[vertex] = 1;
  }
  for (int ring = 0; ring < kRings; ++ring) {
    std::vector<char> wider = marked;
    for (const auto& [a, b] : topology.edges) {
      if (marked[a] || marked[b]) wider[a] = wider[b] = 1;
    }
    marked.swap(wider);
  }
  std::vector<int> vertices;
  for (int vertex = 0; vertex < topology.vertex_count(); ++vertex) {
    if (marked[vertex]) vertices.push_back(vertex);
  }
  return vertices;
}

}  // namespace

void repair(const ImplicitField& field, const ProjectionSettings& settings, const MeshAdjacency& topology,
            const std::vector<Triangle>& triangles, std::vector<Vec3>& positions, Projection& projection) {
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<int> bad = bad_triangles(positions, triangles, topology, projection.normals);
    if (bad.empty() && projection.failed.empty()) return;
    const std::vector<int> vertices = surroundings(projection.failed, bad, topology, triangles);
    relax(field, settings, topology, triangles, kRelaxations, vertices, positions, projection.normals);
    project_moved(field, settings, vertices, positions, projection);
  }
}

}  // namespace flowskin::tracking
