// frames.csv: one row per frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace flowskin::tools {

/// What is known about one frame; its members are the columns of frame_columns.def.
struct FrameRow {
#define COLUMN(type, name, ...) type name{__VA_ARGS__};
#include "tools/report/frame_columns.def"

  template <class Archive>
  void visit(Archive& archive);
};

/// Calls visit(name, value) for each column, in their order.
template <class Row, class Visit>
void for_each_frame_column(Row& row, Visit visit) {
#define COLUMN(type, name, ...) visit(#name, row.name);
#include "tools/report/frame_columns.def"
}

/// The same, but columns of the comparison that was not made are empty.
template <class Visit>
void for_each_printed_column(const FrameRow& row, Visit visit) {
#define COLUMN(type, name, ...) visit(#name, row.name);
#define CHECKED_COLUMN(type, name, ...) \
  if (row.checked) {                    \
    visit(#name, row.name);             \
  } else {                              \
    visit(#name, "");                   \
  }
#include "tools/report/frame_columns.def"
}

template <class Archive>
void FrameRow::visit(Archive& archive) {
  for_each_frame_column(*this, [&](const char*, auto& value) { archive(value); });
}

/// Writes all rows, whole or not at all. @throws RunError
void write_frames_csv(const std::filesystem::path& file, const std::vector<FrameRow>& rows);

}  // namespace flowskin::tools
