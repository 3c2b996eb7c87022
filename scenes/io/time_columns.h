// Columns that tell time steps apart, in tables that hold many.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// What the name of a column, or of a number in a remark, says about time.
struct TimeName {
  bool is_step = false;  ///< Time steps, frames, iterations are counted; else these are times.
  bool is_sure = false;  ///< Nothing else is called so; "t" may be a temperature, "frame" that of a birth.
  double unit = 1;       ///< s; of times
};

/// Understands time, t, step, frame, iteration and the like, whatever case, signs and units: "Time [ms]", "time_s",
/// "Frame No."; empty where the name is another one.
std::optional<TimeName> time_name(const std::string& name);

/// What a table is read from.
enum class TableKind { text, arrays };

/// One table for each value of the column that tells time steps apart, in ascending order; the table itself where there
/// is none. Such a column has a name of time and values that are constant over blocks of rows, or that tell rows of the
/// same id apart; of arrays only the latter counts. Notes of the first table say which column it is, and what looks
/// like one but is not used.
std::vector<ParticleTable> steps_by_time_column(ParticleTable table, TableKind kind);

/// The column whose values tell apart the rows that have the same id, for messages; empty where there is none.
std::string column_that_separates(const ParticleTable& table, const std::vector<std::uint64_t>& ids);

}  // namespace flowskin::scenes
