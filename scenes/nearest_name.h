// The valid name nearest to a misspelt one, for messages.
#pragma once

#include <string>
#include <vector>

namespace flowskin::scenes {

/// Number of letters to insert, leave out, change or swap with their neighbour to get from a to b, where capitals,
/// underscores, hyphens and spaces do not count.
int edit_distance(const std::string& a, const std::string& b);

/// The nearest of `names` where it is near enough to be meant (a third of the letters wrong at most), else "".
std::string nearest_name(const std::string& name, const std::vector<std::string>& names);

/// `; did you mean "viscosity"?` or "".
std::string did_you_mean(const std::string& name, const std::vector<std::string>& names);

}  // namespace flowskin::scenes
