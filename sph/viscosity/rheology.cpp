#include "sph/viscosity/rheology.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/parallel.h"
#include "sph/forces/kernels.h"
#include "sph/forces/minimum_image.h"
#include "sph/pairs/lanes.h"

namespace flowskin::sph {

double viscosity_at(const Fluid& fluid, double rest_density, double shear_rate) {
  const Rheology& law = fluid.rheology;
  if (law.is_newtonian()) return fluid.viscosity;
  const double g = std::max(shear_rate, 1e-9);  // the limit at rest, without a division by zero
  const double plastic =
      law.consistency > 0 ? law.consistency * std::pow(g, law.flow_index - 1) : rest_density * fluid.viscosity;
  const double yield = -law.yield_stress * std::expm1(-law.regularization * g) / g;
  return std::min((plastic + yield) / rest_density, law.max_viscosity);
}

namespace {

// The matrices of the fit: gradient = moment inverse(spread).
struct Fit {
  std::array<std::array<Float8, 3>, 3> moment{};  // sum w u d^T
  Float8 xx{}, xy{}, xz{}, yy{}, yz{}, zz{};      // sum w d d^T

  void add(const Float8& w, const Float8& dx, const Float8& dy, const Float8& dz, const Float8& ux, const Float8& uy,
           const Float8& uz) {
    const Float8 wx = w * dx, wy = w * dy, wz = w * dz;
    xx += wx * dx, xy += wx * dy, xz += wx * dz, yy += wy * dy, yz += wy * dz, zz += wz * dz;
    moment[0][0] += ux * wx, moment[0][1] += ux * wy, moment[0][2] += ux * wz;
    moment[1][0] += uy * wx, moment[1][1] += uy * wy, moment[1][2] += uy * wz;
    moment[2][0] += uz * wx, moment[2][1] += uz * wy, moment[2][2] += uz * wz;
  }

  Float8 shear_rate() const {
    // In a sheet or a thread some directions have no neighbours: a trace of isotropy makes the gradient zero there.
    constexpr float isotropy = 1e-3F, tiny = 1e-30F;
    const Float8 more = broadcast(isotropy) * (xx + yy + zz) + broadcast(tiny);
    const Float8 x = xx + more, y = yy + more, z = zz + more;
    const Float8 cx = y * z - yz * yz, cxy = xz * yz - xy * z, cxz = xy * yz - xz * y;
    const Float8 cy = x * z - xz * xz, cyz = xy * xz - x * yz, cz = x * y - xy * xy;
    const Float8 d = broadcast(1.0F) / max(x * cx + xy * cxy + xz * cxz, broadcast(tiny));
    std::array<std::array<Float8, 3>, 3> g;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto& m = moment[a];
      g[a] = {d * (m[0] * cx + m[1] * cxy + m[2] * cxz), d * (m[0] * cxy + m[1] * cy + m[2] * cyz),
              d * (m[0] * cxz + m[1] * cyz + m[2] * cz)};
    }
    const Float8 third = broadcast(1.0F / 3) * (g[0][0] + g[1][1] + g[2][2]);
    const Float8 exx = g[0][0] - third, eyy = g[1][1] - third, ezz = g[2][2] - third;
    const Float8 exy = g[0][1] + g[1][0], exz = g[0][2] + g[2][0], eyz = g[1][2] + g[2][1];  // twice D
    return sqrt(broadcast(2.0F) * (exx * exx + eyy * eyy + ezz * ezz) + exy * exy + exz * exz + eyz * eyz);
  }
};

template <typename Kernel, bool periodic>
void run_shear_rates(const PairCoefficients& c, const PairData& data, std::span<float> shear_rates) {
  const PointClusters& clusters = *data.clusters;
  // Lengths in support radii: the matrices would leave the range of floats.
  const MinimumImage image(c);
  const Float8 unit = broadcast(c.inverse_support), wall_unit = broadcast(c.wall_inverse_support);
  const float wall_weight = c.wall_gradient / c.kernel_gradient;
#pragma omp parallel for schedule(dynamic, 16) num_threads(threads_for(data.fluid.size()))
  for (std::size_t cluster = 0; cluster < clusters.size(); ++cluster) {
    const std::uint32_t first = clusters[cluster].first, count = clusters[cluster].count;
    std::array<std::array<float, PointCluster::width>, 6> rows;
    for (std::uint32_t k = 0; k < PointCluster::width; ++k) {
      const FluidPack& p = data.fluid[first + (k < count ? k : 0)];
      rows[0][k] = p.x, rows[1][k] = p.y, rows[2][k] = p.z, rows[3][k] = p.vx, rows[4][k] = p.vy, rows[5][k] = p.vz;
    }
    std::array<Float8, 6> i{};
    for (std::size_t a = 0; a < i.size(); ++a) i[a] = load8(rows[a].data());
    Fit fit;
    for (std::size_t part = 0; part < data.fluid_lists->part_count(cluster); ++part) {
      const auto [sources, hidden] = data.fluid_lists->part(cluster, part);
      std::array<Float8, 3> x{i[0], i[1], i[2]};
      if (part > 0) {
        const Float8 far = lanes_of(hidden);
        for (std::size_t a = 0; a < 3; ++a) x[a] += far * broadcast(c.away[static_cast<int>(a)]);
      }
      for (const std::uint32_t index : sources) {
        const FluidPack& j = data.fluid[index];
        const Difference d = image.difference<periodic>(x[0], x[1], x[2], j);
        const Float8 dx = unit * d.x, dy = unit * d.y, dz = unit * d.z;
        const Float8 w = Kernel::shape(sqrt(dx * dx + dy * dy + dz * dz));
        fit.add(w, dx, dy, dz, i[3] - broadcast(j.vx), i[4] - broadcast(j.vy), i[5] - broadcast(j.vz));
      }
    }
    for (const std::uint32_t index : data.wall_lists->of_cluster(cluster)) {
      const WallPack& b = data.walls[index];
      const auto [dx, dy, dz] = image.difference<periodic>(i[0], i[1], i[2], b);
      const Float8 shape = Kernel::shape(sqrt(dx * dx + dy * dy + dz * dz) * wall_unit);
      const Float8 w = broadcast(wall_weight * b.volume * b.stick) * shape;
      fit.add(w, unit * dx, unit * dy, unit * dz, i[3] - broadcast(b.vx), i[4] - broadcast(b.vy),
              i[5] - broadcast(b.vz));
    }
    const Float8 rate = broadcast(c.inverse_support) * fit.shear_rate();
    for (std::uint32_t k = 0; k < count; ++k) shear_rates[first + k] = rate[k];
  }
}

}  // namespace

void find_shear_rates(const PairCoefficients& coefficients, const SolverSettings& settings, const PairData& data,
                      std::span<float> shear_rates) {
  with_kernel(settings.kernel, [&](auto kernel) {
    with_bool(is_periodic(settings), [&](auto periodic) {
      run_shear_rates<decltype(kernel), periodic.value>(coefficients, data, shear_rates);
    });
  });
}

}  // namespace flowskin::sph
