// Times of frames by the numbers of their time steps, as solvers count them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace flowskin::scenes {

/// Where frames lie in time, in units of the usual distance between them.
struct StepTimes {
  std::vector<double> places;  ///< Of each frame, the first is 0; empty where the numbers tell no times.
  double unit = 0;             ///< How many time steps a unit has.
  std::string warning;         ///< Gaps, or why the numbers tell no times; one sentence, or empty.
  bool are_even = true;        ///< All places are whole numbers.
};

/// Times in proportion to the numbers. The unit is the largest step that fits all of them, where most are neighbours in
/// it; else the median distance. Numbers that do not ascend, or with absurd gaps, tell no times.
/// @param name stands for the file in messages
StepTimes times_of_steps(const std::vector<std::int64_t>& numbers, const std::string& name);

}  // namespace flowskin::scenes
