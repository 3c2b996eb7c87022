// compare.csv: one row per frame and velocity method.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace flowskin::tools {

/// How well a method does in one frame; its members are the columns of compare_columns.def.
struct CompareRow {
#define COLUMN(type, name) type name{};
#include "tools/report/compare_columns.def"
#undef COLUMN

  template <class Archive>
  void visit(Archive& archive);
};

/// Calls visit(name, value) for each column, in their order.
template <class Row, class Visit>
void for_each_compare_column(Row& row, Visit visit) {
#define COLUMN(type, name) visit(#name, row.name);
#include "tools/report/compare_columns.def"
#undef COLUMN
}

template <class Archive>
void CompareRow::visit(Archive& archive) {
  for_each_compare_column(*this, [&](const char*, auto& value) { archive(value); });
}

/// Writes all rows, whole or not at all. @throws RunError
void write_compare_csv(const std::filesystem::path& file, const std::vector<CompareRow>& rows);

}  // namespace flowskin::tools
