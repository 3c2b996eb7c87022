// Files of several bodies in one place: fluid_0001, boundary_0001.
#pragma once

#include <string>
#include <vector>

namespace flowskin::scenes {

/// Names that are the same but for their numbers.
struct NameGroup {
  std::string pattern;             ///< With * or %d for numbers, such as fluid_*.csv; fits no name of other groups.
  std::vector<std::size_t> names;  ///< Which they are, by index.
};

/// Names by their letters or, where those are the same in all, by the one number of several that tells bodies apart:
/// whose values have the same other numbers (body0_0001, body1_0001). One group where there is no such number.
std::vector<NameGroup> groups_of_names(const std::vector<std::string>& names);

/// Whether the groups are sequences of their own, or one sequence and what does not belong to it, rather than names
/// that have an order together.
bool are_several_bodies(const std::vector<NameGroup>& groups, const std::vector<std::string>& names);

}  // namespace flowskin::scenes
