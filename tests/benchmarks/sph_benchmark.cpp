// Speed and memory of the solver, as multiples of a plain pair loop measured in the same run.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "sph/neighbors/hilbert_order.h"
#include "sph/neighbors/neighbor_lists.h"
#include "tests/sph/test_meshes.h"

namespace flowskin::sph {
namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The yardstick: density, then pressure and viscosity, over ready-made Verlet lists with one list per particle (49
// entries, of which 28 in reach), one thread, float, nothing else: no search, no walls, no integration.
class ReferenceLoop {
 public:
  explicit ReferenceLoop(int edge) {
    std::vector<Eigen::Vector3f> points;
    Random random(1);
    for (int i = 0; i < edge * edge * edge; ++i) {
      const Vec3 jitter = 0.17 * (random.vector() - Vec3::Constant(0.5));
      points.emplace_back(Vec3(i / (edge * edge), i / edge % edge, i % edge).cast<float>() + jitter.cast<float>());
    }
    HilbertOrder curve;
    curve.compute(points, 1.0F);
    std::vector<Eigen::Vector3f> sorted;
    for (const std::uint32_t i : curve.order()) sorted.push_back(points[i]);
    PointClusters clusters;
    clusters.assign(sorted, 3.0F);
    constexpr float reach = 2.3F;
    NeighborLists lists;
    lists.build(clusters, clusters, reach);
    offsets_.push_back(0);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      for (std::uint32_t i = clusters[c].first; i < clusters[c].first + clusters[c].count; ++i) {
        for (const std::uint32_t j : lists.of_cluster(c)) {
          if (j != i && (sorted[i] - sorted[j]).norm() < reach) neighbors_.push_back(static_cast<int>(j));
        }
        offsets_.push_back(static_cast<int>(neighbors_.size()));
      }
    }
    for (const auto& p : sorted) {
      x_.push_back(p.x()), y_.push_back(p.y()), z_.push_back(p.z());
      for (auto* v : {&vx_, &vy_, &vz_}) v->push_back(static_cast<float>(0.1 * random() - 0.05));
    }
    for (auto* v : {&density_, &pressure_, &ax_, &ay_, &az_}) v->resize(sorted.size());
  }

  // Microseconds per particle and step.
  double time(int steps) {
    const double start = seconds_now();
    for (int k = 0; k < steps; ++k) {
      densities();
      forces();
      benchmark::ClobberMemory();
    }
    return 1e6 * (seconds_now() - start) / steps / static_cast<double>(x_.size());
  }

 private:
  void densities() {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      float sum = 1;
      const float xi = x_[i], yi = y_[i], zi = z_[i];
#pragma omp simd reduction(+ : sum)
      for (int k = offsets_[i]; k < offsets_[i + 1]; ++k) {
        const int j = neighbors_[k];
        const float dx = xi - x_[j], dy = yi - y_[j], dz = zi - z_[j];
        const float u = std::max(0.0F, 1 - 0.5F * std::sqrt(dx * dx + dy * dy + dz * dz)), u2 = u * u;
        sum += u2 * u2 * (5 - 4 * u);
      }
      density_[i] = sum;
      const float cube = sum * sum * sum;
      pressure_[i] = cube * cube * sum - 1;
    }
  }

  void forces() {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      float ax = 0, ay = 0, az = 0;
      const float xi = x_[i], yi = y_[i], zi = z_[i], vx = vx_[i], vy = vy_[i], vz = vz_[i];
      const float own = pressure_[i] / (density_[i] * density_[i]);
#pragma omp simd reduction(+ : ax, ay, az)
      for (int k = offsets_[i]; k < offsets_[i + 1]; ++k) {
        const int j = neighbors_[k];
        const float dx = xi - x_[j], dy = yi - y_[j], dz = zi - z_[j], r2 = dx * dx + dy * dy + dz * dz;
        const float u = std::max(0.0F, 1 - 0.5F * std::sqrt(r2)), gradient = u * u * u;
        const float push = gradient * (own + pressure_[j] / (density_[j] * density_[j]));
        const float drag = gradient * 0.1F / density_[j] * r2 / (r2 + 0.01F);
        ax += push * dx - drag * (vx - vx_[j]);
        ay += push * dy - drag * (vy - vy_[j]);
        az += push * dz - drag * (vz - vz_[j]);
      }
      ax_[i] = ax, ay_[i] = ay, az_[i] = az;
    }
  }

  std::vector<int> offsets_, neighbors_;
  std::vector<float> x_, y_, z_, vx_, vy_, vz_, density_, pressure_, ax_, ay_, az_;
};

// A block of edge^3 particles that collapses in a box twice as long, after `warm_up` steps.
std::unique_ptr<Solver> dam_break(int edge, int warm_up) {
  const double spacing = 0.02, length = edge * spacing;
  SimulationSetup setup = block_setup(spacing, {0, 0, 0}, {length, length, length});
  setup.settings.viscosity = 0.01;
  setup.boundaries.push_back({closed_box({0, 0, 0}, {2 * length, 1.5 * length, length}), 0});
  auto solver = std::make_unique<Solver>(setup);
  for (int k = 0; k < warm_up; ++k) solver->step();
  return solver;
}

void solver_step(benchmark::State& state) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(static_cast<int>(state.range(0)));
  const auto edge = static_cast<int>(state.range(1));
  static ReferenceLoop reference(46);
  const auto solver = dam_break(edge, edge > 150 ? 100 : 400);
  const SolverStatistics before = solver->statistics();
  const int steps = edge > 60 ? 10 : 20;
  double solver_time = 0, reference_time = 0, rounds = 0;
  for (auto _ : state) {
    const double start = seconds_now();
    for (int k = 0; k < steps; ++k) solver->step();
    const double seconds = seconds_now() - start;
    state.SetIterationTime(seconds);
    solver_time += 1e6 * seconds / steps / static_cast<double>(solver->particle_count());
    reference_time += reference.time(5);  // in turns, so that both see the same machine
    ++rounds;
  }
  const SolverStatistics& after = solver->statistics();
  const auto stepped = static_cast<double>(after.steps - before.steps);
  state.counters["us_per_particle_step"] = solver_time / rounds;
  state.counters["reference_us"] = reference_time / rounds;
  state.counters["ratio_to_reference"] = solver_time / reference_time;
  state.counters["steps_per_rebuild"] = stepped / static_cast<double>(after.list_rebuilds - before.list_rebuilds);
  const auto scale = 1e6 / stepped / static_cast<double>(solver->particle_count());
  state.counters["us_neighbors"] = scale * (after.seconds_neighbors - before.seconds_neighbors);
  state.counters["us_forces"] = scale * (after.seconds_forces - before.seconds_forces);
  state.counters["us_integration"] = scale * (after.seconds_integration - before.seconds_integration);
  state.counters["bytes_per_particle"] =
      static_cast<double>(solver->memory_bytes()) / static_cast<double>(solver->particle_count());
  state.counters["particles"] = static_cast<double>(solver->particle_count());
  state.counters["wall_particles"] = static_cast<double>(solver->boundary_particle_count());
  omp_set_num_threads(threads);
}
BENCHMARK(solver_step)
    ->ArgNames({"threads", "edge"})
    ->ArgsProduct({{1, 2}, {22, 46, 100}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(10);
// Five million particles: two gigabytes, minutes.
BENCHMARK(solver_step)
    ->Name("solver_step_large")
    ->ArgNames({"threads", "edge"})
    ->Args({2, 171})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(10);

void list_build(benchmark::State& state) {
  std::vector<Eigen::Vector3f> points(100000);
  Random random(1);
  for (auto& p : points) p = (46 * random.vector()).cast<float>();
  HilbertOrder curve;
  PointClusters clusters;
  NeighborLists lists;
  curve.compute(points, 1.0F);
  std::vector<Eigen::Vector3f> sorted;
  for (const std::uint32_t i : curve.order()) sorted.push_back(points[i]);
  for (auto _ : state) {
    clusters.assign(sorted, 3.0F);
    lists.build(clusters, clusters, 2.3F);
  }
  state.counters["entries_per_cluster"] = lists.mean_length();
}
BENCHMARK(list_build)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flowskin::sph

BENCHMARK_MAIN();
