// Values of a field at the nodes of a uniform grid, kept only where its surface may be.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/vectors.h"

namespace flowskin::tracking {

/// Blocks of 8 x 8 x 8 nodes in lexicographic order of their place. All other nodes have the outside value.
class SparseGrid {
 public:
  static constexpr int kSide = 8;                       ///< Nodes of a block along each axis.
  static constexpr int kNodes = kSide * kSide * kSide;  ///< Nodes of a block.
  using Index = std::array<int, 3>;

  struct Block {
    Index place;                        ///< Node (0, 0, 0) of the block is node kSide * place of the grid.
    std::array<double, kNodes> values;  ///< z runs fastest.
  };

  /// A range of nodes along each axis, both ends included.
  struct NodeBox {
    Index low, high;
  };

  /// Blocks with the outside value at every node.
  /// @param outside not positive
  /// @param keys of the blocks' places, in any order, each as often as one likes
  SparseGrid(double spacing, double outside, std::vector<std::uint64_t> keys);

  /// The values of a function at the nodes within a box, which holds its surface.
  /// @throws std::invalid_argument where the box spreads over more than two million blocks along an axis, or the
  /// spacing is not positive.
  static SparseGrid of_function(const std::function<double(const Vec3&)>& value, const Box& box, double outside,
                                double spacing);

  /// A box of size[0] x size[1] x size[2] given values, z runs fastest, surrounded by the outside value.
  static SparseGrid of_values(const Index& size, const std::vector<double>& values, double outside, double spacing);

  /// Keys ascend in lexicographic order of the places.
  static std::uint64_t key(const Index& place);
  /// The nodes from one place to another (m).
  /// @throws std::invalid_argument where those are not finite or too far away.
  static NodeBox nodes_within(const Vec3& low, const Vec3& high, double spacing);
  /// Calls visit(place) for every block that meets the box widened by `margin` nodes.
  template <class Visit>
  static void for_each_block(const NodeBox& box, int margin, const Visit& visit);

  double spacing() const { return spacing_; }
  double outside() const { return outside_; }
  const std::vector<Block>& blocks() const { return blocks_; }
  /// To be filled.
  std::vector<Block>& blocks() { return blocks_; }
  /// Number of the block at a place; -1 where there is none.
  int find(const Index& place) const;
  /// Where a node is (m). Nodes are shifted against the origin by an odd share of the spacing, so that particles on a
  /// lattice do not make rows of exact zeros.
  Vec3 position(const Index& node) const;
  /// Where a place is among the nodes: node (i, j, k) has the coordinates i, j, k.
  Vec3 coordinates(const Vec3& x) const;
  /// Value at a node, wherever it is.
  double value(const Index& node) const;
  /// Values at the corners of the cell between a node and the next ones: bit 0 of a corner's number along x, 1 along y,
  /// 2 along z.
  std::array<double, 8> corner_values(const Index& cell) const;

  static int node_in_block(int i, int j, int k) { return (i * kSide + j) * kSide + k; }

 private:
  static int block_coordinate(int node);

  double spacing_;
  double outside_;
  std::vector<std::uint64_t> keys_;  // ascending; one per block
  std::vector<Block> blocks_;
};

template <class Visit>
void SparseGrid::for_each_block(const NodeBox& box, int margin, const Visit& visit) {
  Index low{}, high{};
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = block_coordinate(box.low[axis] - margin);
    high[axis] = block_coordinate(box.high[axis] + margin);
  }
  for (int i = low[0]; i <= high[0]; ++i) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int k = low[2]; k <= high[2]; ++k) visit(Index{i, j, k});
    }
  }
}

}  // namespace flowskin::tracking
