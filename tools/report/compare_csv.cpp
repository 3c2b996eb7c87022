#include "tools/report/compare_csv.h"

#include "scenes/io/atomic_file.h"
#include "tools/report/csv_text.h"

namespace flowskin::tools {

void write_compare_csv(const std::filesystem::path& file, const std::vector<CompareRow>& rows) {
  scenes::write_file(file,
                     csv_text(rows, [](const auto& row, const auto& visit) { for_each_compare_column(row, visit); }));
}

}  // namespace flowskin::tools
