// Who is who in two states of particles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace flowskin::tracking {

/// Calls visit(i, j) for all ids of two states, both in ascending order; -1 where the id is in the other one only.
template <class Visit>
void match_ids(const std::vector<std::uint64_t>& from, const std::vector<std::uint64_t>& to, const Visit& visit) {
  std::size_t i = 0, j = 0;
  while (i < from.size() || j < to.size()) {
    const bool in_from = i < from.size() && (j == to.size() || from[i] <= to[j]);
    const bool in_to = j < to.size() && (i == from.size() || to[j] <= from[i]);
    visit(in_from ? static_cast<std::ptrdiff_t>(i) : -1, in_to ? static_cast<std::ptrdiff_t>(j) : -1);
    i += in_from ? 1 : 0;
    j += in_to ? 1 : 0;
  }
}

}  // namespace flowskin::tracking
