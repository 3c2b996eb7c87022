// Parallel loops whose results do not depend on the number of threads.
#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace flowskin {

/// A thread for every thousand things, up to OpenMP's number: waiting for each other costs small loops more than they
/// gain, most of all where other programs keep the processors busy.
inline int threads_for(std::size_t things) {
  const std::size_t wanted = std::max<std::size_t>(1, things / 1000);
  return static_cast<int>(std::min(wanted, static_cast<std::size_t>(omp_get_max_threads())));
}

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

}  // namespace flowskin
