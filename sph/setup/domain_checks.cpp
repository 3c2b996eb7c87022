#include "sph/setup/domain_checks.h"

#include <algorithm>

#include "common/number_text.h"
#include "sph/setup/errors.h"

namespace flowskin::sph {

namespace {

// In spacings: at a million, single precision tells places a sixteenth of a spacing apart.
constexpr double farthest_from_origin = 1e6;

// Counts what of a thing lies inside.
struct Inside {
  std::size_t inside = 0, all = 0;
};

void tell(const std::string& name, const char* what, const Inside& count, std::vector<std::string>& warnings) {
  if (count.all == 0 || count.inside == count.all) return;
  if (count.inside == 0) {
    throw SettingsError(name +
                        " lies outside the domain (simulation.domain), where fluid is removed: move it, or make "
                        "the domain larger");
  }
  warnings.push_back(name + " lies partly outside the domain: " + std::to_string(count.all - count.inside) + " of " +
                     std::to_string(count.all) + what);
}

}  // namespace

bool outside_domain(const SolverSettings& settings, const Vec3& p) {
  const Box& box = settings.domain;
  if (box.min == box.max) return false;
  for (int a = 0; a < 3; ++a) {
    if (settings.periodic[a] || box.min[a] == box.max[a]) continue;
    if (p[a] < box.min[a] || p[a] > box.max[a]) return true;
  }
  return false;
}

std::vector<std::string> check_inside_domain(const SolverSettings& settings, const std::vector<FluidPoint>& points,
                                             std::size_t bodies, const std::vector<JetEmitter>& emitters) {
  std::vector<std::string> warnings;
  std::vector<Inside> counts(bodies);
  for (const FluidPoint& p : points) {
    ++counts[p.body].all;
    counts[p.body].inside += outside_domain(settings, p.position) ? 0 : 1;
  }
  for (std::size_t b = 0; b < bodies; ++b) {
    tell("fluid body " + std::to_string(b + 1), " particles are lost as soon as they move", counts[b], warnings);
  }
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    const EmitterOutlet& outlet = emitters[e].outlet();
    Inside count{0, outlet.offsets().size()};
    for (const Vec3& offset : outlet.offsets()) {
      count.inside += outside_domain(settings, outlet.center() + offset) ? 0 : 1;
    }
    tell("emitter " + std::to_string(e + 1), " particles of each layer are lost as soon as they move", count, warnings);
  }
  return warnings;
}

void check_near_origin(const SolverSettings& settings, const std::vector<FluidPoint>& points, const Vec3& origin) {
  const auto distance = [&](const FluidPoint& p) { return (p.position - origin).cwiseAbs().maxCoeff(); };
  for (const FluidPoint& p : points) {
    if (distance(p) <= farthest_from_origin * settings.spacing) continue;
    throw SettingsError("fluid body " + std::to_string(p.body + 1) + " lies " + number_text(distance(p), 4) +
                        " m from the middle of all bodies, emitters and walls; with a spacing of " +
                        number_text(settings.spacing, 4) + " m fluid may be at most " +
                        number_text(farthest_from_origin * settings.spacing, 4) +
                        " m away: move them nearer together, or make the spacing larger");
  }
}

}  // namespace flowskin::sph
