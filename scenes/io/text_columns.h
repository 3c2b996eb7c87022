// Columns of a table that is written as text, a line a particle, words parted by blanks.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Collects rows; cells that are no numbers are faults of their columns.
class TextColumns {
 public:
  /// Columns without a name are read over.
  explicit TextColumns(const std::vector<std::string>& names);

  std::size_t size() const { return columns_.size(); }
  /// Takes a line's words. @return how many there are; a row counts only where there are as many as columns.
  std::size_t add_row(std::string_view line, std::size_t line_number);
  /// Moves what was collected into the table, which has as many particles as rows were added. Of two columns of one
  /// name the first counts.
  void move_into(ParticleTable& table);

 private:
  struct Column {
    std::string name;
    bool is_id = false;
    std::vector<double> values;
    std::vector<std::uint64_t> ids;
    std::string fault;
  };
  void add_cell(Column& column, std::string_view word, std::size_t line_number) const;

  std::vector<Column> columns_;
  std::size_t rows_ = 0;
};

}  // namespace flowskin::scenes
