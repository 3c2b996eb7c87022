#include "sph/solver/solver_impl.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/number_text.h"
#include "common/parallel.h"
#include "common/stopwatch.h"
#include "sph/bodies/fluid_bodies.h"
#include "sph/bodies/fluid_sinks.h"
#include "sph/setup/automatic_values.h"
#include "sph/setup/domain_checks.h"
#include "sph/setup/errors.h"
#include "sph/setup/setup_checks.h"
#include "sph/viscosity/rheology.h"
#include "sph/walls/boundary_sampling.h"
#include "sph/walls/fluid_in_walls.h"

namespace flowskin::sph {

namespace {

constexpr int builds_per_sort = 4;
constexpr double cluster_extent = 3.0;        // in spacings
constexpr float greatest_compression = 1.0F;  // over twice the rest density nothing is believable
constexpr float least_compression = -0.99F;

Box bounding_box(const std::vector<FluidPoint>& points) {
  Box box;
  if (!points.empty()) box = {points[0].position, points[0].position};
  for (const FluidPoint& p : points) {
    box.min = box.min.cwiseMin(p.position);
    box.max = box.max.cwiseMax(p.position);
  }
  return box;
}

Box bounding_box(const TriangleMesh& mesh) {
  Box box = {mesh.positions.front(), mesh.positions.front()};
  for (const Vec3& p : mesh.positions) box = {box.min.cwiseMin(p), box.max.cwiseMax(p)};
  return box;
}

// Middle of everything, so that the float coordinates are small.
Vec3 middle(const std::vector<FluidPoint>& points, const std::vector<Vec3>& walls,
            const std::vector<Emitter>& emitters) {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  const auto include = [&](const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (const FluidPoint& p : points) include(p.position);
  for (const Vec3& p : walls) include(p);
  for (const Emitter& e : emitters) include(e.center);
  return 0.5 * (low + high);
}

// Settings with the automatic values, for members that are initialised from them.
SolverSettings complete_settings(const SimulationSetup& setup, const std::vector<FluidPoint>& points,
                                 double wall_speed) {
  double speed = wall_speed;
  for (const FluidPoint& p : points) speed = std::max(speed, p.velocity.norm());
  return with_automatic_values(setup, bounding_box(points), speed);
}

// Whether something moves the particles besides their velocity.
bool drifts(const SolverSettings& settings) { return settings.xsph > 0 || settings.particle_shifting > 0; }

}  // namespace

SolverImpl::SolverImpl(SimulationSetup setup)
    : settings_((check_setup(setup), setup.settings)), periodic_(settings_.domain, settings_.periodic) {
  wall_kernel_ = make_wall_kernel(settings_);
  boundary_ = BoundaryParticles(setup.boundaries, settings_, wall_kernel_, periodic_);
  std::vector<FluidPoint> points = fill_bodies(setup.bodies, settings_.spacing, boundary_.positions(), periodic_);
  for (std::size_t e = 0; e < setup.emitters.size(); ++e) {
    emitters_.emplace_back(setup.emitters[e], settings_.spacing, "emitter " + std::to_string(e + 1));
    setup.emitters[e].center = emitters_.back().outlet().center();
  }
  warnings_ = leave_out_fluid_in_walls(setup.boundaries, setup.bodies.size(), periodic_, points, emitters_);
  const std::vector<std::string> outside = check_inside_domain(settings_, points, setup.bodies.size(), emitters_);
  warnings_.insert(warnings_.end(), outside.begin(), outside.end());
  sinks_ = std::move(setup.sinks);
  for (Sink& sink : sinks_) sink.box = sink.shape == Sink::Shape::mesh ? bounding_box(sink.mesh) : sink.box;
  settings_ = complete_settings(setup, points, boundary_.greatest_speed());
  if (is_mixture(setup.fluids)) fluids_ = setup.fluids;
  for (const Fluid& fluid : fluids_) shear_dependent_ = shear_dependent_ || !fluid.rheology.is_newtonian();
  coefficients_ = PairCoefficients(settings_, wall_kernel_, !fluids_.empty());
  surface_tension_ = SurfaceTension(settings_);
  wall_drag_ = WallDrag(settings_, coefficients_, wall_kernel_);
  mass_ = settings_.rest_density * std::pow(settings_.spacing, 3);
  smoothing_length_ = 0.5 * settings_.support_radius * settings_.spacing;
  origin_ = middle(points, boundary_.positions(), setup.emitters);
  for (int a = 0; a < 3; ++a) {
    if (periodic_.along(a)) origin_[a] = 0.5 * (settings_.domain.min[a] + settings_.domain.max[a]);
  }
  check_near_origin(settings_, points, origin_);
  boundary_.place_at_origin(origin_);
  // Where all axes are periodic there is no place for what is hidden (PairCoefficients::away).
  sees_walls_ = boundary_.has_thin() && !(periodic_.along(0) && periodic_.along(1) && periodic_.along(2));

  particles_.reserve(points.size(), drifts(settings_), fluids_.size() > 1, !fluids_.empty());
  for (const FluidPoint& p : points)
    add_particle(p.position, p.velocity, p.position, index_of(fluids_, setup.bodies[p.body].fluid));
  pour_emitters();
  for (std::size_t i = 0; i < particles_.size(); ++i) fill_pack(i, 0);
  rebuild_lists();
  evaluate_forces();
  finish_step(0);
}

bool SolverImpl::advance_towards(double time, const std::function<bool()>& stop) {
  while (time_ < time) {
    if (stop()) return false;
    const double left = time - time_;
    const double longest = choose_step(left).step;
    // The last two steps share what is left, so that none is tiny.
    if (longest >= left) {
      step(left);
      time_ = time;
    } else {
      step(longest >= 0.5 * left ? 0.5 * left : left);
    }
  }
  if (some_outside_ || some_to_drain()) {
    rebuild_lists();
    evaluate_forces();
  }
  return true;
}

double SolverImpl::step(double limit) {
  statistics_.last_step = choose_step(limit);
  const double dt = statistics_.last_step.step;
  if (is_implicit()) kick_implicitly(dt);
  boundary_.move_to(time_ + dt);
  kick_and_drift(dt);
  time_ += dt;
  pour_emitters();
  if (lists_outdated()) rebuild_lists();
  evaluate_forces();
  finish_step(dt);
  statistics_.count_step();
  return dt;
}

TimeStepReport SolverImpl::choose_step(double limit) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double h = smoothing_length_;
  TimeStepReport report;
  report.acoustic =
      settings_.acoustic_cfl * h / (settings_.speed_of_sound + std::max(greatest_speed_, boundary_.greatest_speed()));
  report.viscous = is_implicit() ? infinity : viscous_step_limit(settings_, settings_.viscosity);
  report.force = greatest_acceleration_ > 0 ? settings_.force_cfl * std::sqrt(h / greatest_acceleration_) : infinity;
  report.capillary = settings_.capillary_cfl * capillary_time(settings_);
  report.step = infinity;
  const auto apply = [&](double value, TimeStepLimit limit_kind) {
    if (value < report.step) {
      report.step = value;
      report.limited_by = limit_kind;
    }
  };
  apply(report.acoustic, TimeStepLimit::acoustic);
  apply(report.viscous, TimeStepLimit::viscous);
  apply(report.force, TimeStepLimit::force);
  apply(report.capillary, TimeStepLimit::capillary);
  apply(settings_.max_time_step, TimeStepLimit::setting);
  apply(limit, TimeStepLimit::output);
  return report;
}

const JetEmitter* SolverImpl::nozzle_around(const Vec3& p) const {
  for (const JetEmitter& emitter : emitters_) {
    if (emitter.in_nozzle(p, time_)) return &emitter;
  }
  return nullptr;
}

void SolverImpl::fill_pack(std::size_t i, double dt) {
  const Eigen::Vector3f x = (particles_.positions[i] - origin_).cast<float>();
  const Eigen::Vector3f v = particles_.velocities[i].cast<float>();
  // The compression that the last rate predicts; finish_step() replaces the prediction.
  const float compression = particles_.compressions[i] + static_cast<float>(dt) * particles_.rates[i].compression_rate;
  particles_.packs[i] = {x.x(), x.y(), x.z(),       v.x(),
                         v.y(), v.z(), compression, coefficients_.pack_pressure(compression)};
}

Hold SolverImpl::drift_particle(std::size_t i, std::size_t cluster, double dt) {
  const ParticleRates& rate = particles_.rates[i];
  Vec3& velocity = particles_.velocities[i];
  if (!is_implicit()) velocity += 0.5 * dt * (Vec3(rate.ax, rate.ay, rate.az) + settings_.gravity);
  if (const JetEmitter* emitter = nozzle_around(particles_.positions[i])) velocity = emitter->velocity();
  Vec3 motion = dt * velocity;
  if (!particles_.shifts.empty()) motion += dt * particles_.shifts[i].cast<double>();

  Vec3 target = particles_.positions[i] + motion;
  const auto hold = boundary_.hold(particles_.positions[i], cluster, particles_.wall_distances[i], target, velocity);
  particles_.positions[i] = target;
  return hold;
}

void SolverImpl::kick_implicitly(double dt) {
  const Stopwatch watch(statistics_.seconds_viscosity);
  std::vector<std::uint8_t> fixed;
  if (!emitters_.empty()) fixed.resize(particles_.size());
  for (std::size_t i = 0; i < fixed.size(); ++i) fixed[i] = nozzle_around(particles_.positions[i]) != nullptr;
  const ImplicitViscosity::Result result =
      implicit_viscosity_.solve(coefficients_, settings_,
                                {particles_.packs, &clusters_, &fluid_lists_, boundary_.packs(), &wall_lists_,
                                 particles_.viscosities, particles_.rates, fixed, dt, particles_.velocities});
  statistics_.viscosity_iterations += static_cast<std::uint64_t>(result.iterations);
  statistics_.viscosity_tolerance = result.tolerance;
  if (result.converged) return;
  throw BlowUpError("the implicit viscosity did not converge at t = " + number_text(time_, 6) + " s: after " +
                    std::to_string(result.iterations) + " iterations the velocities are exact to " +
                    number_text(result.residual, 6) + " m/s, asked for are " + number_text(result.tolerance, 6) +
                    " m/s; raise viscosity_tolerance or viscosity_max_iterations, or lower max_time_step");
}

void SolverImpl::kick_and_drift(double dt) {
  const Stopwatch watch(statistics_.seconds_integration);
  std::uint64_t crossings = 0, kept_out = 0, squeezed = 0;
  bool outside = false;
#pragma omp parallel for schedule(static) num_threads(threads_for(particles_.size())) reduction(+ : crossings, kept_out, squeezed) reduction(|| : outside)
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const PointCluster& cluster = clusters_[c];
    for (std::size_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      const Hold hold = drift_particle(i, c, dt);
      crossings += hold.held;
      kept_out += hold.kept_out;
      squeezed += hold.squeezed_through;
      fill_pack(i, dt);
      outside = outside || outside_domain(settings_, particles_.positions[i]);
    }
  }
  statistics_.wall_crossings += crossings;
  statistics_.kept_out_of_gaps += kept_out;
  statistics_.squeezed_through += squeezed;
  some_outside_ = outside;
}

void SolverImpl::add_particle(const Vec3& position, const Vec3& velocity, const Vec3& rest_position,
                              std::size_t fluid) {
  particles_.append(next_id_++, position, velocity, rest_position, drifts(settings_));
  if (fluids_.size() > 1) particles_.fluids.push_back(static_cast<std::uint8_t>(fluid));
  if (fluids_.empty()) return;
  const double viscosity = viscosity_at(fluids_[fluid], settings_.rest_density, 0);
  particles_.viscosities.push_back(static_cast<float>(viscosity));
}

void SolverImpl::pour_emitters() {
  std::vector<JetEmitter::Particle> poured;
  for (JetEmitter& emitter : emitters_) {
    if (emitter.next_time() > time_) continue;
    poured.clear();
    JetEmitter::Surroundings surroundings;
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      emitter.collect(particles_.positions[i], static_cast<double>(particles_.compressions[i]), surroundings);
    }
    statistics_.not_emitted += emitter.pour(time_, surroundings, poured);
    for (const JetEmitter::Particle& p : poured) {
      add_particle(p.position, emitter.velocity(), p.rest_position, index_of(fluids_, emitter.fluid()));
      fill_pack(particles_.size() - 1, 0);
    }
    statistics_.emitted += poured.size();
    particles_changed_ = particles_changed_ || !poured.empty();
  }
}

bool SolverImpl::some_to_drain() const {
  return !sinks_.empty() && std::any_of(particles_.positions.begin(), particles_.positions.end(),
                                        [&](const Vec3& p) { return in_open_sink(sinks_, p, time_); });
}

void SolverImpl::wrap_particles() {
#pragma omp parallel for schedule(static) num_threads(threads_for(particles_.size()))
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Vec3& position = particles_.positions[i];
    position = periodic_.wrap(position);
    const Eigen::Vector3f x = (position - origin_).cast<float>();
    FluidPack& pack = particles_.packs[i];
    pack.x = x.x(), pack.y = x.y(), pack.z = x.z();
  }
}

void SolverImpl::remove_lost() {
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (outside_domain(settings_, particles_.positions[i])) {
      ++statistics_.left_domain;
    } else if (in_open_sink(sinks_, particles_.positions[i], time_)) {
      ++statistics_.drained;
    } else {
      kept.push_back(static_cast<std::uint32_t>(i));
    }
  }
  if (kept.size() < particles_.size()) particles_.rearrange(kept);
  some_outside_ = false;
}

bool SolverImpl::lists_outdated() const {
  if (particles_changed_) return true;
  // Fluid pairs see only motion relative to each other, so a common shift is taken off. A particle may come nearer to a
  // wall that rests by the whole skin, to one that moves by what that one's way leaves of it.
  const float skin = static_cast<float>(settings_.skin * settings_.spacing);
  const float wall_skin = skin - static_cast<float>(boundary_.shift_since_build());
  if (wall_skin <= 0) return true;
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e30F), high = -low;
  const auto moved = [&](std::size_t cluster, std::uint32_t lane) {
    const FluidPack& p = particles_.packs[clusters_[cluster].first + lane];
    return Eigen::Vector3f(Eigen::Vector3f(p.x, p.y, p.z) - clusters_.point(cluster, lane));
  };
#pragma omp parallel num_threads(threads_for(particles_.size()))
  {
    Eigen::Vector3f my_low = low, my_high = high;
#pragma omp for schedule(static)
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      for (std::uint32_t lane = 0; lane < clusters_[c].count; ++lane) {
        const Eigen::Vector3f d = moved(c, lane);
        my_low = my_low.cwiseMin(d);
        my_high = my_high.cwiseMax(d);
      }
    }
#pragma omp critical
    {
      low = low.cwiseMin(my_low);
      high = high.cwiseMax(my_high);
    }
  }
  const Eigen::Vector3f farthest = low.cwiseAbs().cwiseMax(high.cwiseAbs());
  // Wrapped anew before the float coordinates get too large.
  for (int a = 0; a < 3; ++a) {
    if (periodic_.along(a) && farthest[a] > 0.5 * periodic_.period()[a]) return true;
  }
  const bool walls_safe = boundary_.empty() || farthest.norm() < wall_skin;
  if (walls_safe && (high - low).norm() < skin) return false;
  // The box of displacements is too coarse to tell: look at each.
  const Eigen::Vector3f common = 0.5F * (low + high);
  float relative2 = 0, absolute2 = 0;
#pragma omp parallel for schedule(static) num_threads(threads_for(particles_.size())) \
    reduction(max                                                                     \
              : relative2, absolute2)
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    for (std::uint32_t lane = 0; lane < clusters_[c].count; ++lane) {
      const Eigen::Vector3f d = moved(c, lane);
      relative2 = std::max(relative2, (d - common).squaredNorm());
      absolute2 = std::max(absolute2, d.squaredNorm());
    }
  }
  if (!boundary_.empty() && absolute2 >= wall_skin * wall_skin) return true;
  return relative2 >= 0.25F * skin * skin;
}

void SolverImpl::rebuild_lists() {
  const Stopwatch watch(statistics_.seconds_neighbors);
  if (some_outside_ || some_to_drain()) remove_lost();
  if (periodic_.any()) wrap_particles();
  const std::span<const FluidPack> packs = particles_.packs;
  if (particles_changed_ || ++builds_since_sort_ >= builds_per_sort) {
    curve_.compute(packs, static_cast<float>(settings_.spacing), particles_.scratch());
    particles_.rearrange(curve_.order());
    builds_since_sort_ = 0;
  }
  particles_changed_ = false;
  build_lists(packs);
  ++statistics_.list_rebuilds;
}

void SolverImpl::build_lists(const PointView& places) {
  clusters_.assign(places, static_cast<float>(cluster_extent * settings_.spacing));
  const auto radius = static_cast<float>((settings_.support_radius + settings_.skin) * settings_.spacing);
  const Eigen::Vector3f period = periodic_.period().cast<float>();
  NeighborLists::Sight sight;
  if (sees_walls_) {
    sight = [&](std::size_t cluster, std::span<const std::uint32_t> sources, std::vector<std::uint8_t>& hidden) {
      return boundary_.hide(clusters_, places, cluster, sources, hidden);
    };
  }
  fluid_lists_.build(clusters_, clusters_, radius, period, sight);
  const auto wall_reach = static_cast<float>(wall_kernel_.support + settings_.skin * settings_.spacing);
  boundary_.mark_build(clusters_.size());
  wall_lists_.build(clusters_, boundary_.clusters(), wall_reach, period);
  if (surface_tension_.active()) {
    const auto reach = static_cast<float>(surface_tension_.reach + settings_.skin * settings_.spacing);
    tension_lists_.build(clusters_, clusters_, reach, period, sight);
    if (!boundary_.adhesions().empty()) adhesion_lists_.build(clusters_, boundary_.clusters(), reach, period);
  }
  collect_wall_triangles();
}

void SolverImpl::collect_wall_triangles() {
  // Up to the next rebuild no particle moves farther than the skin and one step, whose length the sound limits.
  const double margin = 1.1 * settings_.skin * settings_.spacing +
                        std::max(0.5 * settings_.spacing, 0.6 * settings_.acoustic_cfl * smoothing_length_);
#pragma omp parallel for schedule(dynamic, 64) num_threads(threads_for(particles_.size()))
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    if (wall_lists_.of_cluster(c).empty()) continue;
    const Vec3 low = origin_ + clusters_[c].box_min.cast<double>(),
               high = origin_ + clusters_[c].box_max.cast<double>();
    boundary_.collect_triangles(c, low, high, margin);
  }
}

void SolverImpl::evaluate_forces() {
  const Stopwatch watch(statistics_.seconds_forces);
  const PairData data{particles_.packs,       &clusters_,
                      &fluid_lists_,          boundary_.packs(),
                      &wall_lists_,           static_cast<float>(statistics_.last_step.step),
                      particles_.rates,       particles_.wall_distances,
                      particles_.shifts,      !is_implicit(),
                      particles_.viscosities, static_cast<float>(greatest_speed_)};
  if (shear_dependent_) update_viscosities(data);
  if (settings_.density_method == DensityMethod::summation) sum_densities(coefficients_, settings_, data);
  compute_forces(coefficients_, settings_, data);
  if (wall_drag_.active()) {
    wall_drag_.add({data.fluid, &clusters_, data.walls, &wall_lists_, data.wall_distances, data.viscosities, time_,
                    statistics_.last_step.step, data.rates});
  }
  if (surface_tension_.active()) {
    surface_stresses_.resize(particles_.size());
    add_surface_tension(surface_tension_,
                        {particles_.packs, &clusters_, &tension_lists_, boundary_.packs(), boundary_.adhesions(),
                         &adhesion_lists_, surface_stresses_, particles_.rates});
  }
}

void SolverImpl::update_viscosities(const PairData& data) {
  std::vector<float>& values = particles_.viscosities;
  find_shear_rates(coefficients_, settings_, data, values);
#pragma omp parallel for schedule(static) num_threads(threads_for(values.size()))
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Fluid& fluid = fluids_[particles_.fluids.empty() ? 0 : particles_.fluids[i]];
    values[i] = static_cast<float>(viscosity_at(fluid, settings_.rest_density, static_cast<double>(values[i])));
  }
}

void SolverImpl::finish_step(double dt) {
  const Stopwatch watch(statistics_.seconds_integration);
  double speed2 = 0, acceleration2 = 0;
  const double speed_limit2 = settings_.speed_of_sound * settings_.speed_of_sound;
  std::size_t worst = particles_.size();  // a particle beyond belief: the one with the lowest place in the arrays
#pragma omp parallel for schedule(static) num_threads(threads_for(particles_.size())) \
    reduction(max                                                                     \
              : speed2, acceleration2) reduction(min                                  \
                                                 : worst)
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const ParticleRates& rate = particles_.rates[i];
    const Vec3 acceleration = Vec3(rate.ax, rate.ay, rate.az) + settings_.gravity;
    const double a2 = acceleration.squaredNorm();
    // Not a number: what was before stays readable.
    if (!std::isfinite(a2 + rate.compression_rate)) {
      worst = std::min(worst, i);
      continue;
    }
    Vec3& velocity = particles_.velocities[i];
    if (!is_implicit()) velocity += 0.5 * dt * acceleration;
    if (const JetEmitter* emitter = nozzle_around(particles_.positions[i])) velocity = emitter->velocity();
    float& compression = particles_.compressions[i];
    compression = settings_.density_method == DensityMethod::summation
                      ? particles_.packs[i].compression
                      : std::max(compression + static_cast<float>(dt) * rate.compression_rate, least_compression);
    const double v2 = velocity.squaredNorm();
    speed2 = std::max(speed2, v2);
    acceleration2 = std::max(acceleration2, a2);
    if (v2 > speed_limit2 || compression > greatest_compression) worst = std::min(worst, i);
  }
  if (settings_.particle_shifting > 0) take_out_mean_compression();
  greatest_speed_ = std::sqrt(speed2);
  greatest_acceleration_ = std::sqrt(acceleration2);
  if (worst < particles_.size()) throw_blow_up(worst);
}

void SolverImpl::take_out_mean_compression() {
  // In the order of the particles: the same bytes at any number of threads.
  double sum = 0;
  for (const float compression : particles_.compressions) sum += static_cast<double>(compression);
  const auto mean = static_cast<float>(sum / static_cast<double>(std::max<std::size_t>(1, particles_.size())));
  for (float& compression : particles_.compressions) compression -= mean;
}

void SolverImpl::throw_blow_up(std::size_t i) const {
  const ParticleRates& rate = particles_.rates[i];
  const Vec3& x = particles_.positions[i];
  std::string message = "the simulation blew up at t = " + number_text(time_, 6) + " s: particle " +
                        std::to_string(particles_.ids[i]) + " at (" + number_text(x.x(), 6) + ", " +
                        number_text(x.y(), 6) + ", " + number_text(x.z(), 6) + ") m ";
  const double speed = particles_.velocities[i].norm();
  // Where the user chose the speed of sound, raising max_speed would change nothing.
  const bool sound_is_automatic = std::abs(settings_.speed_of_sound - 10 * settings_.max_speed) < 1e-9;
  const std::string limiting_speed = sound_is_automatic ? "max_speed" : "speed_of_sound";
  if (!std::isfinite(rate.ax + rate.ay + rate.az + rate.compression_rate)) {
    message +=
        "has a force that is not a number; likely particles at nearly the same place or a time step that is too "
        "long: check bodies that overlap, or lower acoustic_cfl and viscous_cfl";
  } else if (speed > settings_.speed_of_sound) {
    message += "moves at " + number_text(speed, 6) + " m/s, faster than the speed of sound of the set-up, " +
               number_text(settings_.speed_of_sound, 6) +
               " m/s; likely the flow is faster than max_speed = " + number_text(settings_.max_speed, 6) +
               " m/s allows for, or the time step is too long: raise " + limiting_speed +
               ", or lower acoustic_cfl and viscous_cfl";
  } else {
    message += "has " + number_text(1 + double(particles_.compressions[i]), 6) +
               " times the rest density; likely the fluid is pressed into a space that is too small, or hits a wall "
               "faster than max_speed = " +
               number_text(settings_.max_speed, 6) + " m/s allows for: raise " + limiting_speed +
               " or lower acoustic_cfl";
  }
  throw BlowUpError(message);
}

void SolverImpl::save(StateWriter& writer) const {
  std::vector<Eigen::Vector3f> places = clusters_.points();
  const_cast<SolverImpl*>(this)->visit(writer, places);
}

bool SolverImpl::is_consistent(const std::vector<Eigen::Vector3f>& places) {
  const std::size_t count = particles_.size();
  std::vector<std::uint64_t> ids = particles_.ids;
  std::sort(ids.begin(), ids.end());
  const bool named = std::adjacent_find(ids.begin(), ids.end()) == ids.end() && (ids.empty() || ids.back() < next_id_);
  const auto is_finite = [](const Eigen::Vector3f& p) { return p.allFinite(); };
  const auto is_known = [&](std::uint8_t fluid) { return fluid < fluids_.size(); };
  // Nothing is due any more that an emitter should have poured.
  const auto has_poured = [&](const JetEmitter& emitter) { return emitter.next_time() >= (1 - 1e-9) * time_; };
  const double built = boundary_.build_time();
  return particles_.is_consistent(drifts(settings_), fluids_.size() > 1, !fluids_.empty()) && named &&
         places.size() == count && std::all_of(places.begin(), places.end(), is_finite) &&
         std::all_of(particles_.fluids.begin(), particles_.fluids.end(), is_known) &&
         std::all_of(emitters_.begin(), emitters_.end(), has_poured) && std::isfinite(time_) && built >= 0 &&
         built <= time_ && greatest_speed_ >= 0 && greatest_acceleration_ >= 0;
}

void SolverImpl::restore(StateReader& reader) {
  std::vector<Eigen::Vector3f> places;
  visit(reader, places);
  if (!is_consistent(places)) throw StateError("the saved state of the solver contradicts itself");
  boundary_.move_to(boundary_.build_time());
  build_lists(std::span<const Eigen::Vector3f>(places));
  boundary_.move_to(time_);
}

std::size_t SolverImpl::memory_bytes() const {
  std::size_t bytes = const_cast<ParticleArrays&>(particles_).memory_bytes() + boundary_.memory_bytes() +
                      implicit_viscosity_.memory_bytes() + curve_.memory_bytes() + clusters_.memory_bytes() +
                      fluid_lists_.memory_bytes() + wall_lists_.memory_bytes() + tension_lists_.memory_bytes() +
                      adhesion_lists_.memory_bytes() + surface_stresses_.capacity() * sizeof(SurfaceStress) +
                      wall_drag_.memory_bytes();
  return bytes;
}

}  // namespace flowskin::sph
