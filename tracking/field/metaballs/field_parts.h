// What a metaball field is made of, and how its parts add up. Internal to tracking/field.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "tracking/field/metaballs/group_sums.h"
#include "tracking/field/metaballs/metaball_field.h"
#include "tracking/field/metaballs/particle_blocks.h"

namespace flowskin::tracking {

/// Everything about a point asks `groups(k)` for the groups of part k near it: all that have a particle nearer than the
/// radius in question. A list is no longer looked at when the next one is asked for.
struct MetaballField::Impl {
  /// The neighbour lookup of one part, or of a wall.
  struct Part {
    std::shared_ptr<const ParticleBlocks> blocks;
    double share, share_rate;
    int first;  ///< Number of its first particle; of no meaning for a wall.
  };

  Impl(std::vector<FieldPart> given, const FieldSettings& field_settings, FieldWalls given_walls);

  template <class Groups>
  double value(const Vec3& x, const Groups& groups) const {
    double sum = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (parts[k].share > 0) sum += parts[k].share * kernel_sum(near(k, groups), x);
    }
    return settings.weight * sum - settings.threshold;
  }

  template <class Groups>
  double value(const Vec3& x, Vec3& gradient, const Groups& groups) const {
    double sum = 0;
    Vec3 gradient_sum = Vec3::Zero();
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (!(parts[k].share > 0)) continue;
      Vec3 part_gradient;
      sum += parts[k].share * kernel_sum(near(k, groups), x, part_gradient);
      gradient_sum += parts[k].share * part_gradient;
    }
    gradient = -6 * settings.weight * per_square * gradient_sum;
    return settings.weight * sum - settings.threshold;
  }

  template <class Groups>
  MotionJet jet(const Vec3& x, const Groups& groups) const {
    if (shares.empty() && particle_parts == 1 && parts.front().share_rate == 0)
      return jet_of(near(0, groups), x, settings);
    FieldSettings without_threshold = settings;
    without_threshold.threshold = 0;
    MotionJet sum;
    for (std::size_t k = 0; k < particle_parts; ++k) {
      if (parts[k].share > 0 || parts[k].share_rate != 0)
        add_share(jet_of(near(k, groups), x, without_threshold), parts[k], sum);
    }
    sum.moving_value -= settings.threshold;
    return sum;
  }

  template <class Groups>
  KernelMoments moments(const Vec3& x, const Groups& groups) const {
    KernelMoments sum;
    for (std::size_t k = 0; k < particle_parts; ++k) {
      if (parts[k].share > 0) add_moments(near(k, groups), x, parts[k].share, sum);
    }
    return sum;
  }

  template <class Groups>
  void neighbors(const Vec3& x, double radius, std::vector<int>& found, const Groups& groups) const {
    found.clear();
    for (std::size_t k = 0; k < particle_parts; ++k) {
      for (const int group : groups(k)) {
        for (int lane = 0; lane < lane_count; ++lane) {
          const int in_part = parts[k].blocks->particle(group, lane);
          if (in_part < 0) continue;
          const int particle = parts[k].first + in_part;
          if ((positions[particle] - x).squaredNorm() < radius * radius) found.push_back(particle);
        }
      }
    }
    std::sort(found.begin(), found.end());
  }

  /// The groups around x by a lookup of their own.
  auto looked_up(const Vec3& x) const {
    return [this, &x](std::size_t part) { return parts[part].blocks->near(x, settings.radius, scratch()); };
  }
  /// Where a thread keeps the numbers of the groups near its point, so that queries do not allocate.
  static std::vector<int>& scratch() {
    thread_local std::vector<int> found;
    return found;
  }

  template <class Groups>
  NearGroups near(std::size_t part, const Groups& groups) const {
    return {*parts[part].blocks, groups(part), settings.radius, per_square};
  }
  /// Adds a part's jet with its share; its value is without the threshold.
  static void add_share(const MotionJet& jet, const Part& part, MotionJet& sum);

  FieldSettings settings;
  double per_square;  // 1 / radius^2
  std::vector<Vec3> positions;
  std::vector<Vec3> velocities;
  std::vector<double> shares;
  std::vector<Part> parts;         // those of the particles first, then the walls
  std::size_t particle_parts = 0;  // so many
  FieldWalls walls;
  // The last grid that was asked for.
  mutable std::mutex grid_lock;
  mutable std::shared_ptr<const SparseGrid> grid;
};

}  // namespace flowskin::tracking
