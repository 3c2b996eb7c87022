#include "common/thread_count.h"

#include <omp.h>

#include <algorithm>

namespace flowskin {

int most_threads() { return std::max(64, 2 * omp_get_num_procs()); }

void use_threads(int wanted) {
  omp_set_num_threads(std::clamp(wanted > 0 ? wanted : omp_get_max_threads(), 1, most_threads()));
}

}  // namespace flowskin
