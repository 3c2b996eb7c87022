#include "tools/report/frames_csv.h"

#include <string>

#include "scenes/io/atomic_file.h"
#include "tools/report/csv_text.h"

namespace flowskin::tools {

void write_frames_csv(const std::filesystem::path& file, const std::vector<FrameRow>& rows) {
  scenes::write_file(file,
                     csv_text(rows, [](const auto& row, const auto& visit) { for_each_printed_column(row, visit); }));
}

}  // namespace flowskin::tools
