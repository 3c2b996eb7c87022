#include "sph/geometry/mesh_inside.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sph/geometry/row_crossing.h"

namespace flowskin::sph {

namespace {

// How a triangle changes the winding number along the row from low x to p.
int winding_before(const TriangleMesh& mesh, const Triangle& t, const Vec3& p) {
  const auto crossing = cross_row(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], p.y(), p.z());
  return crossing && crossing->x <= p.x() ? crossing->sign : 0;
}

}  // namespace

bool is_inside(const TriangleMesh& mesh, const Vec3& p) {
  int winding = 0;
  for (const auto& t : mesh.triangles) winding += winding_before(mesh, t, p);
  return winding != 0;
}

bool InsideTest::operator()(const Vec3& p) const {
  const auto meets_row = [&p](const Box& box) {
    return box.min.x() <= p.x() && box.min.y() <= p.y() && p.y() <= box.max.y() && box.min.z() <= p.z() &&
           p.z() <= box.max.z();
  };
  int winding = 0;
  std::vector<int> open;
  if (!tree_.nodes().empty()) open.push_back(0);
  while (!open.empty()) {
    const int index = open.back();
    const TriangleTree::Node& node = tree_.nodes()[index];
    open.pop_back();
    if (!meets_row(node.box)) continue;
    if (node.right >= 0) {
      open.insert(open.end(), {node.right, index + 1});
      continue;
    }
    for (int k = node.begin; k < node.end; ++k) winding += winding_before(mesh_, mesh_.triangles[tree_.order()[k]], p);
  }
  return winding != 0;
}

bool is_closed(const TriangleMesh& mesh) {
  using Key = std::array<double, 6>;
  std::map<Key, int> balance;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = mesh.positions[t[k]], &b = mesh.positions[t[(k + 1) % 3]];
      if (a == b) continue;
      const bool swap = std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3);
      const Vec3 &p = swap ? b : a, &q = swap ? a : b;
      balance[{p.x(), p.y(), p.z(), q.x(), q.y(), q.z()}] += swap ? -1 : 1;
    }
  }
  return !mesh.triangles.empty() &&
         std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

std::vector<Vec3> lattice_points_inside(const TriangleMesh& mesh, double spacing) {
  Vec3 low = mesh.positions[mesh.triangles[0][0]], high = low;
  for (const auto& t : mesh.triangles) {
    for (const int v : t) {
      low = low.cwiseMin(mesh.positions[v]);
      high = high.cwiseMax(mesh.positions[v]);
    }
  }
  const Eigen::Array3i count = ((high - low) / spacing).array().ceil().cast<int>().max(1);
  std::vector<std::vector<RowCrossing>> rows(static_cast<std::size_t>(count.y()) * static_cast<std::size_t>(count.z()));
  const auto row_y = [&](int j) { return low.y() + (j + 0.5) * spacing; };
  const auto row_z = [&](int k) { return low.z() + (k + 0.5) * spacing; };
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Vec3 t_low = (a.cwiseMin(b).cwiseMin(c) - low) / spacing,
               t_high = (a.cwiseMax(b).cwiseMax(c) - low) / spacing;
    const int j_end = std::min(count.y() - 1, static_cast<int>(t_high.y())),
              k_end = std::min(count.z() - 1, static_cast<int>(t_high.z()));
    for (int j = std::max(0, static_cast<int>(t_low.y()) - 1); j <= j_end; ++j) {
      for (int k = std::max(0, static_cast<int>(t_low.z()) - 1); k <= k_end; ++k) {
        const double y = row_y(j), z = row_z(k);
        if (const auto crossing = cross_row(a, b, c, y, z)) {
          rows[static_cast<std::size_t>(j) * count.z() + k].push_back(*crossing);
        }
      }
    }
  }

  std::vector<Vec3> inside;
  for (int j = 0; j < count.y(); ++j) {
    for (int k = 0; k < count.z(); ++k) {
      std::vector<RowCrossing>& row = rows[static_cast<std::size_t>(j) * count.z() + k];
      std::sort(row.begin(), row.end(), [](const RowCrossing& p, const RowCrossing& q) { return p.x < q.x; });
      std::size_t next = 0;
      int winding = 0;
      for (int i = 0; i < count.x(); ++i) {
        const double x = low.x() + (i + 0.5) * spacing;
        while (next < row.size() && row[next].x <= x) winding += row[next++].sign;
        if (winding != 0) inside.emplace_back(x, row_y(j), row_z(k));
      }
    }
  }
  return inside;
}

}  // namespace flowskin::sph
