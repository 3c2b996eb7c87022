#include "sph/forces/surface_tension.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/parallel.h"
#include "sph/forces/kernels.h"
#include "sph/pairs/lanes.h"

namespace flowskin::sph {

namespace {

using Kernel = WendlandC2;

// With 2.5 spacings single particles come off the surface; 4 make it no more accurate, but twice as slow.
constexpr double reach_in_spacings = 3.0;
// The surface of a drop that has come to rest is a little denser than the lattice: it pulls so much more. Measured from
// the Laplace pressure of drops with radii of 8 and 11 spacings.
constexpr double relaxation = 1.1;
constexpr double least_gradient_in_spacings = 0.02, ramp_in_spacings = 0.03;

// What the layers of a half space of lattice, its surface a plane half a spacing above the first one, do to a plane
// across it: sum over layers of |grad c| dx times -V sum_j y_j dW/dy_j, y along the surface.
double lattice_tension(const SurfaceTension& model, double spacing) {
  const int reach = static_cast<int>(std::ceil(reach_in_spacings));
  double tension = 0;
  for (int layer = 0; layer < reach; ++layer) {
    double gradient = 0, consistency = 0;
    for (int k = -reach; k <= layer; ++k) {
      for (int i = -reach; i <= reach; ++i) {
        for (int j = -reach; j <= reach; ++j) {
          const double r = spacing * std::sqrt(i * i + j * j + k * k);
          const double s = static_cast<double>(model.gradient_scale) * Kernel::shape(r / model.reach) * spacing;
          gradient -= s * k;
          consistency += s * i * i * spacing;
        }
      }
    }
    tension += spacing * static_cast<double>(model.counted_gradient(static_cast<float>(gradient))) * consistency;
  }
  return tension;
}

// One quantity of the particles of a cluster in each row; lanes without a particle repeat the first one.
template <std::size_t rows, typename Item, typename Read>
std::array<Float8, rows> load_rows(const Item* items, std::uint32_t count, Read read) {
  std::array<std::array<float, PointCluster::width>, rows> table;
  for (std::uint32_t k = 0; k < PointCluster::width; ++k) {
    const std::array<float, rows> values = read(items[k < count ? k : 0]);
    for (std::size_t row = 0; row < rows; ++row) table[row][k] = values[row];
  }
  std::array<Float8, rows> result;
  for (std::size_t row = 0; row < rows; ++row) result[row] = load8(table[row].data());
  return result;
}

std::array<Float8, 3> load_positions(const FluidPack* packs, std::uint32_t count) {
  return load_rows<3>(packs, count, [](const FluidPack& p) { return std::array{p.x, p.y, p.z}; });
}

struct Vector8 {
  Float8 x, y, z;
  Float8 length() const { return sqrt(x * x + y * y + z * z); }
};

// p - j, in a periodic box to the nearest image.
template <bool periodic, typename Pack>
Vector8 difference(const SurfaceTension& model, const std::array<Float8, 3>& p, const Pack& j) {
  Vector8 d{p[0] - broadcast(j.x), p[1] - broadcast(j.y), p[2] - broadcast(j.z)};
  if constexpr (periodic) {
    d.x -= broadcast(model.period[0]) * round8(d.x * broadcast(model.inverse_period[0]));
    d.y -= broadcast(model.period[1]) * round8(d.y * broadcast(model.inverse_period[1]));
    d.z -= broadcast(model.period[2]) * round8(d.z * broadcast(model.inverse_period[2]));
  }
  return d;
}

// The places with the lanes whose bits are set out of reach.
std::array<Float8, 3> without(const SurfaceTension& model, std::array<Float8, 3> places, unsigned hidden) {
  if (hidden == 0) return places;
  const Float8 far = lanes_of(hidden);
  for (std::size_t a = 0; a < 3; ++a) places[a] += far * broadcast(model.away[static_cast<int>(a)]);
  return places;
}

struct Sum3 {
  Float8 x{}, y{}, z{};
  void add(const Float8& f, const Vector8& d) {
    x += f * d.x;
    y += f * d.y;
    z += f * d.z;
  }
};

// Stresses of one cluster; c decreases along n, so n points outwards.
template <bool periodic>
void find_stresses(const SurfaceTension& model, const SurfaceTensionData& data, std::size_t c) {
  const std::uint32_t first = (*data.clusters)[c].first, count = (*data.clusters)[c].count;
  const std::array<Float8, 3> place = load_positions(&data.fluid[first], count);
  const Float8 inverse_reach = broadcast(model.inverse_reach);
  Sum3 sum;
  for (std::size_t part = 0; part < data.fluid_lists->part_count(c); ++part) {
    const auto [sources, hidden] = data.fluid_lists->part(c, part);
    const std::array<Float8, 3> seen = without(model, place, hidden);
    for (const std::uint32_t neighbor : sources) {
      const FluidPack& j = data.fluid[neighbor];
      const Vector8 d = difference<periodic>(model, seen, j);
      sum.add(Kernel::shape(d.length() * inverse_reach), d);
    }
  }
  for (std::uint32_t k = 0; k < count; ++k) {
    const Eigen::Vector3f g(sum.x[k], sum.y[k], sum.z[k]);
    const float length = g.norm(), counted = model.counted_gradient(model.gradient_scale * length);
    SurfaceStress& result = data.stresses[first + k];
    result = {0, 0, 0, 0};
    if (counted > 0) result = {g.x() / length, g.y() / length, g.z() / length, model.stress_scale * counted};
  }
}

// Forces of one cluster by (T_i + T_j) . grad W.
template <bool periodic>
void add_stress_forces(const SurfaceTension& model, const SurfaceTensionData& data, std::size_t c, Sum3& sum) {
  const std::uint32_t first = (*data.clusters)[c].first, count = (*data.clusters)[c].count;
  const std::array<Float8, 3> place = load_positions(&data.fluid[first], count);
  const auto [nx, ny, nz, stress] = load_rows<4>(&data.stresses[first], count, [](const SurfaceStress& s) {
    return std::array{s.nx, s.ny, s.nz, s.stress};
  });
  bool surface = false;
  for (std::uint32_t k = 0; k < count; ++k) surface = surface || data.stresses[first + k].stress > 0;
  const Float8 inverse_reach = broadcast(model.inverse_reach);
  for (std::size_t part = 0; part < data.fluid_lists->part_count(c); ++part) {
    const auto [sources, hidden] = data.fluid_lists->part(c, part);
    const std::array<Float8, 3> seen = without(model, place, hidden);
    for (const std::uint32_t neighbor : sources) {
      const SurfaceStress& t = data.stresses[neighbor];
      if (!surface && t.stress == 0) continue;  // both inside the fluid
      const FluidPack& j = data.fluid[neighbor];
      const Vector8 d = difference<periodic>(model, seen, j);  // the stress pulls: against d
      const Float8 mx = broadcast(t.nx), my = broadcast(t.ny), mz = broadcast(t.nz), other = broadcast(t.stress);
      const Float8 s = Kernel::shape(d.length() * inverse_reach);
      const Float8 own = s * stress * (nx * d.x + ny * d.y + nz * d.z),
                   its = s * other * (mx * d.x + my * d.y + mz * d.z);
      // In this order the sums are the same for both particles, up to the sign.
      sum.add(-s * (stress + other), d);
      sum.x += own * nx + its * mx;
      sum.y += own * ny + its * my;
      sum.z += own * nz + its * mz;
    }
  }
}

template <bool periodic>
void add_wall_attraction(const SurfaceTension& model, const SurfaceTensionData& data, std::size_t c, Sum3& sum) {
  const std::uint32_t first = (*data.clusters)[c].first, count = (*data.clusters)[c].count;
  const std::array<Float8, 3> place = load_positions(&data.fluid[first], count);
  for (const std::uint32_t wall : data.wall_lists->of_cluster(c)) {
    const WallPack& b = data.walls[wall];
    const Vector8 d = difference<periodic>(model, place, b);
    const Float8 u = max(broadcast(1.0F) - d.length() * broadcast(model.inverse_reach), Float8{});
    sum.add(broadcast(-model.wall_attraction * data.wall_adhesions[wall]) * u * u, d);
  }
}

template <bool periodic>
void run(const SurfaceTension& model, const SurfaceTensionData& data) {
  const PointClusters& clusters = *data.clusters;
  constexpr int piece = 16;
#pragma omp parallel num_threads(threads_for(data.fluid.size()))
  {
#pragma omp for schedule(dynamic, piece)
    for (std::size_t c = 0; c < clusters.size(); ++c) find_stresses<periodic>(model, data, c);
#pragma omp for schedule(dynamic, piece)
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      Sum3 sum;
      add_stress_forces<periodic>(model, data, c, sum);
      if (!data.wall_adhesions.empty()) add_wall_attraction<periodic>(model, data, c, sum);
      for (std::uint32_t k = 0; k < clusters[c].count; ++k) {
        ParticleRates& rate = data.rates[clusters[c].first + k];
        rate.ax += sum.x[k];
        rate.ay += sum.y[k];
        rate.az += sum.z[k];
      }
    }
  }
}

}  // namespace

SurfaceTension::SurfaceTension(const SolverSettings& s) {
  if (!(s.surface_tension > 0)) return;
  const double volume = s.spacing * s.spacing * s.spacing, mass = s.rest_density * volume;
  reach = reach_in_spacings * s.spacing;
  inverse_reach = static_cast<float>(1 / reach);
  away = away_from_all(s);
  for (int a = 0; a < 3; ++a) {
    if (!s.periodic[a]) continue;
    periodic = true;
    period[a] = static_cast<float>(s.domain.max[a] - s.domain.min[a]);
    inverse_period[a] = 1 / period[a];
  }
  gradient_scale = static_cast<float>(volume * Kernel::gradient_scale(reach));
  least_gradient = static_cast<float>(least_gradient_in_spacings / s.spacing);
  inverse_ramp = static_cast<float>(s.spacing / ramp_in_spacings);
  const double factor = s.surface_tension / (relaxation * lattice_tension(*this, s.spacing));
  stress_scale = static_cast<float>(factor * volume * volume * Kernel::gradient_scale(reach) / mass);
  // Work to pull a half space of n particles a volume off a plane whose areas dA attract with B r (1 - r/D)^2 dA:
  // (2 pi / 3) n B int r^4 (1 - r/D)^2 dr = (2 pi / 3) n B D^5 / 105, which shall be 2 gamma.
  const double strength = 315 * s.surface_tension * volume / (std::numbers::pi * std::pow(reach, 5));
  wall_attraction = static_cast<float>(strength / mass);
}

float SurfaceTension::counted_gradient(float gradient) const {
  const float share = (gradient - least_gradient) * inverse_ramp;
  return share <= 0 ? 0 : share < 1 ? share * gradient : gradient;
}

double capillary_speed_of_sound(const SolverSettings& s) {
  return std::sqrt(100 * 2 * s.surface_tension / (s.rest_density * s.spacing));
}

double capillary_time(const SolverSettings& s) {
  if (!(s.surface_tension > 0)) return std::numeric_limits<double>::infinity();
  const double h = 0.5 * s.support_radius * s.spacing;
  return std::sqrt(s.rest_density * h * h * h / (2 * std::numbers::pi * s.surface_tension));
}

void add_surface_tension(const SurfaceTension& model, const SurfaceTensionData& data) {
  model.periodic ? run<true>(model, data) : run<false>(model, data);
}

}  // namespace flowskin::sph
