// docs/topology.md gives the limits that the code has.

#include "tracking/repair/repair_limits.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace flowskin::tracking {
namespace {

// The first two columns of the table below "## Numbers".
std::map<std::string, std::string> documented_limits() {
  std::ifstream file(FLOWSKIN_SOURCE_DIR "/docs/topology.md");
  std::map<std::string, std::string> rows;
  std::string line;
  while (std::getline(file, line) && line != "## Numbers") continue;
  while (std::getline(file, line) && !line.starts_with("## ")) {
    std::istringstream row(line);
    std::string before, what, value;
    if (std::getline(row, before, '|') && std::getline(row, what, '|') && std::getline(row, value, '|'))
      rows[what.substr(1, what.size() - 2)] = value.substr(1, value.size() - 2);
  }
  rows.erase("what");
  std::erase_if(rows, [](const auto& row) { return row.first.starts_with("-"); });
  return rows;
}

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

template <class Values>
std::string texts(const Values& values) {
  std::string all;
  for (double value : values) all += (all.empty() ? "" : ", ") + text(value);
  return all;
}

std::map<std::string, std::string> limits_of_the_code() {
  constexpr RepairLimits limits;
  constexpr double degree = std::numbers::pi / 180;
  return {
      {"wrong side counts as deep from", text(limits.wrong_side_depth)},
      {"doubtful: mesh and field cross a grid edge farther apart than", text(limits.doubtful_crossing)},
      {"doubtful: a vertex is farther from the grid's surface than", text(limits.doubtful_distance)},
      {"too far apart: the two surfaces differ by more than", text(limits.too_far_apart)},
      {"search for a missing part or hole: distances, in this order", texts(limits.stray_distances)},
      {"search for a missing part or hole: difference of angles, in this order", texts(limits.hidden_angles)},
      {"window of that search", text(2 * limits.hidden_window + 1)},
      {"a triangle is narrow below", text(limits.narrow_angle / degree)},
      {"narrow triangles are many from", text(100 * limits.many_narrow)},
      {"around narrow triangles", text(limits.narrow_around)},
      {"parts that are counted: all above, and all above", texts(limits.counted_parts)},
      {"parts that are removed below", text(limits.dust)},
      {"parts that are compared by their true size below", text(limits.compared_on_roots)},
      {"around a replaced region, looked at again", text(limits.looked_at_again)},
      {"rounds of looking and replacing in one call", text(limits.rounds)},
      {"margin of fresh surface around a region", text(limits.margin)},
      {"a border vertex reaches the fresh surface within", text(limits.border_reach)},
      {"the patch misses a fresh vertex beyond", text(limits.missed)},
      {"evening out may move the patch by", text(limits.evened_within)},
      {"an old vertex takes the place of a new one within", text(limits.same_vertex)},
      {"smallest angle of a triangle where it does", text(limits.same_vertex_angle / degree)},
      {"attempts with frozen vertices", text(limits.freezings)},
      {"attempts to fit a region in", text(limits.attempts)},
      {"times that a place may be marked in one call", text(limits.times_marked)},
      {"a new vertex takes the id of an old one within", "1/" + text(1 / limits.same_id)},
  };
}

TEST(RepairLimits, AreThoseOfTheDocs) { EXPECT_EQ(documented_limits(), limits_of_the_code()); }

}  // namespace
}  // namespace flowskin::tracking
