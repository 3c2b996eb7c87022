// Flow between two plates that starts from rest: Poiseuille, Couette.
#pragma once

#include <functional>
#include <string>

#include "tools/validation/validation_case.h"

namespace flowskin::tools {

/// Lengths in units of the width L, speeds of V0, times of L^2 / nu.
struct ChannelFlow {
  std::string title;
  double force = 0;  ///< F L^2 / (nu V0)
  /// Speed at the distance y from the lower plate at time t.
  std::function<double(double y, double t)> reference;
};

/// The flow at a Reynolds number of 0.0125 [MFZ97], with 10, 20 and 40 particles across, against the reference.
ValidationResult run_channel(const ChannelFlow& flow, double resolution);

}  // namespace flowskin::tools
