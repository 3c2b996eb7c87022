#include "tools/report/worst_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flowskin::tools {

namespace {

bool has_surface(const FrameRow& row) { return row.vertices > 0; }

double volume_error(const FrameRow& row) {
  return row.volume == row.expected_volume ? 0 : 100 * (row.volume / row.expected_volume - 1);
}

}  // namespace

std::string worst_frames(const std::vector<FrameRow>& rows, double edge_length) {
  std::string text;
  // The first frame for which `badness` is largest; its `value` is told.
  const auto tell = [&](auto first, const char* format, const auto& value, const auto& badness) {
    const auto worse = [&](const FrameRow& a, const FrameRow& b) {
      return has_surface(a) != has_surface(b) ? has_surface(b) : badness(a) < badness(b);
    };
    const auto worst = std::max_element(first, rows.end(), worse);
    if (worst == rows.end() || !has_surface(*worst)) return;
    text += (text.empty() ? "worst frames: " : ", ") + fmt::format(fmt::runtime(format), value(*worst)) +
            fmt::format(" ({})", worst->frame);
  };
  const auto all = rows.begin();
  const auto high = [&](const char* format, const auto& value) { tell(all, format, value, value); };
  const auto low = [&](auto first, const char* format, const auto& value) {
    tell(first, format, value, [&](const FrameRow& row) { return -value(row); });
  };
  high("{} self-intersections", [](const FrameRow& row) { return row.self_intersections; });
  high("Hausdorff {:.2f} edge lengths", [&](const FrameRow& row) { return row.hausdorff / edge_length; });
  tell(all, "volume {:+.2f} %", volume_error, [](const FrameRow& row) { return std::abs(volume_error(row)); });
  high("|f|/|grad f| {:.1e} m", [](const FrameRow& row) { return row.max_distance; });
  low(all, "good angles {:.2f} %", [](const FrameRow& row) { return 100 * row.good_angles; });
  low(all, "good edges {:.2f} %", [](const FrameRow& row) { return 100 * row.good_edges; });
  if (rows.size() > 1)
    low(all + 1, "ids kept {:.1f} %", [](const FrameRow& row) { return 100.0 * row.kept_ids / double(row.vertices); });
  if (text.empty()) return text;
  const auto differs = std::count_if(rows.begin(), rows.end(), [](const FrameRow& row) { return !row.same_topology; });
  return text + fmt::format("; topology differs in {} of {} frames", differs, rows.size());
}

}  // namespace flowskin::tools
