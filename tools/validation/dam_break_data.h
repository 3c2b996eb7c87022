// Measured fronts of collapsing water columns.
#pragma once

#include <string>
#include <vector>

namespace flowskin::tools {

struct DamBreakPoint {
  double time;   ///< T = t sqrt(2 g / L), L the width of the column
  double front;  ///< Z = z / L, z the front's distance from the back wall
};

struct DamBreakSeries {
  std::string name;
  double width;   ///< L (m)
  double height;  ///< of the column, in widths
  std::vector<DamBreakPoint> points;
};

/// Koshizuka and Oka 1996; Martin and Moyce 1952 with columns 1.125 and 2.25 inches wide, and 2.25 inches square.
const std::vector<DamBreakSeries>& dam_break_experiments();

}  // namespace flowskin::tools
