// Which of many things a test holds for.
#pragma once

#include <cstddef>
#include <vector>

namespace flowskin::tracking {

/// The numbers from 0 to count - 1 for which test(number) holds, ascending. The test is called on all threads.
template <class Test>
std::vector<int> where_true(std::size_t count, const Test& test) {
  std::vector<char> holds(count);
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < std::ssize(holds); ++i) holds[i] = test(static_cast<int>(i));
  std::vector<int> found;
  for (std::size_t i = 0; i < count; ++i) {
    if (holds[i]) found.push_back(static_cast<int>(i));
  }
  return found;
}

}  // namespace flowskin::tracking
