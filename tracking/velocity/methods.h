// What each file of a velocity method contributes to the registry in velocity_method.cpp.
#pragma once

#include "tracking/velocity/velocity_method.h"

namespace flowskin::tracking {

VelocityMethodInfo normal_velocity_info();
VelocityMethodInfo total_velocity_info();
VelocityMethodInfo curvature_velocity_info();
VelocityMethodInfo curvature_belyaev_velocity_info();
VelocityMethodInfo rigid_velocity_info();
VelocityMethodInfo rigid_global_velocity_info();
VelocityMethodInfo affine_velocity_info();
VelocityMethodInfo simulation_velocity_info();
VelocityMethodInfo hybrid_velocity_info();

}  // namespace flowskin::tracking
