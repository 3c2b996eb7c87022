#include "tracking/mesh/mesh_measures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace flowskin::tracking {
namespace {

// Six times the volume between a triangle and the reference point, which keeps rounding small far from the origin.
double sextuple_volume(const std::vector<Vec3>& positions, const Triangle& triangle, const Vec3& reference) {
  return (positions[triangle[0]] - reference)
      .dot((positions[triangle[1]] - reference).cross(positions[triangle[2]] - reference));
}

Vec3 reference_point(const std::vector<Vec3>& positions) {
  return positions.empty() ? Vec3(Vec3::Zero()) : positions.front();
}

// Root of a vertex in a union-find forest whose roots are the lowest vertices; halves the path on its way.
int find_root(std::vector<int>& parent, int vertex) {
  while (parent[vertex] != vertex) {
    parent[vertex] = parent[parent[vertex]];
    vertex = parent[vertex];
  }
  return vertex;
}

template <class Condition>
double share_of(const std::vector<double>& values, const Condition& condition) {
  if (values.empty()) return 1;
  return static_cast<double>(std::count_if(values.begin(), values.end(), condition)) /
         static_cast<double>(values.size());
}

}  // namespace

double mesh_volume(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  const Vec3 reference = reference_point(positions);
  double sum = 0;
  for (const Triangle& triangle : triangles) sum += sextuple_volume(positions, triangle, reference);
  return sum / 6;
}

double mesh_area(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const Triangle& triangle : triangles) sum += doubled_area_vector(positions, triangle).norm();
  return sum / 2;
}

MeshComponents mesh_components(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  std::vector<int> parent(positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  std::vector<char> used(positions.size(), 0);
  for (const Triangle& triangle : triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = find_root(parent, triangle[corner]);
      const int b = find_root(parent, triangle[(corner + 1) % 3]);
      parent[std::max(a, b)] = std::min(a, b);
      used[triangle[corner]] = 1;
    }
  }
  MeshComponents components;
  components.of_vertex.assign(positions.size(), -1);
  std::vector<Vec3> references;
  for (int vertex = 0; vertex < static_cast<int>(positions.size()); ++vertex) {
    if (!used[vertex]) continue;
    const int root = find_root(parent, vertex);
    if (root == vertex) {
      components.of_vertex[vertex] = components.count++;
      references.push_back(positions[vertex]);
    } else {
      components.of_vertex[vertex] = components.of_vertex[root];
    }
  }
  components.volumes.assign(components.count, 0.0);
  components.areas.assign(components.count, 0.0);
  for (const Triangle& triangle : triangles) {
    const int component = components.of_vertex[triangle[0]];
    components.volumes[component] += sextuple_volume(positions, triangle, references[component]) / 6;
    components.areas[component] += doubled_area_vector(positions, triangle).norm() / 2;
  }
  return components;
}

int euler_characteristic(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  const int vertices = static_cast<int>(positions.size());
  const MeshAdjacency topology = build_adjacency(vertices, triangles);
  return vertices - static_cast<int>(topology.edges.size()) + static_cast<int>(triangles.size());
}

MeshQuality mesh_quality(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  MeshQuality quality;
  if (triangles.empty()) return quality;
  const std::vector<double> lengths =
      edge_lengths(build_adjacency(static_cast<int>(positions.size()), triangles), positions);
  quality.shortest_edge = *std::min_element(lengths.begin(), lengths.end());
  quality.longest_edge = *std::max_element(lengths.begin(), lengths.end());
  quality.mean_edge = std::accumulate(lengths.begin(), lengths.end(), 0.0) / static_cast<double>(lengths.size());
  quality.smallest_angle = M_PI;
  for (const Triangle& triangle : triangles) {
    const double angle = smallest_angle(positions, triangle);
    quality.smallest_angle = std::min(quality.smallest_angle, angle);
    quality.mean_smallest_angle += angle / static_cast<double>(triangles.size());
  }
  return quality;
}

double smallest_angle(const std::vector<Vec3>& positions, const Triangle& triangle) {
  double smallest = M_PI;
  for (int corner = 0; corner < 3; ++corner) {
    const Vec3& x = positions[triangle[corner]];
    const Vec3 a = positions[triangle[(corner + 1) % 3]] - x;
    const Vec3 b = positions[triangle[(corner + 2) % 3]] - x;
    smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return smallest;
}

std::vector<double> smallest_angles(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  std::vector<double> angles;
  angles.reserve(triangles.size());
  for (const Triangle& triangle : triangles) angles.push_back(smallest_angle(positions, triangle));
  return angles;
}

double share_of_angles_above(const std::vector<double>& smallest_angles, double angle) {
  return share_of(smallest_angles, [&](double smallest) { return smallest > angle; });
}

double share_of_edges_within(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                             double shortest, double longest) {
  return share_of(edge_lengths(build_adjacency(static_cast<int>(positions.size()), triangles), positions),
                  [&](double length) { return length >= shortest && length <= longest; });
}

std::vector<Vec3> vertex_normals(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
  std::vector<Vec3> normals(positions.size(), Vec3::Zero());
  for (const Triangle& triangle : triangles) {
    const Vec3 area = doubled_area_vector(positions, triangle);
    for (int vertex : triangle) normals[vertex] += area;
  }
  for (Vec3& normal : normals) {
    const double length = normal.norm();
    if (length > 0) normal /= length;
  }
  return normals;
}

}  // namespace flowskin::tracking
