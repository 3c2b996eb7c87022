#include "tools/validation/thin_film.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flowskin::tools {
namespace {

double cubed(double x) { return x * x * x; }

// Solves the tridiagonal system in place: `low` below the diagonal, `high` above it; the solution is left in `right`.
void solve_tridiagonal(const std::vector<double>& low, std::vector<double> diagonal, const std::vector<double>& high,
                       std::vector<double>& right) {
  for (std::size_t k = 1; k < right.size(); ++k) {
    const double factor = low[k] / diagonal[k - 1];
    diagonal[k] -= factor * high[k - 1];
    right[k] -= factor * right[k - 1];
  }
  right.back() /= diagonal.back();
  for (std::size_t k = right.size() - 1; k-- > 0;) right[k] = (right[k] - high[k] * right[k + 1]) / diagonal[k];
}

// Heights after a step; the mobility h^3 is iterated.
std::vector<double> step(const std::vector<double>& start, double ring, double mobility, double dt) {
  const std::size_t count = start.size();
  std::vector<double> heights = start, low(count), diagonal(count), high(count);
  for (int iteration = 0; iteration < 4; ++iteration) {
    std::fill(low.begin(), low.end(), 0.0);
    std::fill(high.begin(), high.end(), 0.0);
    std::fill(diagonal.begin(), diagonal.end(), 1.0);
    for (std::size_t k = 0; k + 1 < count; ++k) {
      const double face = static_cast<double>(k + 1) * ring;
      const double mean = 0.5 * (cubed(heights[k]) + cubed(heights[k + 1]));
      const double flow = dt * mobility * mean * face / (ring * ring);
      const double inner = face - 0.5 * ring, outer = face + 0.5 * ring;
      diagonal[k] += flow / inner;
      high[k] -= flow / inner;
      diagonal[k + 1] += flow / outer;
      low[k + 1] -= flow / outer;
    }
    heights = start;
    solve_tridiagonal(low, diagonal, high, heights);
  }
  return heights;
}

// Near the front h^3 falls linearly [Huppert 1982, Eq. 2.21]: where the line through two rings behind it ends.
double front_of(const std::vector<double>& heights, double ring) {
  const double limit = 0.2 * heights[0];
  std::size_t last = heights.size() - 1;
  while (last > 1 && heights[last] < limit) --last;
  const double high = cubed(heights[last - 1]), low = cubed(heights[last]);
  const double place = (static_cast<double>(last) + 0.5) * ring;
  return high > low ? place + ring * low / (high - low) : place;
}

}  // namespace

double SpreadingFront::radius_at(double time) const {
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  if (next == times.begin()) return radii.front();
  if (next == times.end()) return radii.back();
  const auto k = static_cast<std::size_t>(next - times.begin());
  const double share = (time - times[k - 1]) / (times[k] - times[k - 1]);
  return radii[k - 1] + share * (radii[k] - radii[k - 1]);
}

SpreadingFront spread(const SpreadingCylinder& cylinder) {
  const double ring = 1.05 * cylinder.farthest / cylinder.rings;
  const double mobility = cylinder.gravity / (3 * cylinder.viscosity);
  std::vector<double> heights(static_cast<std::size_t>(cylinder.rings), 0.0);
  for (std::size_t k = 0; k < heights.size(); ++k) {
    // The ring in which the cylinder ends is filled by its share.
    const double inner = static_cast<double>(k) * ring;
    heights[k] = cylinder.height * std::clamp((cylinder.radius - inner) / ring, 0.0, 1.0);
  }
  SpreadingFront front;
  double time = 0, dt = 1e-6 * cylinder.viscosity / (cylinder.gravity * cylinder.height);
  while (true) {
    const std::vector<double> next = step(heights, ring, mobility, dt);
    double change = 0;
    for (std::size_t k = 0; k < next.size(); ++k) change = std::max(change, std::abs(next[k] - heights[k]));
    heights = next;
    time += dt;
    front.times.push_back(time);
    front.radii.push_back(front_of(heights, ring));
    if (front.radii.back() >= cylinder.farthest) return front;
    dt *= std::clamp(0.01 * heights[0] / change, 0.5, 1.1);
  }
}

}  // namespace flowskin::tools
