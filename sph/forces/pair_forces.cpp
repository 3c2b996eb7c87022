#include "sph/forces/pair_forces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/parallel.h"
#include "sph/forces/equation_of_state.h"
#include "sph/forces/kernels.h"
#include "sph/forces/minimum_image.h"
#include "sph/viscosity/viscous_pairs.h"

namespace flowskin::sph {

PairCoefficients::PairCoefficients(const SolverSettings& s, const WallKernel& wall, bool variable_viscosity) {
  const auto gradient_scale = [&](double support) {
    return with_kernel(s.kernel, [&](auto kernel) { return decltype(kernel)::gradient_scale(support); });
  };
  const double support = s.support_radius * s.spacing, h = support / 2;
  const double cell = s.spacing * s.spacing * s.spacing, volume = cell / lattice_kernel_sum(s);
  const double gradient = volume * gradient_scale(support);
  const double viscous =
      (s.viscosity_form == ViscosityForm::monaghan ? 10 : 2) * (variable_viscosity ? 1 : s.viscosity);
  const double c = s.speed_of_sound;
  inverse_support = static_cast<float>(1 / support);
  kernel_scale = static_cast<float>(volume / (support * support * support));
  kernel_gradient = static_cast<float>(gradient);
  pressure_scale = static_cast<float>(gradient * c * c * lattice_pressure_factor(s));
  background = static_cast<float>(s.background_pressure / (s.rest_density * c * c));
  // Without a free surface nothing is missing where the density is low.
  least_compression = s.background_pressure > 0 || s.particle_shifting > 0 ? -0.99F : 0.0F;
  // Shifting closes the voids that suction opens.
  least_pressure = s.particle_shifting > 0 ? -1e9F : 0.0F;
  diffusion = static_cast<float>(2 * s.density_diffusion * h * c * gradient);
  viscosity = static_cast<float>((variable_viscosity ? 1 : s.viscosity) * lattice_viscosity_scale(s));
  for (int a = 0; a < 3; ++a) compression_gradient[a] = static_cast<float>(s.gravity[a] / (c * c));
  xsph = static_cast<float>(s.xsph) * kernel_scale;
  shift_scale = static_cast<float>(s.particle_shifting * support * gradient);
  const double wall_scale = gradient_scale(wall.support) * std::pow(wall.support, 3);
  wall_inverse_support = static_cast<float>(1 / wall.support);
  wall_gradient = static_cast<float>(wall_scale);
  wall_pressure = static_cast<float>(wall_scale / gradient);
  wall_barrier_from = static_cast<float>(2 * wall.compression);
  wall_viscosity = static_cast<float>(viscous * wall.friction_factor * wall_scale);
  wall_softening = static_cast<float>(0.01 * wall.support * wall.support / 4);
  away = away_from_all(s);
  for (int a = 0; a < 3; ++a) {
    if (!s.periodic[a]) continue;
    period[a] = static_cast<float>(s.domain.max[a] - s.domain.min[a]);
    inverse_period[a] = 1 / period[a];
  }
}

float PairCoefficients::pack_pressure(float compression) const {
  const float density_ratio = 1 + compression;
  const float pressure = least_compression < 0 ? pressure_with_background(compression, background, least_pressure)
                                               : clamped_pressure(compression);
  return pressure_scale * pressure / (density_ratio * density_ratio);
}

namespace {

// The particles of one cluster, one per lane; lanes without a particle repeat the first one and are not written back.
struct Targets {
  Float8 x, y, z, vx, vy, vz, compression, pressure;

  Targets(const FluidPack* packs, std::uint32_t count) {
    std::array<std::array<float, PointCluster::width>, 8> rows;
    for (std::uint32_t k = 0; k < PointCluster::width; ++k) {
      const FluidPack& p = packs[k < count ? k : 0];
      rows[0][k] = p.x, rows[1][k] = p.y, rows[2][k] = p.z;
      rows[3][k] = p.vx, rows[4][k] = p.vy, rows[5][k] = p.vz;
      rows[6][k] = p.compression, rows[7][k] = p.pressure;
    }
    x = load8(rows[0].data()), y = load8(rows[1].data()), z = load8(rows[2].data());
    vx = load8(rows[3].data()), vy = load8(rows[4].data()), vz = load8(rows[5].data());
    compression = load8(rows[6].data()), pressure = load8(rows[7].data());
  }

  // Takes the lanes whose bits are set out of reach, and brings the others back.
  void hide(const FluidPack* packs, std::uint32_t count, unsigned lanes, const Eigen::Vector3f& away) {
    const Float8 far = lanes_of(lanes);
    const Targets own(packs, count);
    x = own.x + far * broadcast(away.x());
    y = own.y + far * broadcast(away.y());
    z = own.z + far * broadcast(away.z());
  }
};

struct Sums {
  Float8 ax{}, ay{}, az{};
  Float8 divergence{}, wall_divergence{};  // sums of s (v_ij . x_ij)
  Float8 diffusion{};
  Float8 sx{}, sy{}, sz{};  // XSPH or shifting
  Float8 wall_distance2 = broadcast(1e18F);
  Float8 wx{}, wy{}, wz{}, wall_sum{};  // push of walls, and what they add to the density
  Float8 fx{}, fy{}, fz{};              // friction on walls ...
  Float8 friction_rate{};               // ... and the rate (1/s) at which it would stop the particle

  void add_push(const Float8& pressure) {
    ax += pressure * wx;
    ay += pressure * wy;
    az += pressure * wz;
  }

  // The friction of a wall grows without limit as a particle comes close to it. Within one step it may stop the
  // particle, but not throw it back: where it would, it is made smaller.
  void add_friction(float time_step) {
    const Float8 share = broadcast(1.0F) / max(broadcast(1.0F), broadcast(time_step) * friction_rate);
    ax += share * fx;
    ay += share * fy;
    az += share * fz;
  }
};

// Where walls add more to the density than fluid feels that rests in an edge, they add this much of the square of the
// rest too. The sum alone would hold a single drop only up to one and a half times max_speed.
constexpr float wall_barrier = 2;

// Constants in all lanes.
struct SplatCoefficients {
  Float8 inverse_support, gx, gy, gz;
  Float8 wall_inverse_support, wall_pressure, wall_barrier_from;
  ViscousPairs viscous;
  MinimumImage image;

  explicit SplatCoefficients(const PairCoefficients& c)
      : inverse_support(broadcast(c.inverse_support)),
        gx(broadcast(c.compression_gradient[0])),
        gy(broadcast(c.compression_gradient[1])),
        gz(broadcast(c.compression_gradient[2])),
        wall_inverse_support(broadcast(c.wall_inverse_support)),
        wall_pressure(broadcast(c.wall_pressure)),
        wall_barrier_from(broadcast(c.wall_barrier_from)),
        viscous(c),
        image(c) {}

  Float8 wall_excess(const Float8& wall_sum) const { return max(Float8{}, wall_sum - wall_barrier_from); }
};

// Density difference that diffuses. Fluid at rest has a density gradient that must stay: the part of the difference
// that hydrostatics explains is left out, as in [FDM*19, Eq. 9], but only where the density really differs in that
// direction: fluid in free fall has no such gradient, and none shall be made.
inline Float8 diffusing_difference(const Float8& difference, const Float8& hydrostatic) {
  const Float8 zero{};
  return difference - min(max(difference, min(hydrostatic, zero)), max(hydrostatic, zero));
}

// The viscous force of the loop: none (the implicit step adds it), or the form, with one viscosity for all or one each.
struct Inviscid {
  static constexpr bool viscous = false, monaghan = true, variable = false;
};
template <bool monaghan_form, bool with_variable>
struct Viscous {
  static constexpr bool viscous = true, monaghan = monaghan_form, variable = with_variable;
};

// What moves particles besides their velocity: nothing, XSPH smoothing, or the shift to even distances.
enum class Drift { none, smoothed, shifted };

template <typename Kernel, typename Viscosity, bool continuity, Drift drift, bool periodic>
inline void add_fluid(const SplatCoefficients& c, const Targets& i, const FluidPack& j, const Float8& own_viscosity,
                      float viscosity, Sums& sums) {
  const auto [dx, dy, dz] = c.image.difference<periodic>(i.x, i.y, i.z, j);
  const Float8 ux = i.vx - broadcast(j.vx), uy = i.vy - broadcast(j.vy), uz = i.vz - broadcast(j.vz);
  const Float8 r2 = dx * dx + dy * dy + dz * dz;
  const Float8 q = sqrt(r2) * c.inverse_support;
  const Float8 s = Kernel::shape(q);
  const Float8 approach = ux * dx + uy * dy + uz * dz;
  if constexpr (continuity) {
    sums.divergence += s * approach;
    const Float8 hydrostatic = -(c.gx * dx + c.gy * dy + c.gz * dz);
    sums.diffusion += s * diffusing_difference(broadcast(j.compression) - i.compression, hydrostatic);
  }
  const Float8 pressure = i.pressure + broadcast(j.pressure);
  if constexpr (Viscosity::monaghan) {
    Float8 f = s * pressure;
    if constexpr (Viscosity::viscous) {
      f -= c.viscous.fluid<Viscosity::variable>(q, own_viscosity, viscosity) * approach;
    }
    sums.ax += f * dx;
    sums.ay += f * dy;
    sums.az += f * dz;
  } else {
    const Float8 f = s * pressure;
    const Float8 g = c.viscous.fluid<Viscosity::variable>(q, own_viscosity, viscosity) * r2;
    sums.ax += f * dx - g * ux;
    sums.ay += f * dy - g * uy;
    sums.az += f * dz - g * uz;
  }
  if constexpr (drift == Drift::shifted) {
    sums.sx += s * dx;
    sums.sy += s * dy;
    sums.sz += s * dz;
  }
  if constexpr (drift == Drift::smoothed) {
    const Float8 w = Kernel::scaled_value(q);
    sums.sx -= w * ux;
    sums.sy -= w * uy;
    sums.sz -= w * uz;
  }
}

// A wall pushes with the pressure of the fluid particle [AIA*12, Eq. 9] and resists shear.
template <typename Kernel, typename Viscosity, bool periodic>
inline void add_wall(const SplatCoefficients& c, const Targets& i, const WallPack& b, const Float8& own_viscosity,
                     Sums& sums) {
  const auto [dx, dy, dz] = c.image.difference<periodic>(i.x, i.y, i.z, b);
  const Float8 r2 = dx * dx + dy * dy + dz * dz;
  sums.wall_distance2 = min(sums.wall_distance2, r2);
  const Float8 q = sqrt(r2) * c.wall_inverse_support, s = broadcast(b.volume) * Kernel::shape(q);
  const Float8 ux = i.vx - broadcast(b.vx), uy = i.vy - broadcast(b.vy), uz = i.vz - broadcast(b.vz);
  const Float8 approach = ux * dx + uy * dy + uz * dz;
  sums.wall_divergence += s * approach;
  sums.wx += s * dx;
  sums.wy += s * dy;
  sums.wz += s * dz;
  sums.wall_sum += broadcast(b.volume) * Kernel::scaled_value(q);
  if constexpr (!Viscosity::viscous) return;
  const Float8 friction = c.viscous.wall<Viscosity::variable>(s * broadcast(b.stick), r2, own_viscosity);
  sums.friction_rate += friction * r2;
  if constexpr (Viscosity::monaghan) {
    sums.fx -= friction * approach * dx;
    sums.fy -= friction * approach * dy;
    sums.fz -= friction * approach * dz;
  } else {
    sums.fx -= friction * r2 * ux;
    sums.fy -= friction * r2 * uy;
    sums.fz -= friction * r2 * uz;
  }
}

// Loops over clusters take equal shares, the same in each: so a particle stays in the cache of one core from stage to
// stage. (Pieces taken as they come balance better, and were slower: two threads 1.66 instead of 1.88 times as fast.)
template <typename Kernel, typename Viscosity, bool continuity, Drift drift, bool periodic>
void run_forces(const PairCoefficients& coefficients, const PairData& data) {
  const SplatCoefficients c(coefficients);
  const PointClusters& clusters = *data.clusters;
#pragma omp parallel for schedule(static) num_threads(threads_for(data.fluid.size()))
  for (std::size_t cluster = 0; cluster < clusters.size(); ++cluster) {
    const std::uint32_t first = clusters[cluster].first, count = clusters[cluster].count;
    Targets targets(&data.fluid[first], count);
    Sums sums;
    constexpr bool variable = Viscosity::variable;
    const Float8 viscosity = variable ? load_viscosities(&data.viscosities[first], count) : Float8{};
    const std::size_t parts = data.fluid_lists->part_count(cluster);
    for (std::size_t part = 0; part < parts; ++part) {
      const auto [sources, hidden] = data.fluid_lists->part(cluster, part);
      if (part > 0) targets.hide(&data.fluid[first], count, hidden, coefficients.away);
      for (const std::uint32_t j : sources) {
        const float other = variable ? data.viscosities[j] : 0.0F;
        add_fluid<Kernel, Viscosity, continuity, drift, periodic>(c, targets, data.fluid[j], viscosity, other, sums);
      }
    }
    if (parts > 1) targets.hide(&data.fluid[first], count, 0, coefficients.away);
    for (const std::uint32_t b : data.wall_lists->of_cluster(cluster)) {
      add_wall<Kernel, Viscosity, periodic>(c, targets, data.walls[b], viscosity, sums);
    }
    // The gradient of what walls add to the density, so that energy is kept.
    const Float8 barrier = continuity ? Float8{} : broadcast(2 * wall_barrier) * c.wall_excess(sums.wall_sum);
    sums.add_push(targets.pressure * c.wall_pressure * (broadcast(1.0F) + barrier));
    if constexpr (Viscosity::viscous) sums.add_friction(data.time_step);
    for (std::uint32_t k = 0; k < count; ++k) {
      // Continuity: d(rho / rho_0)/dt = V sum v_ij . grad W [Monaghan 1992, Eq. 2.17], plus the diffusion.
      const float rate = coefficients.diffusion * sums.diffusion[k] -
                         coefficients.kernel_gradient * sums.divergence[k] -
                         coefficients.wall_gradient * sums.wall_divergence[k];
      data.rates[first + k] = {sums.ax[k], sums.ay[k], sums.az[k], rate};
      data.wall_distances[first + k] = std::sqrt(sums.wall_distance2[k]);
      const Eigen::Vector3f drift_sum(sums.sx[k], sums.sy[k], sums.sz[k]);
      if constexpr (drift == Drift::smoothed) data.shifts[first + k] = coefficients.xsph * drift_sum;
      if constexpr (drift == Drift::shifted) {
        // As an even pressure would push: walls hold a lattice beside them in place, and half of a pair's force is one
        // particle's.
        const Eigen::Vector3f wall_push(sums.wx[k], sums.wy[k], sums.wz[k]);
        data.shifts[first + k] =
            data.fastest * coefficients.shift_scale * (drift_sum + 0.5F * coefficients.wall_pressure * wall_push);
      }
    }
  }
}

template <typename Kernel, bool periodic>
void run_densities(const PairCoefficients& coefficients, const PairData& data) {
  const SplatCoefficients c(coefficients);
  const PointClusters& clusters = *data.clusters;
#pragma omp parallel for schedule(static) num_threads(threads_for(data.fluid.size()))
  for (std::size_t cluster = 0; cluster < clusters.size(); ++cluster) {
    const std::uint32_t first = clusters[cluster].first, count = clusters[cluster].count;
    Targets i(&data.fluid[first], count);
    const auto kernel = [&](const auto& j, const Float8& inverse_support) {
      const auto [dx, dy, dz] = c.image.difference<periodic>(i.x, i.y, i.z, j);
      return Kernel::scaled_value(sqrt(dx * dx + dy * dy + dz * dz) * inverse_support);
    };
    Float8 sum{}, wall_sum{};
    const std::size_t parts = data.fluid_lists->part_count(cluster);
    for (std::size_t part = 0; part < parts; ++part) {
      const auto [sources, hidden] = data.fluid_lists->part(cluster, part);
      if (part > 0) i.hide(&data.fluid[first], count, hidden, coefficients.away);
      for (const std::uint32_t j : sources) sum += kernel(data.fluid[j], c.inverse_support);
    }
    if (parts > 1) i.hide(&data.fluid[first], count, 0, coefficients.away);
    for (const std::uint32_t b : data.wall_lists->of_cluster(cluster)) {
      wall_sum += broadcast(data.walls[b].volume) * kernel(data.walls[b], c.wall_inverse_support);
    }
    const Float8 excess = c.wall_excess(wall_sum);
    wall_sum += broadcast(wall_barrier) * excess * excess;
    for (std::uint32_t k = 0; k < count; ++k) {
      FluidPack& pack = data.fluid[first + k];
      pack.compression = std::max(coefficients.least_compression, coefficients.kernel_scale * sum[k] + wall_sum[k] - 1);
      pack.pressure = coefficients.pack_pressure(pack.compression);
    }
  }
}

template <typename Function>
void with_viscosity(const PairData& data, const SolverSettings& settings, Function function) {
  if (!data.viscous) return function(Inviscid{});
  // Several fluids come with Monaghan's form only: every combination costs compile time.
  if (settings.viscosity_form == ViscosityForm::morris) return function(Viscous<false, false>{});
  with_bool(!data.viscosities.empty(), [&](auto variable) { function(Viscous<true, variable.value>{}); });
}

template <typename Function>
void with_drift(const PairData& data, const SolverSettings& settings, Function function) {
  if (data.shifts.empty()) return function(std::integral_constant<Drift, Drift::none>{});
  if (settings.xsph > 0) return function(std::integral_constant<Drift, Drift::smoothed>{});
  function(std::integral_constant<Drift, Drift::shifted>{});
}

}  // namespace

void sum_densities(const PairCoefficients& coefficients, const SolverSettings& settings, const PairData& data) {
  with_kernel(settings.kernel, [&](auto kernel) {
    with_bool(is_periodic(settings),
              [&](auto periodic) { run_densities<decltype(kernel), periodic.value>(coefficients, data); });
  });
}

void compute_forces(const PairCoefficients& coefficients, const SolverSettings& settings, const PairData& data) {
  with_kernel(settings.kernel, [&](auto kernel) {
    with_viscosity(data, settings, [&](auto viscosity) {
      with_bool(settings.density_method == DensityMethod::continuity, [&](auto continuity) {
        with_drift(data, settings, [&](auto drift) {
          with_bool(is_periodic(settings), [&](auto periodic) {
            run_forces<decltype(kernel), decltype(viscosity), continuity.value, drift.value, periodic.value>(
                coefficients, data);
          });
        });
      });
    });
  });
}

}  // namespace flowskin::sph
