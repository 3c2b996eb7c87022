#include "sph/walls/wall_drag.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "common/parallel.h"

namespace flowskin::sph {

namespace {

// Weights are whole numbers, so that their sums do not depend on the order.
constexpr float weight_unit = 1 << 16;

constexpr double laminar = 0.4437;      // of Sakiadis' layer
constexpr double transition = 5e5;      // Reynolds number
constexpr double greatest_loss = 0.27;  // there the layer's stress has fallen to that of the solver's own friction

}  // namespace

double boundary_layer_stress(double speed, double age, double viscosity) {
  const double reynolds = speed * speed * age / viscosity;
  return speed * speed * (reynolds < transition ? laminar / std::sqrt(reynolds) : 0.0296 / std::pow(reynolds, 0.2));
}

WallDrag::WallDrag(const SolverSettings& settings, const PairCoefficients& coefficients, const WallKernel& wall)
    : share_(settings.wall_drag),
      spacing_(settings.spacing),
      viscosity_(settings.viscosity),
      area_factor_(wall.area_factor * std::pow(wall.support, 3)),
      reach2_(static_cast<float>(std::min(0.75 * settings.spacing * settings.spacing, wall.support * wall.support))),
      period_(coefficients.period[0], coefficients.period[1], coefficients.period[2]),
      inverse_period_(coefficients.inverse_period[0], coefficients.inverse_period[1], coefficients.inverse_period[2]) {}

template <typename Function>
void WallDrag::for_each_near(const WallDragData& data, std::size_t cluster, std::size_t i, Function f) const {
  const FluidPack& p = data.fluid[i];
  for (const std::uint32_t b : data.wall_lists->of_cluster(cluster)) {
    const WallPack& w = data.walls[b];
    Eigen::Vector3f d(p.x - w.x, p.y - w.y, p.z - w.z);
    for (int a = 0; a < 3; ++a) d[a] -= period_[a] * std::round(d[a] * inverse_period_[a]);
    const float r2 = d.squaredNorm();
    if (r2 >= reach2_) continue;
    const float u = 1 - r2 / reach2_;
    f(b, static_cast<std::uint32_t>(weight_unit * u * u) + 1, d);
  }
}

template <typename Function>
void WallDrag::for_each_at_walls(const WallDragData& data, Function f) const {
  const float reach = std::sqrt(reach2_);
#pragma omp parallel for schedule(static) num_threads(threads_for(data.fluid.size()))
  for (std::size_t c = 0; c < data.clusters->size(); ++c) {
    const PointCluster& cluster = (*data.clusters)[c];
    for (std::size_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      if (data.wall_distances[i] < reach) f(c, i);
    }
  }
}

void WallDrag::note_wet(const WallDragData& data) {
  weights_.assign(data.walls.size(), 0);
  wet_since_.resize(data.walls.size(), -1);
  for_each_at_walls(data, [&](std::size_t c, std::size_t i) {
    for_each_near(data, c, i, [&](std::uint32_t b, std::uint32_t weight, const Eigen::Vector3f&) {
      std::atomic_ref<std::uint32_t>(weights_[b]).fetch_add(weight, std::memory_order_relaxed);
    });
  });
  for (std::size_t b = 0; b < weights_.size(); ++b) {
    if (weights_[b] == 0)
      wet_since_[b] = -1;
    else if (wet_since_[b] < 0)
      wet_since_[b] = data.time;
  }
}

WallDrag::Contact WallDrag::contact(const WallDragData& data, std::size_t cluster, std::size_t i) const {
  Contact sum;
  Eigen::Vector3f wall_velocity = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
  double slowness = 0;  // mean of 1 / sqrt(age)
  for_each_near(data, cluster, i, [&](std::uint32_t b, std::uint32_t weight, const Eigen::Vector3f& d) {
    const WallPack& wall = data.walls[b];
    const double area = area_factor_ * static_cast<double>(wall.volume) * weight / weights_[b];
    sum.area += area;
    sum.stick += area * static_cast<double>(wall.stick);
    slowness += area / std::sqrt(std::max(data.time - wet_since_[b], data.time_step));
    wall_velocity += static_cast<float>(area) * Eigen::Vector3f(wall.vx, wall.vy, wall.vz);
    normal += static_cast<float>(area) * d;
  });
  if (!(slowness > 0)) return {};
  sum.stick /= sum.area;
  sum.age = sum.area * sum.area / (slowness * slowness);
  const FluidPack& p = data.fluid[i];
  sum.slip = Eigen::Vector3f(p.vx, p.vy, p.vz) - wall_velocity / static_cast<float>(sum.area);
  const float normal2 = normal.squaredNorm();
  if (normal2 > 0) sum.slip -= normal * (normal.dot(sum.slip) / normal2);
  return sum;
}

Eigen::Vector3f WallDrag::acceleration(const WallDragData& data, std::size_t cluster, std::size_t i) const {
  const double viscosity = data.viscosities.empty() ? viscosity_ : static_cast<double>(data.viscosities[i]);
  const Contact wall = contact(data, cluster, i);
  const auto speed = static_cast<double>(wall.slip.norm());
  if (!(viscosity > 0 && speed > 0 && wall.age > 0)) return Eigen::Vector3f::Zero();
  const double square = spacing_ * spacing_, area = std::min(wall.area, 2 * square);
  // The particle's velocity is the mean over its height, of which the layer has already taken a share.
  const double lost = std::min(2 * laminar * std::sqrt(viscosity * wall.age) / spacing_, greatest_loss);
  double stress = boundary_layer_stress(speed / (1 - lost), wall.age, viscosity);
  // Where particles are few the fluid is a film, thinner than they are.
  if (area > square) stress = std::max(stress, 3 * viscosity * speed * area / (square * spacing_));
  const double force = stress * area - 2 * viscosity * speed * spacing_;  // less what the solver's own friction does
  // Within one step it may stop the particle, but not throw it back.
  const double rate = share_ * wall.stick * std::max(0.0, force) / (square * spacing_ * speed);
  return wall.slip * static_cast<float>(-rate / std::max(1.0, data.time_step * rate));
}

void WallDrag::add(const WallDragData& data) {
  note_wet(data);
  for_each_at_walls(data, [&](std::size_t c, std::size_t i) {
    const Eigen::Vector3f drag = acceleration(data, c, i);
    data.rates[i].ax += drag.x(), data.rates[i].ay += drag.y(), data.rates[i].az += drag.z();
  });
}

}  // namespace flowskin::sph
