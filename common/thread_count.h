// How many threads OpenMP may start.
#pragma once

namespace flowskin {

/// More than this only wait for each other, and operating systems refuse them at some number: then OpenMP ends the
/// program. At least 64, so that results can be compared at any usual number of threads.
int most_threads();

/// Sets the number of threads of all that follows: `wanted`, 0: OpenMP's own, which OMP_NUM_THREADS gives; at most
/// most_threads().
void use_threads(int wanted);

}  // namespace flowskin
