// How many threads a loop over particles is worth.
#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>

namespace flowskin::sph {

/// A thread for every thousand particles, up to OpenMP's number: waiting for each other costs small simulations more
/// than they gain, most of all where other programs keep the processors busy. Results do not depend on it.
inline int threads_for(std::size_t particles) {
  const std::size_t wanted = std::max<std::size_t>(1, particles / 1000);
  return static_cast<int>(std::min(wanted, static_cast<std::size_t>(omp_get_max_threads())));
}

}  // namespace flowskin::sph
