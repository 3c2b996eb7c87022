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

/// Share of the ids of one frame that are there in the next.
double kept_share(const FrameRow& before, const FrameRow& row) {
  return before.vertices > 0 ? 100.0 * row.kept_ids / double(before.vertices) : 100;
}

/// What has become of the ids of the first frame that has a surface; empty where none has.
std::string first_ids_at_the_end(const std::vector<FrameRow>& rows) {
  const auto first = std::find_if(rows.begin(), rows.end(), has_surface);
  if (first == rows.end()) return "";
  return fmt::format("; {:.1f} % of the first frame's ids are there at the end",
                     100.0 * rows.back().kept_first_ids / double(first->vertices));
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
  if (std::any_of(all, rows.end(), [](const FrameRow& row) { return row.checked != 0; })) {
    const auto high_of_checked = [&](const char* format, const auto& value, const auto& badness) {
      tell(all, format, value, [&](const FrameRow& row) { return row.checked ? double(badness(row)) : -1.0; });
    };
    const auto crossings = [](const FrameRow& row) { return row.self_intersections; };
    const auto apart = [&](const FrameRow& row) { return row.hausdorff / edge_length; };
    high_of_checked("{} self-intersections", crossings, crossings);
    high_of_checked("Hausdorff {:.2f} edge lengths", apart, apart);
    high_of_checked("volume {:+.2f} %", volume_error, [](const FrameRow& row) { return std::abs(volume_error(row)); });
  }
  high("|f|/|grad f| {:.1e} m", [](const FrameRow& row) { return row.max_distance; });
  low(all, "good angles {:.2f} %", [](const FrameRow& row) { return 100 * row.good_angles; });
  low(all, "good edges {:.2f} %", [](const FrameRow& row) { return 100 * row.good_edges; });
  const auto kept = [&](const FrameRow& row) { return kept_share(rows[std::size_t(&row - rows.data()) - 1], row); };
  if (rows.size() > 1) low(all + 1, "{:.1f} % of the ids of the frame before kept", kept);
  if (text.empty()) return text;
  text += first_ids_at_the_end(rows);
  const auto checked = std::count_if(all, rows.end(), [](const FrameRow& row) { return row.checked != 0; });
  const auto differs =
      std::count_if(all, rows.end(), [](const FrameRow& row) { return row.checked && !row.same_topology; });
  text += fmt::format("; topology differs in {} of {} frames", differs, checked);
  return checked == std::ssize(rows) ? text : text + fmt::format(" that were checked, of {}", rows.size());
}

}  // namespace flowskin::tools
