#include "tracking/extraction/marching_cubes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "tracking/extraction/cell_triangles.h"
#include "tracking/extraction/marching_cubes_tables.h"

namespace flowskin::tracking {
namespace {

constexpr int kSide = SparseGrid::kSide;
constexpr double kNodeClearance = 1e-3;
constexpr double kRootTolerance = 1e-6;
constexpr int kRootIterations = 60;

// What one block contributes. An edge belongs to the node at its lower end.
struct BlockSurface {
  std::array<int, 8> neighbors{};   // the blocks at offsets 0 and 1 along x (bit 0), y (bit 1), z (bit 2); -1: none
  std::vector<int> vertex_of_edge;  // 3 * node + axis -> vertex, counted within the block; empty: no vertices at all
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  int first_vertex = 0;
};

// Root on the segment from a to b, as a share of it; fa and fb have different signs (zero counts as outside).
double root_on_edge(const Vec3& a, const Vec3& b, double fa, double fb, const ScalarFunction& field) {
  double low = 0, high = 1;
  if (!field) return fa / (fa - fb);
  double t = fa / (fa - fb);
  int last_side = 0;
  for (int iteration = 0; iteration < kRootIterations && high - low > kRootTolerance; ++iteration) {
    const double previous = t;
    const double f = field(a + t * (b - a));
    if (f == 0) return t;
    const int side = (f > 0) == (fa > 0) ? -1 : 1;
    if (side < 0) {
      low = t, fa = f;
      if (last_side == side) fb /= 2;
    } else {
      high = t, fb = f;
      if (last_side == side) fa /= 2;
    }
    last_side = side;
    t = low + (high - low) * fa / (fa - fb);
    if (std::abs(t - previous) < kRootTolerance) break;
  }
  return t;
}

// The vertex on the grid edge from a node along an axis; f and g are the values at its ends.
Vec3 vertex_on_edge(const SparseGrid& grid, SparseGrid::Index node, int axis, double f, double g,
                    const ScalarFunction& field) {
  const Vec3 low = grid.position(node);
  ++node[axis];
  const Vec3 high = grid.position(node);
  const double root = root_on_edge(low, high, f, g, field);
  // The clamp also catches a root that rounding made NaN.
  const double t = root > kNodeClearance ? std::min(root, 1 - kNodeClearance) : kNodeClearance;
  return low + t * (high - low);
}

// Calls visit(edge) for the edges of a cell whose ends are on different sides.
template <class Visit>
void for_each_crossed_edge(int pattern, const Visit& visit) {
  const CellTables& tables = cell_tables();
  for (int edge = 0; edge < 12; ++edge) {
    const auto [low, high] = tables.edge_corners[edge];
    if ((pattern >> low & 1) != (pattern >> high & 1)) visit(edge);
  }
}

// Appends the triangles of a cell. vertex_on(edge) gives number and place of the vertex on an edge of the cell; it is
// called once for each edge whose ends are on different sides.
template <class VertexOn>
void fill_cell(int pattern, std::vector<Triangle>& triangles, const VertexOn& vertex_on) {
  std::array<int, 12> vertices{};
  std::array<Vec3, 12> places;
  for_each_crossed_edge(pattern, [&](int edge) { std::tie(vertices[edge], places[edge]) = vertex_on(edge); });
  for (const auto& [i, j, k] : triangles_of_cell(pattern, places))
    triangles.push_back({vertices[i], vertices[j], vertices[k]});
}

class Marcher {
 public:
  Marcher(const SparseGrid& grid, const ScalarFunction& field) : grid_(grid), field_(field) {
    surfaces_.resize(grid.blocks().size());
  }

  SurfaceGeometry run() {
    const int count = static_cast<int>(surfaces_.size());
#pragma omp parallel for schedule(dynamic, 4)
    for (int b = 0; b < count; ++b) {
      find_neighbors(b);
      place_vertices(b);
    }
    int vertices = 0;
    for (BlockSurface& surface : surfaces_) {
      surface.first_vertex = vertices;
      vertices += static_cast<int>(surface.positions.size());
    }
#pragma omp parallel for schedule(dynamic, 4)
    for (int b = 0; b < count; ++b) place_triangles(b);

    SurfaceGeometry result;
    for (const BlockSurface& surface : surfaces_) {
      result.positions.insert(result.positions.end(), surface.positions.begin(), surface.positions.end());
      result.triangles.insert(result.triangles.end(), surface.triangles.begin(), surface.triangles.end());
    }
    return result;
  }

 private:
  void find_neighbors(int b) {
    const SparseGrid::Index& place = grid_.blocks()[b].place;
    for (int offset = 0; offset < 8; ++offset) {
      surfaces_[b].neighbors[offset] =
          grid_.find({place[0] + (offset & 1), place[1] + (offset >> 1 & 1), place[2] + (offset >> 2 & 1)});
    }
  }

  // The block that holds node (i, j, k) relative to block b, each 0 to kSide, and the node's number in it.
  int locate(int b, int i, int j, int k, int& node) const {
    const int offset = (i == kSide ? 1 : 0) | (j == kSide ? 2 : 0) | (k == kSide ? 4 : 0);
    node = SparseGrid::node_in_block(i % kSide, j % kSide, k % kSide);
    return surfaces_[b].neighbors[offset];
  }

  double value(int b, int i, int j, int k) const {
    int node = 0;
    const int block = locate(b, i, j, k, node);
    return block < 0 ? grid_.outside() : grid_.blocks()[block].values[node];
  }

  void place_vertices(int b) {
    BlockSurface& surface = surfaces_[b];
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        for (int k = 0; k < kSide; ++k) {
          const int node = SparseGrid::node_in_block(i, j, k);
          const double f = grid_.blocks()[b].values[node];
          for (int axis = 0; axis < 3; ++axis) {
            const double g = value(b, i + (axis == 0), j + (axis == 1), k + (axis == 2));
            if ((f > 0) != (g > 0)) place_vertex(surface, b, {i, j, k}, axis, f, g);
          }
        }
      }
    }
  }

  void place_vertex(BlockSurface& surface, int b, const SparseGrid::Index& local, int axis, double f, double g) const {
    const SparseGrid::Index& place = grid_.blocks()[b].place;
    SparseGrid::Index index{};
    for (int a = 0; a < 3; ++a) index[a] = kSide * place[a] + local[a];
    if (surface.vertex_of_edge.empty()) surface.vertex_of_edge.assign(3 * SparseGrid::kNodes, -1);
    const int node = SparseGrid::node_in_block(local[0], local[1], local[2]);
    surface.vertex_of_edge[3 * node + axis] = static_cast<int>(surface.positions.size());
    surface.positions.push_back(vertex_on_edge(grid_, index, axis, f, g, field_));
  }

  void place_triangles(int b) {
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        // Corners at the lower and upper end of z share most values from one cell to the next.
        int low_bits = layer_bits(b, i, j, 0);
        for (int k = 0; k < kSide; ++k) {
          const int high_bits = layer_bits(b, i, j, k + 1);
          const int pattern = low_bits | high_bits << 4;
          if (pattern != 0 && pattern != 255) place_cell(b, {i, j, k}, pattern);
          low_bits = high_bits;
        }
      }
    }
  }

  int layer_bits(int b, int i, int j, int k) const {
    return (value(b, i, j, k) > 0 ? 1 : 0) | (value(b, i + 1, j, k) > 0 ? 2 : 0) | (value(b, i, j + 1, k) > 0 ? 4 : 0) |
           (value(b, i + 1, j + 1, k) > 0 ? 8 : 0);
  }

  void place_cell(int b, const SparseGrid::Index& cell, int pattern) {
    const CellTables& tables = cell_tables();
    fill_cell(pattern, surfaces_[b].triangles, [&](int edge) {
      const int start = tables.edge_corners[edge][0];
      int node = 0;
      const int block = locate(b, cell[0] + (start & 1), cell[1] + (start >> 1 & 1), cell[2] + (start >> 2 & 1), node);
      const BlockSurface& owner = surfaces_[block];
      const int vertex = owner.vertex_of_edge[3 * node + edge / 4];
      return std::pair(owner.first_vertex + vertex, owner.positions[vertex]);
    });
  }

  const SparseGrid& grid_;
  const ScalarFunction& field_;
  std::vector<BlockSurface> surfaces_;
};

// Marches in some cells: edges first, then their roots on all threads, then triangles.
class CellMarcher {
 public:
  CellMarcher(const SparseGrid& grid, const CellSet& cells) : grid_(grid) {
    for (const CellSet::Cell& cell : cells.cells()) add(cell);
  }

  SurfaceGeometry run(const ScalarFunction& field) const {
    SurfaceGeometry result;
    result.positions.resize(edges_.size());
#pragma omp parallel for schedule(dynamic, 64)
    for (std::ptrdiff_t i = 0; i < std::ssize(edges_); ++i) {
      const Edge& edge = edges_[i];
      result.positions[i] = vertex_on_edge(grid_, edge.node, edge.axis, edge.low, edge.high, field);
    }
    auto vertex = vertices_.begin();
    for (const int pattern : patterns_) {
      fill_cell(pattern, result.triangles, [&](int) {
        const int v = *vertex++;
        return std::pair(v, result.positions[v]);
      });
    }
    return result;
  }

 private:
  struct Edge {
    SparseGrid::Index node;
    int axis;
    double low, high;  // values at its ends
  };

  void add(const CellSet::Cell& cell) {
    const std::array<double, 8> values = grid_.corner_values(cell);
    int pattern = 0;
    for (int c = 0; c < 8; ++c) pattern |= values[c] > 0 ? 1 << c : 0;
    if (pattern == 0 || pattern == 255) return;
    patterns_.push_back(pattern);
    for_each_crossed_edge(pattern, [&](int edge) {
      const int axis = edge / 4;
      const auto [low, high] = cell_tables().edge_corners[edge];
      const SparseGrid::Index node = {cell[0] + (low & 1), cell[1] + (low >> 1 & 1), cell[2] + (low >> 2)};
      const auto [place, is_new] = vertex_of_edge_.try_emplace({node, axis}, static_cast<int>(edges_.size()));
      if (is_new) edges_.push_back({node, axis, values[low], values[high]});
      vertices_.push_back(place->second);
    });
  }

  const SparseGrid& grid_;
  std::vector<int> patterns_;  // of the cells with some surface
  std::vector<int> vertices_;  // on the crossed edges of each of them
  std::vector<Edge> edges_;    // one for each vertex
  std::map<std::pair<SparseGrid::Index, int>, int> vertex_of_edge_;
};

}  // namespace

SurfaceGeometry march(const SparseGrid& grid, const ScalarFunction& field) { return Marcher(grid, field).run(); }

SurfaceGeometry march(const SparseGrid& grid, const CellSet& cells, const ScalarFunction& field) {
  return CellMarcher(grid, cells).run(field);
}

void put_on_root(const SparseGrid& grid, const ScalarFunction& field, Vec3& position) {
  // It is on a grid edge: of its coordinates two are whole numbers.
  const Vec3 x = grid.coordinates(position);
  const Vec3 off = (x - Vec3(x.array().round())).cwiseAbs();
  int axis = 0;
  off.maxCoeff(&axis);
  SparseGrid::Index node{};
  for (int a = 0; a < 3; ++a) node[a] = static_cast<int>(a == axis ? std::floor(x[a]) : std::round(x[a]));
  SparseGrid::Index next = node;
  ++next[axis];
  position = vertex_on_edge(grid, node, axis, grid.value(node), grid.value(next), field);
}

}  // namespace flowskin::tracking
