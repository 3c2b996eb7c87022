// Cost of the surface velocity per vertex: the lookup, the field, its jet, each method. One thread unless
// OMP_NUM_THREADS says otherwise. The time of an iteration is that of all points; us_per_point is what counts,
// neighbors says at which number of neighbours.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "tests/tracking/field_test_bodies.h"
#include "tracking/extraction/extract_surface.h"
#include "tracking/field/neighborhoods.h"
#include "tracking/mesh/adjacency.h"
#include "tracking/mesh/self_intersections.h"
#include "tracking/tracker.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tracking {
namespace {

/// A ball of particles on a jittered lattice of spacing 1, and points on its surface in an order as a mesh has it.
struct Body {
  explicit Body(double radius_in_spacings)
      : particles(test::lattice(1, 19, 0.2, 41, [](const Vec3& x) { return x.norm() < 18.5; })),
        velocities(test::velocities_of(particles, [](const Vec3& x) { return Vec3(x.y(), 0.1 * x.x(), 0.3 * x.z()); })),
        field(particles, velocities, default_field_settings(1, radius_in_spacings)) {
    constexpr int rings = 100;
    for (int ring = 1; ring < rings; ++ring) {
      const double polar = M_PI * ring / rings;
      const int count = static_cast<int>(2 * rings * std::sin(polar));
      for (int i = 0; i < count; ++i) {
        const double around = 2 * M_PI * i / count;
        Vec3 x = 18.5 * Vec3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar));
        for (int step = 0; step < 8; ++step) {
          Vec3 gradient;
          const double value = field.value(x, gradient);
          if (gradient.norm() > 1e-3) x -= value / gradient.squaredNorm() * gradient;
        }
        points.push_back(x);
      }
    }
    for (const Vec3& point : points) neighbors += field.motion_jet(point).neighbors;
    neighbors /= static_cast<double>(points.size());
  }

  std::vector<Vec3> particles;
  std::vector<Vec3> velocities;
  MetaballField field;
  std::vector<Vec3> points;
  double neighbors = 0;
};

/// A large mesh at the default edge length, on a hollow ball in a flow that no affine motion explains, with noise.
struct LargeMesh {
  LargeMesh()
      : particles(test::lattice(1, 66, 0.2, 42, [](const Vec3& x) { return std::abs(x.norm() - 61) < 2.5; })),
        field(particles, flow_with_noise(), default_field_settings(1)),
        surface(extract_surface(field, 0.75)),
        topology(build_adjacency(static_cast<int>(surface.positions.size()), surface.triangles)) {}

  std::vector<Vec3> flow_with_noise() const {
    test::Random random(43);
    return test::velocities_of(particles, [&random](const Vec3& x) {
      return Vec3(Vec3(std::sin(0.2 * x.y()), std::cos(0.2 * x.z()), std::sin(0.2 * x.x())) + 0.05 * random.vector());
    });
  }

  std::vector<Vec3> particles;
  MetaballField field;
  SurfaceGeometry surface;
  MeshAdjacency topology;
};

const LargeMesh& large_mesh() {
  static const LargeMesh mesh;
  return mesh;
}

const Body& body(double radius_in_spacings) {
  static const Body two(2);
  static const Body two_and_a_half(2.5);
  static const Body three(3);
  return radius_in_spacings < 2.25 ? two : radius_in_spacings < 2.75 ? two_and_a_half : three;
}

void report(benchmark::State& state, const Body& of, std::size_t points) {
  state.counters["us_per_point"] = benchmark::Counter(
      static_cast<double>(points) * 1e-6, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["neighbors"] = of.neighbors;
}

template <class Evaluate>
void at_every_point(benchmark::State& state, double radius, const Evaluate& evaluate) {
  const Body& of = body(radius);
  for (auto iteration : state) {
    for (const Vec3& point : of.points) benchmark::DoNotOptimize(evaluate(of.field, point));
  }
  report(state, of, of.points.size());
}

void register_benchmarks(double radius) {
  const std::string suffix = "/radius:" + std::to_string(radius).substr(0, 3);
  const auto add = [&suffix](const std::string& name, const auto& run) {
    benchmark::RegisterBenchmark((name + suffix).c_str(), run)->Unit(benchmark::kMillisecond);
  };
  add("neighbors", [radius](benchmark::State& state) {
    std::vector<int> found;
    at_every_point(state, radius, [&found](const MetaballField& field, const Vec3& x) {
      field.neighbors(x, field.settings().radius, found);
      return found.size();
    });
  });
  // Far fewer sums than in the jet: nearly all of this is the lookup.
  add("value", [radius](benchmark::State& state) {
    at_every_point(state, radius, [](const MetaballField& field, const Vec3& x) { return field.value(x); });
  });
  add("value_and_gradient", [radius](benchmark::State& state) {
    at_every_point(state, radius, [](const MetaballField& field, const Vec3& x) {
      Vec3 gradient;
      return field.value(x, gradient) + gradient.x();
    });
  });
  // The same at all points together, which find their neighbours in patches; then with known neighbours, as fairing
  // has them.
  add("neighborhoods", [radius](benchmark::State& state) {
    const Body& of = body(radius);
    for (auto iteration : state) benchmark::DoNotOptimize(Neighborhoods(of.field, of.points, 0.1 * radius));
    report(state, of, of.points.size());
  });
  add("value_and_gradient_known", [radius](benchmark::State& state) {
    const Body& of = body(radius);
    const Neighborhoods neighborhoods(of.field, of.points, 0.1 * radius);
    std::vector<double> sums(of.points.size());
    for (auto iteration : state) {
      neighborhoods.for_each([&](int i, const LocalField& local) {
        Vec3 gradient;
        sums[i] = local.value(of.points[i], gradient) + gradient.x();
      });
    }
    report(state, of, of.points.size());
  });
  add("jet", [radius](benchmark::State& state) {
    at_every_point(state, radius, [](const MetaballField& field, const Vec3& x) { return field.motion_jet(x); });
  });
  for (const VelocityMethodInfo& method : velocity_methods()) {
    add("velocity/" + method.name, [radius, &method](benchmark::State& state) {
      const Body& of = body(radius);
      const auto velocity = method.create();
      std::vector<Vec3> velocities;
      for (auto iteration : state) velocity->evaluate(of.field, {}, of.points, velocities);
      report(state, of, of.points.size());
    });
  }
  // Here a point is a particle.
  add("build_field", [radius](benchmark::State& state) {
    const Body& of = body(radius);
    for (auto iteration : state) {
      benchmark::DoNotOptimize(MetaballField(of.particles, of.velocities, of.field.settings()));
    }
    report(state, of, of.particles.size());
  });
}

/// A hollow ball without intersections, of 60,000 triangles.
void register_self_intersections() {
  for (const int threads : {1, 2}) {
    const auto run = [threads](benchmark::State& state) {
      const MetaballField field(
          test::lattice(1, 28, 0.2, 44, [](const Vec3& x) { return std::abs(x.norm() - 25) < 2.5; }), {},
          default_field_settings(1));
      const SurfaceGeometry surface = extract_surface(field, 0.75);
      const int before = omp_get_max_threads();
      omp_set_num_threads(threads);
      std::size_t pairs = 0;
      for (auto iteration : state) pairs = self_intersections(surface.positions, surface.triangles).size();
      omp_set_num_threads(before);
      const auto count = static_cast<double>(surface.triangles.size());
      state.counters["pairs"] = static_cast<double>(pairs);
      state.counters["triangles"] = count;
      state.counters["us_per_triangle"] =
          benchmark::Counter(count * 1e-6, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    };
    benchmark::RegisterBenchmark(("self_intersections/threads:" + std::to_string(threads)).c_str(), run)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
}

/// The methods on the large mesh, with one and two threads.
void register_large_meshes() {
  for (const VelocityMethodInfo& method : velocity_methods()) {
    for (const int threads : {1, 2}) {
      const std::string name = "large_mesh/" + method.name + "/threads:" + std::to_string(threads);
      const auto run = [&method, threads](benchmark::State& state) {
        const LargeMesh& mesh = large_mesh();
        const int before = omp_get_max_threads();
        omp_set_num_threads(threads);
        const auto velocity = method.create();
        std::vector<Vec3> velocities;
        for (auto iteration : state) velocity->evaluate(mesh.field, mesh.topology, mesh.surface.positions, velocities);
        omp_set_num_threads(before);
        state.counters["vertices"] = static_cast<double>(mesh.surface.positions.size());
        state.counters["us_per_vertex"] =
            benchmark::Counter(static_cast<double>(mesh.surface.positions.size()) * 1e-6,
                               benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
      };
      benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond)->UseRealTime();
    }
  }
}

/// A frame of the tracker on the large mesh, without the guard: there and back in turns.
void register_tracker() {
  for (const int threads : {1, 2}) {
    const auto run = [threads](benchmark::State& state) {
      const int before = omp_get_max_threads();
      omp_set_num_threads(threads);
      const LargeMesh& mesh = large_mesh();
      Particles here;
      here.positions = here.rest_positions = mesh.particles;
      here.velocities = mesh.field.velocities();
      here.ids.resize(mesh.particles.size());
      std::iota(here.ids.begin(), here.ids.end(), 1);
      Particles there = here;
      there.time = 1;
      for (std::size_t i = 0; i < there.positions.size(); ++i) there.positions[i] += here.velocities[i];
      TrackerSettings settings;
      settings.spacing = 1;
      settings.velocity = "curvature";
      settings.guard = false;
      Tracker tracker(settings, here);
      double velocity = 0, projection = 0, fairing = 0;
      int frames = 0;
      for (auto iteration : state) {
        tracker.advance(++frames % 2 == 1 ? there : here);
        velocity += 1e3 * tracker.report().seconds_velocity;
        projection += 1e3 * tracker.report().seconds_projection;
        fairing += 1e3 * tracker.report().seconds_fairing;
      }
      omp_set_num_threads(before);
      state.counters["vertices"] = static_cast<double>(tracker.mesh().positions.size());
      state.counters["substeps"] = tracker.report().substeps;
      state.counters["ms_velocity"] = velocity / frames;
      state.counters["ms_projection"] = projection / frames;
      state.counters["ms_fairing"] = fairing / frames;
    };
    benchmark::RegisterBenchmark(("track_frame/threads:" + std::to_string(threads)).c_str(), run)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
}

}  // namespace
}  // namespace flowskin::tracking

int main(int argc, char** argv) {
  if (std::getenv("OMP_NUM_THREADS") == nullptr) omp_set_num_threads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  for (const double radius : {2.0, 2.5, 3.0}) flowskin::tracking::register_benchmarks(radius);
  flowskin::tracking::register_large_meshes();
  flowskin::tracking::register_tracker();
  flowskin::tracking::register_self_intersections();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
