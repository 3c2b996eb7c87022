// How far marching cubes' triangles are improved, in a whole surface and in a patch alike.
#pragma once

namespace flowskin::tracking::improvement {

// In units of the wanted edge length.
inline constexpr double kShortEdge = 0.5;  ///< A shorter edge is collapsed.
inline constexpr double kLongEdge = 1.5;   ///< No collapse makes a longer one.
/// Volume a collapse may cost, in cubes of the longest edge.
inline constexpr double kLargestCollapse = 0.005;
inline constexpr int kRounds = 4;  ///< Of collapses, flips and relaxation.
inline constexpr int kRelaxationsPerRound = 2;

}  // namespace flowskin::tracking::improvement
