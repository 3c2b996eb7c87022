// Tree of bounding boxes over the triangles of a mesh.
#pragma once

#include <vector>

#include "common/vectors.h"

namespace flowskin {

Box bounding_box(const std::vector<Vec3>& positions, const Triangle& triangle);

/// A binary tree in which each node halves its triangles along the axis in which their centres spread most. Depends on
/// nothing but the mesh.
class TriangleTree {
 public:
  struct Node {
    Box box;
    int begin, end;  ///< Its triangles are order()[begin] to order()[end - 1].
    int right;       ///< The right child; the left one follows its parent. -1: a leaf.
  };

  /// @pre Positions are finite and indices in range.
  TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

  const std::vector<Node>& nodes() const { return nodes_; }  ///< The root first; empty without triangles.
  const std::vector<int>& order() const { return order_; }   ///< Every triangle once.
  const std::vector<Box>& boxes() const { return boxes_; }   ///< Around each triangle, in this order.

 private:
  struct Item {
    Vec3 center;
    int triangle;
  };
  void build(int index, int begin, int end, const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
             std::vector<Item>& items);

  std::vector<int> order_;
  std::vector<Box> boxes_;
  std::vector<Node> nodes_;
};

}  // namespace flowskin
