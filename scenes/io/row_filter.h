// Which particles of a table are wanted, by an expression of its columns.
#pragma once

#include <string>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// For each particle whether the expression holds, such as "Type == 1 and (z > 0.5 or not vx < 0)". Columns are named
/// as in the file, in quotes where they hold blanks; comparisons of columns and numbers, in any order, are == != < <= >
/// >= and may follow one another (0 < x < 1); && || ! are and, or, not.
/// @param name stands for the file in messages
/// @throws InputError where the expression is none, or a column is not there or at fault.
std::vector<char> rows_that(const std::string& expression, const ParticleTable& table, const std::string& name);

/// The particles of these rows only.
ParticleTable rows_of(const ParticleTable& table, const std::vector<char>& wanted);

}  // namespace flowskin::scenes
