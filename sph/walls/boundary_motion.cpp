#include "sph/walls/boundary_motion.h"

namespace flowskin::sph {

TriangleMesh placed(const TriangleMesh& mesh, const BoundaryMotion& motion, double time) {
  if (!motion.moves()) return mesh;
  TriangleMesh result = mesh;
  const Pose pose = motion.pose(time);
  for (Vec3& p : result.positions) p = pose.place(p);
  return result;
}

}  // namespace flowskin::sph
