#include "sph/solver.h"

#include <algorithm>
#include <numeric>

#include "sph/solver/solver_impl.h"

namespace flowskin::sph {

Solver::Solver(SimulationSetup setup) : impl_(std::make_unique<SolverImpl>(std::move(setup))) {}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

void Solver::advance_to(double time) {
  impl_->advance_towards(time, [] { return false; });
}
bool Solver::advance_towards(double time, const std::function<bool()>& stop) {
  return impl_->advance_towards(time, stop);
}
double Solver::step(double limit) { return impl_->step(limit); }
double Solver::time() const { return impl_->time(); }
std::size_t Solver::particle_count() const { return impl_->particles().size(); }
std::size_t Solver::boundary_particle_count() const { return impl_->boundary().positions().size(); }
const SolverSettings& Solver::settings() const { return impl_->settings(); }
const SolverStatistics& Solver::statistics() const { return impl_->statistics(); }
const std::vector<std::string>& Solver::warnings() const { return impl_->warnings(); }
std::size_t Solver::memory_bytes() const { return impl_->memory_bytes(); }
std::vector<Vec3> Solver::boundary_positions() const { return impl_->boundary().positions(); }
void Solver::save(StateWriter& writer) const { impl_->save(writer); }
void Solver::restore(StateReader& reader) { impl_->restore(reader); }

FluidState Solver::state() const {
  const ParticleArrays& particles = impl_->particles();
  const std::size_t count = particles.size();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return particles.ids[a] < particles.ids[b]; });
  FluidState state;
  state.time = impl_->time();
  state.ids.reserve(count);
  state.positions.reserve(count);
  state.velocities.reserve(count);
  state.rest_positions.reserve(count);
  state.densities.reserve(count);
  for (const std::uint32_t i : order) {
    state.ids.push_back(particles.ids[i]);
    state.positions.push_back(impl_->periodic().wrap(particles.positions[i]));
    state.velocities.push_back(particles.velocities[i]);
    state.rest_positions.push_back(particles.rest_positions[i]);
    state.densities.push_back(impl_->settings().rest_density * (1 + static_cast<double>(particles.compressions[i])));
    if (!particles.fluids.empty()) state.fluids.push_back(particles.fluids[i]);
    if (!particles.viscosities.empty()) state.viscosities.push_back(particles.viscosities[i]);
  }
  return state;
}

Energy Solver::energy() const {
  Energy energy;
  const ParticleArrays& particles = impl_->particles();
  const Vec3& gravity = impl_->settings().gravity;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    energy.kinetic += 0.5 * impl_->particle_mass() * particles.velocities[i].squaredNorm();
    energy.potential -= impl_->particle_mass() * gravity.dot(particles.positions[i]);
  }
  return energy;
}

Vec3 Solver::momentum() const {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& v : impl_->particles().velocities) sum += v;
  return impl_->particle_mass() * sum;
}

}  // namespace flowskin::sph
