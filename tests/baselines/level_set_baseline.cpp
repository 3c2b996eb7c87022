// How OpenVDB's level sets fare in Enright's and Zalesak's tests, for docs/surfaces.md. Built with FLOWSKIN_BASELINES.
// Usage: level_set_baseline [CELLS [SWEEPS]]   voxels along the unit cube (80), renormalisation sweeps a step (3)
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetAdvect.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

namespace {

using openvdb::FloatGrid;
using openvdb::Vec3d;
using std::numbers::pi;

constexpr double kHalfWidth = 3;  // of the narrow band, in voxels

// What LevelSetAdvection wants of a field, but for velocity(). The library asks in world coordinates.
template <class Derived>
struct Flow {
  using ValueType = float;
  using VectorType = openvdb::math::Vec3<float>;
  openvdb::math::Transform transform() const { return {}; }
  VectorType operator()(const Vec3d& p, float /*time*/) const {
    return VectorType(static_cast<const Derived*>(this)->velocity(p));
  }
  VectorType operator()(const openvdb::Coord& c, float time) const { return (*this)(c.asVec3d(), time); }
};

// LeVeque's field [Enright et al. 2002] for one half of its period of 3, forth or back. Its factor cos(pi t / 3)
// changes how fast points go along their paths, but not where they are after a half; the library would take the factor
// of each step's beginning, so here it is its mean.
struct Deformation : Flow<Deformation> {
  explicit Deformation(double factor) : mean(2 / pi * factor) {}
  Vec3d velocity(const Vec3d& p) const {
    const auto sine = [](double x) { return std::sin(pi * x); };
    const Vec3d s(sine(p[0]), sine(p[1]), sine(p[2])), d(sine(2 * p[0]), sine(2 * p[1]), sine(2 * p[2]));
    return mean * Vec3d(2 * s[0] * s[0] * d[1] * d[2], -d[0] * s[1] * s[1] * d[2], -d[0] * d[1] * s[2] * s[2]);
  }
  double mean;
};

// One turn in three units of time about the z axis through (0.5, 0.5).
struct Turn : Flow<Turn> {
  Vec3d velocity(const Vec3d& p) const { return 2 * pi / 3 * Vec3d(0.5 - p[1], p[0] - 0.5, 0); }
};

double ball(const Vec3d& p) { return (p - Vec3d(0.35)).length() - 0.15; }

// The slot: |x - 0.5| < 0.025 and y < 0.85.
double slotted_ball(const Vec3d& p) {
  const double beside = std::abs(p[0] - 0.5) - 0.025, above = p[1] - 0.85;
  const double slot = std::hypot(std::max(beside, 0.0), std::max(above, 0.0)) + std::min(std::max(beside, above), 0.0);
  return std::max((p - Vec3d(0.5, 0.75, 0.5)).length() - 0.15, -slot);
}

FloatGrid::Ptr level_set(double (*distance)(const Vec3d&), int cells) {
  const double voxel = 1.0 / cells, band = kHalfWidth * voxel;
  const auto grid = FloatGrid::create(static_cast<float>(band));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  auto access = grid->getAccessor();
  for (const auto& c : openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(cells))) {
    const double d = distance(c.asVec3d() * voxel);
    if (std::abs(d) < band) access.setValueOn(c, static_cast<float>(d));
  }
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

double volume(const FloatGrid& grid) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(grid, points, quads);
  double sum = 0;
  for (const auto& q : quads) {
    const Vec3d a(points[q[0]]), b(points[q[1]]), c(points[q[2]]), d(points[q[3]]);
    sum += (a.dot(b.cross(c)) + a.dot(c.cross(d))) / 6;
  }
  return std::abs(sum);
}

template <class Velocity>
void advect(FloatGrid& grid, const Velocity& velocity, double duration, int sweeps) {
  openvdb::tools::LevelSetAdvection<FloatGrid, Velocity> advection(grid, velocity);
  advection.setSpatialScheme(openvdb::math::HJWENO5_BIAS);
  advection.setTemporalScheme(openvdb::math::TVD_RK3);
  advection.setTrackerSpatialScheme(openvdb::math::HJWENO5_BIAS);
  advection.setNormCount(sweeps);
  advection.advect(0, static_cast<float>(duration));
}

template <class Velocity>
void report(const char* name, double (*distance)(const Vec3d&), int cells, int sweeps, const Velocity& forth,
            const Velocity& back) {
  const FloatGrid::Ptr grid = level_set(distance, cells);
  const double start = volume(*grid);
  advect(*grid, forth, 1.5, sweeps);
  const double half = volume(*grid);
  advect(*grid, back, 1.5, sweeps);
  std::printf("%s, voxels of 1/%d: half way %.1f %%, at the end %.1f %% of the volume\n", name, cells,
              100 * half / start, 100 * volume(*grid) / start);
}

}  // namespace

int main(int argc, char** argv) {
  const int cells = argc > 1 ? std::atoi(argv[1]) : 80, sweeps = argc > 2 ? std::atoi(argv[2]) : 3;
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  openvdb::initialize();
  report("Enright's deformation", ball, cells, sweeps, Deformation(1), Deformation(-1));
  report("Zalesak's ball", slotted_ball, cells, sweeps, Turn(), Turn());
}
