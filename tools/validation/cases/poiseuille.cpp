// Plane Poiseuille flow: fluid at rest between two plates starts to flow under a uniform force.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tools/validation/channel.h"
#include "tools/validation/flow_setup.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {
namespace poiseuille {

// Series solution [MFZ97, Eq. 21], u / V0 with V0 = F L^2 / (8 nu), the speed in the middle at the end.
double series_speed(double y, double t) {
  double u = 4 * y * (1 - y);
  for (int n = 0; n < 200; ++n) {
    const double k = (2 * n + 1) * std::numbers::pi;
    u -= 32 / (k * k * k) * std::sin(k * y) * std::exp(-k * k * t);
  }
  return u;
}

}  // namespace poiseuille

ValidationCase poiseuille_case() {
  ChannelFlow flow;
  flow.title = "Plane Poiseuille flow";
  flow.force = 8;  // F L^2 / (nu V0)
  flow.reference = poiseuille::series_speed;
  return {"poiseuille", "flow between plates under a force, from rest, against the series of Morris et al. 1997", true,
          [flow](double resolution) { return run_channel(flow, resolution); }};
}

}  // namespace flowskin::tools
