#include "sph/viscosity/implicit_viscosity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/parallel.h"
#include "sph/forces/kernels.h"
#include "sph/forces/minimum_image.h"
#include "sph/viscosity/viscous_pairs.h"

namespace flowskin::sph {

/// The loops over the clusters that solve() is made of.
struct ImplicitViscosity::Loops {
  ImplicitViscosity& own;
  const SolverSettings& settings;
  const ViscousProblem& problem;
  const PointClusters& clusters;
  ViscousPairs pairs;
  MinimumImage image;
  Float8 dt, inverse_support, wall_inverse_support;
  Float8 away[3];

  Loops(ImplicitViscosity& solver, const PairCoefficients& c, const SolverSettings& s, const ViscousProblem& p)
      : own(solver),
        settings(s),
        problem(p),
        clusters(*p.clusters),
        pairs(c),
        image(c),
        dt(broadcast(static_cast<float>(p.time_step))),
        inverse_support(broadcast(c.inverse_support)),
        wall_inverse_support(broadcast(c.wall_inverse_support)),
        away{broadcast(c.away[0]), broadcast(c.away[1]), broadcast(c.away[2])} {}

  template <typename Kernel, bool monaghan, bool variable, bool periodic, bool first>
  Lanes3 resistance(std::size_t cluster, Blocks* diagonal) const;

  /// The preconditioner; the residual of the first guess, r = v* - A v = kick - dt K v with kick = dt a; z = M^-1 r.
  Sums prepare() const;
  /// A p; returns p.A p.
  double multiply_direction() const;
  /// x + alpha p and r - alpha A p, then z = M^-1 r; sums r.z and r.r.
  Sums advance(float alpha) const;
  void start_along_kick() const {
    for_clusters([&](std::size_t c) { store_velocities(kick(c), c); });
  }
  /// p = z + beta p
  void turn(float beta) const;
  void add_result() const;

  /// Calls function(kernel, monaghan, variable, periodic) with objects whose types say which.
  template <typename Function>
  void with_types(Function function) const {
    with_kernel(settings.kernel, [&](auto kernel) {
      with_bool(settings.viscosity_form == ViscosityForm::monaghan, [&](auto monaghan) {
        with_bool(!problem.viscosities.empty(), [&](auto variable) {
          with_bool(is_periodic(settings), [&](auto periodic) { function(kernel, monaghan, variable, periodic); });
        });
      });
    });
  }

  template <typename Function>
  void for_clusters(Function function) const {
#pragma omp parallel for schedule(static) num_threads(threads_for(problem.fluid.size()))
    for (std::size_t c = 0; c < clusters.size(); ++c) function(c);
  }

  FluidPack* packs(std::size_t c) const { return &problem.fluid[clusters[c].first]; }

  /// 1 in the lanes of particles whose velocity is sought, 0 in the others.
  Float8 free_lanes(std::size_t c) const {
    Float8 lanes{};
    for (std::uint32_t k = 0; k < clusters[c].count; ++k) {
      lanes[k] = problem.fixed.empty() || problem.fixed[clusters[c].first + k] == 0 ? 1.0F : 0.0F;
    }
    return lanes;
  }

  Lanes3 load_velocities(std::size_t c) const {
    Lanes3 v;
    for (std::uint32_t k = 0; k < clusters[c].count; ++k) {
      const FluidPack& pack = packs(c)[k];
      v.x[k] = pack.vx, v.y[k] = pack.vy, v.z[k] = pack.vz;
    }
    return v;
  }

  void store_velocities(const Lanes3& v, std::size_t c) const {
    for (std::uint32_t k = 0; k < clusters[c].count; ++k) {
      FluidPack& pack = packs(c)[k];
      pack.vx = v.x[k], pack.vy = v.y[k], pack.vz = v.z[k];
    }
  }

  static Lanes3 scaled(const Float8& s, const Lanes3& v) { return {s * v.x, s * v.y, s * v.z}; }
  static Float8 dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

  static double sum(const Float8& lanes) {
    double total = 0;
    for (int k = 0; k < 8; ++k) total += static_cast<double>(lanes[k]);
    return total;
  }

  /// Always in the same order, so that the rounding does not depend on the number of threads.
  Sums sum_parts() const {
    constexpr std::size_t chains = 4;  // that the processor adds side by side
    std::array<Sums, chains> totals{};
    for (std::size_t c = 0; c < clusters.size(); ++c) totals[c % chains] += own.partial_sums_[c];
    totals[0] += totals[1];
    totals[2] += totals[3];
    return totals[0] += totals[2];
  }

  Lanes3 kick(std::size_t c) const {
    Lanes3 kick;
    for (std::uint32_t k = 0; k < clusters[c].count; ++k) {
      const ParticleRates& rate = problem.rates[clusters[c].first + k];
      const Vec3 change = problem.time_step * (Vec3(rate.ax, rate.ay, rate.az) + settings.gravity);
      kick.x[k] = static_cast<float>(change.x());
      kick.y[k] = static_cast<float>(change.y());
      kick.z[k] = static_cast<float>(change.z());
    }
    return scaled(free_lanes(c), kick);
  }

  static Lanes3 multiply(const Blocks& m, const Lanes3& v) {
    return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
            m.xz * v.x + m.yz * v.y + m.zz * v.z};
  }

  /// (I + dt m)^-1 by cofactors; no eigenvalue of I + dt m is below 1.
  Blocks inverse(const Blocks& m) const {
    const Float8 one = broadcast(1.0F), x = one + dt * m.xx, y = one + dt * m.yy, z = one + dt * m.zz;
    const Float8 xy = dt * m.xy, xz = dt * m.xz, yz = dt * m.yz;
    const Float8 cx = y * z - yz * yz, cxy = xz * yz - xy * z, cxz = xy * yz - xz * y;
    const Float8 d = one / (x * cx + xy * cxy + xz * cxz);
    return {d * cx, d * cxy, d * cxz, d * (x * z - xz * xz), d * (xy * xz - x * yz), d * (x * y - xy * xy)};
  }
};

// The viscous deceleration K v of one cluster with the velocities in the packs. `first`: with the velocities of the
// walls, which for a mere direction of the search are at rest, and with the diagonal blocks of K.
template <typename Kernel, bool monaghan, bool variable, bool periodic, bool first>
ImplicitViscosity::Lanes3 ImplicitViscosity::Loops::resistance(std::size_t cluster, Blocks* diagonal) const {
  const std::uint32_t begin = clusters[cluster].first, count = clusters[cluster].count;
  std::array<std::array<float, PointCluster::width>, 6> rows;
  for (std::uint32_t k = 0; k < PointCluster::width; ++k) {
    const FluidPack& p = problem.fluid[begin + (k < count ? k : 0)];
    rows[0][k] = p.x, rows[1][k] = p.y, rows[2][k] = p.z, rows[3][k] = p.vx, rows[4][k] = p.vy, rows[5][k] = p.vz;
  }
  const Float8 own_x = load8(rows[0].data()), own_y = load8(rows[1].data()), own_z = load8(rows[2].data());
  Float8 x = own_x, y = own_y, z = own_z;
  const Float8 vx = load8(rows[3].data()), vy = load8(rows[4].data()), vz = load8(rows[5].data());
  const Float8 viscosity = variable ? load_viscosities(&problem.viscosities[begin], count) : Float8{};
  Lanes3 force;
  const auto add = [&](const Float8& k, const Float8& dx, const Float8& dy, const Float8& dz, const Float8& r2,
                       const Float8& ux, const Float8& uy, const Float8& uz) {
    if constexpr (monaghan) {
      const Float8 f = k * (ux * dx + uy * dy + uz * dz);
      force.x += f * dx, force.y += f * dy, force.z += f * dz;
    } else {
      force.x += k * r2 * ux, force.y += k * r2 * uy, force.z += k * r2 * uz;
    }
    if constexpr (first && monaghan) {
      const Float8 kx = k * dx, ky = k * dy;
      diagonal->xx += kx * dx, diagonal->xy += kx * dy, diagonal->xz += kx * dz;
      diagonal->yy += ky * dy, diagonal->yz += ky * dz, diagonal->zz += k * dz * dz;
    } else if constexpr (first) {
      diagonal->xx += k * r2, diagonal->yy += k * r2, diagonal->zz += k * r2;
    }
  };
  for (std::size_t part = 0; part < problem.fluid_lists->part_count(cluster); ++part) {
    const auto [sources, hidden] = problem.fluid_lists->part(cluster, part);
    if (part > 0) {
      const Float8 far = lanes_of(hidden);
      x = own_x + far * away[0], y = own_y + far * away[1], z = own_z + far * away[2];
    }
    for (const std::uint32_t index : sources) {
      const FluidPack& j = problem.fluid[index];
      const auto [dx, dy, dz] = image.difference<periodic>(x, y, z, j);
      const Float8 r2 = dx * dx + dy * dy + dz * dz;
      const Float8 q = sqrt(r2) * inverse_support;
      const Float8 k = pairs.fluid<variable>(q, viscosity, variable ? problem.viscosities[index] : 0.0F);
      add(k, dx, dy, dz, r2, vx - broadcast(j.vx), vy - broadcast(j.vy), vz - broadcast(j.vz));
    }
  }
  x = own_x, y = own_y, z = own_z;
  for (const std::uint32_t index : problem.wall_lists->of_cluster(cluster)) {
    const WallPack& b = problem.walls[index];
    const auto [dx, dy, dz] = image.difference<periodic>(x, y, z, b);
    const Float8 r2 = dx * dx + dy * dy + dz * dz;
    const Float8 shape = broadcast(b.volume * b.stick) * Kernel::shape(sqrt(r2) * wall_inverse_support);
    const Float8 k = pairs.wall<variable>(shape, r2, viscosity);
    if constexpr (first) {
      add(k, dx, dy, dz, r2, vx - broadcast(b.vx), vy - broadcast(b.vy), vz - broadcast(b.vz));
    } else {
      add(k, dx, dy, dz, r2, vx, vy, vz);
    }
  }
  return force;
}

ImplicitViscosity::Sums ImplicitViscosity::Loops::prepare() const {
  for_clusters([&](std::size_t c) {
    Lanes3 v;
    for (std::uint32_t k = 0; k < clusters[c].count; ++k) {
      const Eigen::Vector3f velocity = problem.velocities[clusters[c].first + k].cast<float>();
      v.x[k] = velocity.x(), v.y[k] = velocity.y(), v.z[k] = velocity.z();
    }
    store_velocities(v, c);
  });
  with_types([&](auto kernel, auto monaghan, auto variable, auto periodic) {
    for_clusters([&](std::size_t c) {
      Blocks diagonal;
      Lanes3 drag = resistance<decltype(kernel), monaghan.value, variable.value, periodic.value, true>(c, &diagonal);
      drag = scaled(free_lanes(c) * dt, drag);
      const Blocks& preconditioner = own.preconditioner_[c] = inverse(diagonal);
      const Lanes3 push = kick(c), v = load_velocities(c);
      const Lanes3& r = own.residual_[c] = {push.x - drag.x, push.y - drag.y, push.z - drag.z};
      const Lanes3& z = own.image_[c] = multiply(preconditioner, r);
      // Noise in the velocities is in K v many times enlarged; M^-1 undoes that. Rounding of the float packs: a
      // residual below it says nothing.
      const Lanes3 smooth = multiply(preconditioner, drag);
      constexpr float rounding = 3e-7F;
      const float unit = rounding / static_cast<float>(settings.viscosity_tolerance);
      const double scale = sum(dot(push, push) + dot(smooth, smooth) + broadcast(unit * unit) * dot(v, v));
      own.partial_sums_[c] = {sum(dot(r, z)), sum(dot(r, r)), sum(dot(push, r)), sum(dot(push, push)), scale};
    });
  });
  return sum_parts();
}

double ImplicitViscosity::Loops::multiply_direction() const {
  with_types([&](auto kernel, auto monaghan, auto variable, auto periodic) {
    for_clusters([&](std::size_t c) {
      const Lanes3 p = load_velocities(c);
      const Lanes3 force =
          resistance<decltype(kernel), monaghan.value, variable.value, periodic.value, false>(c, nullptr);
      own.image_[c] = scaled(free_lanes(c), {p.x + dt * force.x, p.y + dt * force.y, p.z + dt * force.z});
      own.partial_sums_[c] = {.direction = sum(dot(p, own.image_[c]))};
    });
  });
  return sum_parts().direction;
}

ImplicitViscosity::Sums ImplicitViscosity::Loops::advance(float alpha) const {
  const Float8 a = broadcast(alpha);
  for_clusters([&](std::size_t c) {
    const Lanes3 p = load_velocities(c);
    Lanes3 &x = own.correction_[c], &r = own.residual_[c], &q = own.image_[c];
    x.x += a * p.x, x.y += a * p.y, x.z += a * p.z;
    r.x -= a * q.x, r.y -= a * q.y, r.z -= a * q.z;
    q = multiply(own.preconditioner_[c], r);
    own.partial_sums_[c] = {.rz = sum(dot(r, q)), .rr = sum(dot(r, r))};
  });
  return sum_parts();
}

void ImplicitViscosity::Loops::turn(float beta) const {
  const Float8 b = broadcast(beta);
  for_clusters([&](std::size_t c) {
    const Lanes3 p = load_velocities(c), &z = own.image_[c];
    store_velocities({z.x + b * p.x, z.y + b * p.y, z.z + b * p.z}, c);
  });
}

void ImplicitViscosity::Loops::add_result() const {
  for_clusters([&](std::size_t c) {
    const Lanes3 &x = own.correction_[c], &r = own.residual_[c];
    for (std::uint32_t k = 0; k < clusters[c].count; ++k) {
      problem.velocities[clusters[c].first + k] +=
          Vec3(double(x.x[k]) + double(r.x[k]), double(x.y[k]) + double(r.y[k]), double(x.z[k]) + double(r.z[k]));
    }
  });
}

ImplicitViscosity::Result ImplicitViscosity::solve(const PairCoefficients& coefficients, const SolverSettings& settings,
                                                   const ViscousProblem& problem) {
  const std::size_t count = problem.clusters->size();
  correction_.assign(count, {});
  residual_.resize(count);
  image_.resize(count);
  preconditioner_.resize(count);
  partial_sums_.resize(count);

  const Loops loops(*this, coefficients, settings, problem);
  Sums sums = loops.prepare();
  const double target = settings.viscosity_tolerance * settings.viscosity_tolerance * sums.scale;
  Result result;
  if (sums.rr > target && sums.kick > 0 && sums.rr > 0.25 * sums.kick) {
    // Not near the balance of forces: the kick may be a good guess.
    loops.start_along_kick();
    sums = loops.advance(static_cast<float>(sums.direction / loops.multiply_direction()));
    ++result.iterations;
  }
  loops.turn(0);
  // A sum that is not a number ends the loop, unconverged.
  while (sums.rr > target && result.iterations < settings.viscosity_max_iterations) {
    const double curvature = loops.multiply_direction();
    const Sums next = loops.advance(static_cast<float>(sums.rz / curvature));
    loops.turn(static_cast<float>(next.rz / sums.rz));
    sums = next;
    ++result.iterations;
  }
  const double particles = static_cast<double>(std::max<std::size_t>(1, problem.fluid.size()));
  result.residual = std::sqrt(sums.rr / particles);
  result.tolerance = std::sqrt(target / particles);
  result.converged = sums.rr <= target;
  if (result.converged) loops.add_result();
  return result;
}

std::size_t ImplicitViscosity::memory_bytes() const {
  return (correction_.capacity() + residual_.capacity() + image_.capacity()) * sizeof(Lanes3) +
         preconditioner_.capacity() * sizeof(Blocks) + partial_sums_.capacity() * sizeof(Sums);
}

}  // namespace flowskin::sph
