// The method `curvature` with weights to choose, for experiments.
#pragma once

#include <memory>

#include "tracking/velocity/velocity_method.h"

namespace flowskin::tracking {

/// The rows of the total velocity have the weight `least` + `factor` rho, with rho from 0 (the motion is rigid) to 1
/// (no spin explains it). Chosen by measurement, see docs/velocity_methods.md.
struct CurvatureWeights {
  double least = 3e-4;
  double factor = 8;
};

std::unique_ptr<VelocityMethod> make_curvature_velocity(const CurvatureWeights& weights);

}  // namespace flowskin::tracking
