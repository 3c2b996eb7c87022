#include "tracking/velocity/velocity_method.h"

#include <algorithm>
#include <stdexcept>

#include "tracking/velocity/methods.h"

namespace flowskin::tracking {

const std::vector<VelocityMethodInfo>& velocity_methods() {
  static const std::vector<VelocityMethodInfo> methods = [] {
    std::vector<VelocityMethodInfo> all;
    for (VelocityMethodInfo (*info)() : {
             normal_velocity_info,
             total_velocity_info,
             curvature_velocity_info,
             curvature_belyaev_velocity_info,
             rigid_velocity_info,
             rigid_global_velocity_info,
             affine_velocity_info,
             simulation_velocity_info,
             hybrid_velocity_info,
         }) {
      all.push_back(info());
    }
    return all;
  }();
  return methods;
}

std::unique_ptr<VelocityMethod> make_velocity_method(const std::string& name) {
  std::string valid;
  for (const VelocityMethodInfo& method : velocity_methods()) {
    if (method.name == name) return method.create();
    valid += (valid.empty() ? "" : ", ") + method.name;
  }
  throw std::invalid_argument("there is no velocity method \"" + name + "\"; the methods are " + valid);
}

}  // namespace flowskin::tracking
