// The methods that solve for the motions of all vertices together: rigid-global and affine.
#include "tracking/velocity/coupled_motion.h"
#include "tracking/velocity/methods.h"

namespace flowskin::tracking {
namespace {

// Chosen by measurement, see docs/velocity_methods.md.
constexpr CouplingWeights rigid_weights{{100, 1, 0.3}, 0.3, 1};
constexpr CouplingWeights affine_weights{{100, 1, 1}, 1, 0.1};

template <class Motion>
class CoupledVelocity final : public VelocityMethod {
 public:
  explicit CoupledVelocity(const CouplingWeights& weights) : weights_(weights) {}
  void evaluate(const ImplicitField& field, const MeshAdjacency& topology, const std::vector<Vec3>& positions,
                std::vector<Vec3>& velocities) const override {
    coupled_velocities<Motion>(field, topology, positions, weights_, SolverLimits{}, velocities);
  }

 private:
  CouplingWeights weights_;
};

}  // namespace

VelocityMethodInfo rigid_global_velocity_info() {
  return {"rigid-global",
          "Rigid motions of all vertices, tied along the edges: exact for bodies that turn, also where parts look the "
          "same from all sides.",
          []() -> std::unique_ptr<VelocityMethod> {
            return std::make_unique<CoupledVelocity<RigidMotion>>(rigid_weights);
          }};
}

VelocityMethodInfo affine_velocity_info() {
  return {"affine",
          "Affine motions of all vertices, tied along the edges: exact for every linear flow, the best without "
          "particle velocities.",
          []() -> std::unique_ptr<VelocityMethod> {
            return std::make_unique<CoupledVelocity<AffineMotion>>(affine_weights);
          }};
}

}  // namespace flowskin::tracking
