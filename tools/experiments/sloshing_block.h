// A sloshing block of particles in a flow that is known everywhere, written as files and tracked as anyone's particles
// are: what the whole way from files to the texture costs, for each velocity method.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/vectors.h"

namespace flowskin::tools {

/// Velocity (m/s) in a block of 2 x 1 x 1 m with its corner at the origin: a standing wave of potential flow and two
/// vortices. Its divergence is zero; nothing flows through the walls x = 0, x = 2, y = 0.
Vec3 sloshing_velocity(const Vec3& place, double time);
/// Place at `end` (s) of what is at `place` at `begin`, by Runge and Kutta's fourth order in `steps`.
Vec3 sloshing_path(Vec3 place, double begin, double end, int steps);

/// What the files hold beside positions.
struct SloshingFiles {
  std::string name;
  bool ids = true, velocities = true;
  double noise = 0;  ///< Of the velocities, in RMS speeds of the particles.
  int every = 1;     ///< Only each second file is there: 2
};

/// with all, without ids, without velocities, positions only, 2 % noise, every second file missing
const std::vector<SloshingFiles>& sloshing_files();

struct SloshingSettings {
  int across = 22;              ///< Particles along the block's height.
  int frames = 16;              ///< 1/24 s apart.
  int fairing_iterations = -1;  ///< negative: the default
};

/// Distance between the vertices and where the flow takes their rest positions, at the end (spacings).
struct SloshingErrors {
  double median = 0, p90 = 0;
  double motion = 0;  ///< Mean distance that the particles have moved.
};

/// Writes the files into a temporary folder, tracks them and removes them. @throws RunError where that is not possible
SloshingErrors sloshing_errors(const std::string& method, const SloshingFiles& files, const SloshingSettings& settings);

/// All methods on all kinds of files, as Markdown, row by row to `put`. Takes half an hour.
void put_sloshing_table(const SloshingSettings& settings, const std::function<void(const std::string&)>& put);

}  // namespace flowskin::tools
