// Plane Couette flow: fluid at rest between two plates, of which the upper one starts to move along itself.
#include <cmath>
#include <numbers>

#include "tools/validation/channel.h"

namespace flowskin::tools {
namespace couette {

// Series solution [MFZ97, Eq. 20], u / V0 with V0 the speed of the plate.
double series_speed(double y, double t) {
  double u = y;
  for (int n = 1; n < 400; ++n) {
    const double k = n * std::numbers::pi;
    u += (n % 2 == 0 ? 2 : -2) / k * std::sin(k * y) * std::exp(-k * k * t);
  }
  return u;
}

}  // namespace couette

ValidationCase couette_case() {
  ChannelFlow flow;
  flow.title = "Plane Couette flow";
  flow.wall_speed = 1;
  flow.reference = couette::series_speed;
  return {"couette", "flow between plates, one of which starts to move, against the series of Morris et al. 1997", true,
          [flow](double resolution) { return run_channel(flow, resolution); }};
}

}  // namespace flowskin::tools
