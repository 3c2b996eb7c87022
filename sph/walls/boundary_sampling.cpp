#include "sph/walls/boundary_sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <nanoflann.hpp>

#include "sph/neighbors/point_grid.h"

namespace flowskin::sph {

namespace {

constexpr double sharp_cosine = 0.94;     // edges bent by more than 20 degrees get samples of their own
constexpr double lattice_distance = 0.7;  // in spacings: lattice points nearer than this to an edge sample are left out
constexpr double fill_distance = 0.75;    // in spacings: gaps wider than this are filled
constexpr double fill_resolution = 0.3;   // in spacings: steps in which gaps are looked for

class SurfaceSampler {
 public:
  SurfaceSampler(const TriangleMesh& mesh, double spacing, const PeriodicBox& periodic, const Box& reach)
      : mesh_(mesh), spacing_(spacing), periodic_(periodic), reach_(reach), grid_(spacing) {
    for (const auto& t : mesh.triangles) {
      const Vec3 normal = (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
      const double length = normal.norm();
      normals_.push_back(length > 0 ? Vec3(normal / length) : Vec3::Zero());
    }
  }

  std::vector<Vec3> run() {
    sample_edges();
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) sample_lattice(t);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) fill_gaps(t);
    return std::move(samples_);
  }

 private:
  using Triangle = std::array<int, 3>;
  const Vec3& corner(const Triangle& t, int k) const { return mesh_.positions[t[k]]; }

  void add(const Vec3& place, double distance) {
    const Vec3 p = periodic_.wrap(place);
    if (!contains(reach_, p)) return;
    if (has_near_image(grid_, p, distance * spacing_, periodic_)) return;
    grid_.insert(p);
    samples_.push_back(p);
  }

  // Whether an edge lies in a face of the periodic box: there the surface goes on at the other side.
  bool in_seam(const Vec3& a, const Vec3& b) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (!periodic_.along(axis)) continue;
      for (const double face : {periodic_.box().min[axis], periodic_.box().max[axis]}) {
        if (std::abs(a[axis] - face) < 1e-6 * spacing_ && std::abs(b[axis] - face) < 1e-6 * spacing_) return true;
      }
    }
    return false;
  }

  // The step of a lattice along a direction: fits a whole number of times into the period where there is one.
  double fitted(double step, const Vec3& direction) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (!periodic_.along(axis) || std::abs(direction[axis]) < 1 - 1e-9) continue;
      return periodic_.period()[axis] / std::max(1.0, std::round(periodic_.period()[axis] / step));
    }
    return step;
  }

  // Edges are told apart by the positions of their ends: meshes with split vertices are common.
  void sample_edges() {
    using Key = std::array<double, 6>;
    struct Edge {
      Vec3 a, b;
      std::vector<std::size_t> triangles;
    };
    std::map<Key, Edge> edges;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (normals_[t].isZero()) continue;
      for (int k = 0; k < 3; ++k) {
        Vec3 a = corner(mesh_.triangles[t], k), b = corner(mesh_.triangles[t], (k + 1) % 3);
        if (std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3)) std::swap(a, b);
        Edge& edge = edges[{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}];
        edge.a = a;
        edge.b = b;
        edge.triangles.push_back(t);
      }
    }
    const auto is_sharp = [&](const Edge& e) {
      if (e.triangles.size() == 1 && in_seam(e.a, e.b)) return false;
      return e.triangles.size() != 2 || normals_[e.triangles[0]].dot(normals_[e.triangles[1]]) < sharp_cosine;
    };
    std::erase_if(edges, [&](const auto& entry) { return !is_sharp(entry.second); });
    for (const auto& [key, edge] : edges) {
      add(edge.a, 0.5);
      add(edge.b, 0.5);
    }
    for (const auto& [key, edge] : edges) {
      const double pieces = std::round((edge.b - edge.a).norm() / spacing_);
      const auto [first, last] = shares_in_reach(edge.a, edge.b);
      const double end = std::min(pieces - 1, std::ceil(last * pieces) + 1);
      for (double k = std::max(1.0, std::floor(first * pieces) - 1); k <= end; ++k)
        add(edge.a + (edge.b - edge.a) * (k / pieces), 0.5);
    }
  }

  // From which share of the way from a to b to which it lies in reach; the first is greater where it passes by.
  std::pair<double, double> shares_in_reach(const Vec3& a, const Vec3& b) const {
    double first = 0, last = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double way = b[axis] - a[axis];
      if (way == 0) continue;
      const double low = (reach_.min[axis] - a[axis]) / way, high = (reach_.max[axis] - a[axis]) / way;
      first = std::max(first, std::min(low, high));
      last = std::min(last, std::max(low, high));
    }
    return {first, last};
  }

  // A triangle, and the part of it in reach, in the plane of its lattice.
  struct FlatTriangle {
    Eigen::Vector2d a, b, c;
    std::vector<Eigen::Vector2d> part;
    double size = 0;  // an upper bound of its edges
  };

  // The interval of v in which the part of a triangle in reach may lie where u is within `width` of `at`.
  static std::pair<double, double> interval(const FlatTriangle& flat, double at, double width) {
    double low = 1e300, high = -1e300;
    const auto include = [&](double v) { low = std::min(low, v), high = std::max(high, v); };
    for (std::size_t k = 0; k < flat.part.size(); ++k) {
      const Eigen::Vector2d &p = flat.part[k], &q = flat.part[(k + 1) % flat.part.size()];
      if (std::abs(p.x() - at) <= width) include(p.y());
      for (const double side : {at - width, at + width}) {
        if ((p.x() < side) != (q.x() < side)) include(p.y() + (side - p.x()) / (q.x() - p.x()) * (q.y() - p.y()));
      }
    }
    return {low, high};
  }

  // Calls visit(p) for the points of a lattice, fixed in space, that lie in triangle t (edges included), as far as it
  // is in reach. Goes only where the triangle is: the box around one that is long and thin may be a thousand times its
  // area.
  template <typename Visit>
  void for_each_lattice_point(std::size_t t, double step, Visit visit) const {
    const Vec3& n = normals_[t];
    if (n.isZero()) return;
    const Vec3 helper = std::abs(n.y()) > 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 u = (helper - helper.dot(n) * n).normalized(), v = n.cross(u);
    const Vec3 &a = corner(mesh_.triangles[t], 0), &b = corner(mesh_.triangles[t], 1),
               &c = corner(mesh_.triangles[t], 2);
    const double step_u = fitted(step, u), step_v = fitted(step, v);
    const auto flat = [&](const Vec3& p) { return Eigen::Vector2d(p.dot(u), p.dot(v)); };
    FlatTriangle triangle{flat(a), flat(b), flat(c), {}, 0};
    for (const Vec3& p : clip({a, b, c}, reach_)) triangle.part.push_back(flat(p));
    if (triangle.part.empty()) return;
    visit_rows(triangle, step_u, step_v,
               [&, above_origin = Vec3(n * n.dot(a))](double x, double y) { visit(above_origin + x * u + y * v); });
  }

  template <typename Visit>
  static void visit_rows(FlatTriangle& t, double step_u, double step_v, Visit visit) {
    const auto cross = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) { return p.x() * q.y() - p.y() * q.x(); };
    const double area2 = cross(t.b - t.a, t.c - t.a), tolerance = 1e-9;
    const double small = 1e-6;  // so that a lattice line on the triangle's edge counts as inside
    Eigen::Vector2d low = t.part[0], high = low;
    for (const Eigen::Vector2d& p : t.part) low = low.cwiseMin(p), high = high.cwiseMax(p);
    t.size = (t.b - t.a).norm() + (t.c - t.a).norm();
    // What counts as inside reaches three tolerances of the size beyond the edges; a step more is safe from rounding.
    const double width = small * step_u + 1e-8 * t.size;
    const auto i_end = std::llround(std::floor(high.x() / step_u + small));
    for (auto i = std::llround(std::ceil(low.x() / step_u - small)); i <= i_end; ++i) {
      const double x = static_cast<double>(i) * step_u;
      const auto [first, last] = interval(t, x, width);
      if (first > last) continue;
      const auto begin = std::max(std::ceil(low.y() / step_v - small), std::floor((first - width) / step_v) - 1);
      const auto end = std::min(std::floor(high.y() / step_v + small), std::ceil((last + width) / step_v) + 1);
      for (auto j = std::llround(begin); j <= std::llround(end); ++j) {
        const Eigen::Vector2d p(x, static_cast<double>(j) * step_v);
        const double wa = cross(t.b - p, t.c - p) / area2, wb = cross(t.c - p, t.a - p) / area2;
        if (wa < -tolerance || wb < -tolerance || 1 - wa - wb < -tolerance) continue;
        visit(p.x(), p.y());
      }
    }
  }

  void sample_lattice(std::size_t t) {
    for_each_lattice_point(t, spacing_, [&](const Vec3& p) { add(p, lattice_distance); });
  }

  void fill_gaps(std::size_t t) {
    for (int k = 0; k < 3; ++k) add(corner(mesh_.triangles[t], k), fill_distance);
    for_each_lattice_point(t, fill_resolution * spacing_, [&](const Vec3& p) { add(p, fill_distance); });
  }

  const TriangleMesh& mesh_;
  double spacing_;
  const PeriodicBox& periodic_;
  const Box& reach_;
  PointGrid grid_;
  std::vector<Vec3> normals_;  // zero for triangles without area
  std::vector<Vec3> samples_;
};

struct PositionCloud {
  const std::vector<Vec3>& positions;
  std::size_t kdtree_get_point_count() const { return positions.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return positions[i][static_cast<Eigen::Index>(axis)]; }
  template <class Bounds>
  bool kdtree_get_bbox(Bounds&) const {
    return false;
  }
};

}  // namespace

std::vector<Vec3> sample_surface(const TriangleMesh& mesh, double spacing, const PeriodicBox& periodic,
                                 const Box& reach) {
  return SurfaceSampler(mesh, spacing, periodic, reach).run();
}

std::vector<double> boundary_volumes(const std::vector<Vec3>& positions, KernelType kernel, double support_radius,
                                     const PeriodicBox& periodic) {
  std::vector<double> volumes(positions.size());
  if (positions.empty()) return volumes;
  using Tree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PositionCloud>, PositionCloud, 3>;
  const PositionCloud cloud{positions};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  const nanoflann::SearchParams sorted;  // by distance, so that the sum does not depend on the shape of the tree
  const Vec3 reach = Vec3::Constant(support_radius);
#pragma omp parallel for schedule(static)
  for (std::size_t b = 0; b < positions.size(); ++b) {
    std::vector<std::pair<std::uint32_t, double>> found;
    double sum = 0;
    periodic.for_each_touching_image(positions[b] - reach, positions[b] + reach, [&](const Vec3& shift) {
      const Vec3 image = positions[b] + shift;
      tree.radiusSearch(image.data(), support_radius * support_radius, found, sorted);
      for (const auto& [k, distance2] : found) sum += kernel_value(kernel, std::sqrt(distance2), support_radius);
    });
    volumes[b] = 1 / sum;
  }
  return volumes;
}

}  // namespace flowskin::sph
