#include "scenes/sources/body_particles.h"

#include <random>

#include "sph/bodies/fluid_bodies.h"

namespace flowskin::scenes {
namespace {

/// Between -1 and 1, from the generator's 53 highest bits: the same with every standard library.
double random_share(std::mt19937_64& generator) { return 2 * (static_cast<double>(generator() >> 11) * 0x1p-53) - 1; }

}  // namespace

std::vector<Vec3> body_particles(const Scene& scene) {
  std::vector<sph::FluidBody> bodies;
  for (const BodySpec& body : scene.bodies) bodies.push_back(body.body);
  const double jitter = scene.particles.jitter * scene.particles.spacing;
  std::mt19937_64 generator(scene.seed);
  std::vector<Vec3> points;
  for (const sph::FluidPoint& point : sph::fill_bodies(bodies, scene.particles.spacing, {})) {
    Vec3 position = point.position;
    for (int axis = 0; axis < 3; ++axis) position[axis] += jitter * random_share(generator);
    points.push_back(position);
  }
  return points;
}

}  // namespace flowskin::scenes
