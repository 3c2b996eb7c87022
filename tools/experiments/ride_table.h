// Rides as rows of a table.
#pragma once

#include <string>
#include <vector>

#include "tools/experiments/result_table.h"
#include "tools/experiments/ride.h"
#include "tools/textures/image.h"

namespace flowskin::tools {

/// A table for rides through several scenes.
ResultTable ride_table();
/// One row a checkpoint. `without_spin`: the errors are those against Truth::unspinning.
void add_ride(ResultTable& table, const scenes::Scene& scene, const Ride& ride, bool without_spin = false);
/// Only the last checkpoint.
void add_ride_end(ResultTable& table, const scenes::Scene& scene, const Ride& ride, bool without_spin = false);

/// The rides whose settings `wanted` accepts, in order.
template <class Wanted>
std::vector<Ride> rides_where(const std::vector<Ride>& rides, Wanted&& wanted) {
  std::vector<Ride> found;
  for (const Ride& ride : rides)
    if (wanted(ride.settings)) found.push_back(ride);
  return found;
}

/// The first ride with this method. @throws std::logic_error where there is none.
const Ride& ride_of(const std::vector<Ride>& rides, const std::string& method);

/// Contact sheet: the start and the ends of rides; above textured, below coloured by distance to the true place, red at
/// `largest` effective radii.
Image ride_sheet(const scenes::Scene& scene, const tracking::SurfaceMesh& start, const std::vector<Ride>& rides,
                 double largest);

}  // namespace flowskin::tools
