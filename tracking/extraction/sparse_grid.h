// Values of the field at the nodes of a uniform grid, kept only near particles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tracking/field/metaball_field.h"

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

  /// The metaball field [FMM13, Eq. 13]: every particle adds its kernel to the nodes in its support. There is at least
  /// one layer of nodes with the outside value, -T, around the supports.
  /// @param shares factors of the particles' weights; empty: 1 each
  /// @throws std::invalid_argument where the particles spread over more than two million blocks along an axis, or where
  /// spacing, radius or threshold are not positive.
  static SparseGrid of_particles(const std::vector<Vec3>& positions, const FieldSettings& settings, double spacing,
                                 const std::vector<double>& shares = {});

  /// The field's particles, and its walls where those are.
  static SparseGrid of_field(const MetaballField& field, double spacing);

  /// A box of size[0] x size[1] x size[2] given values, z runs fastest, surrounded by the outside value.
  static SparseGrid of_values(const Index& size, const std::vector<double>& values, double outside, double spacing);

  double spacing() const { return spacing_; }
  double outside() const { return outside_; }
  const std::vector<Block>& blocks() const { return blocks_; }
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
  SparseGrid(double spacing, double outside) : spacing_(spacing), outside_(outside) {}
  void allocate(std::vector<std::uint64_t> keys);
  void add_wall(const FieldWall& wall, const FieldSettings& settings);

  double spacing_;
  double outside_;
  std::vector<std::uint64_t> keys_;  // ascending; one per block
  std::vector<Block> blocks_;
};

}  // namespace flowskin::tracking
