#include "scenes/nearest_name.h"

#include <algorithm>
#include <cstddef>

namespace flowskin::scenes {
namespace {

std::string simplified(const std::string& name) {
  std::string letters;
  for (const char c : name) {
    if (c == '_' || c == '-' || c == ' ') continue;
    letters += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return letters;
}

}  // namespace

int edit_distance(const std::string& a, const std::string& b) {
  const std::string s = simplified(a), t = simplified(b);
  // Rows of the dynamic programming table for the prefixes of s with i - 2, i - 1 and i letters.
  std::vector<int> before(t.size() + 1), last(t.size() + 1), row(t.size() + 1);
  for (std::size_t j = 0; j <= t.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= s.size(); ++i) {
    before = last;
    last = row;
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= t.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (s[i - 1] == t[j - 1] ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && s[i - 1] == t[j - 2] && s[i - 2] == t[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[t.size()];
}

std::string nearest_name(const std::string& name, const std::vector<std::string>& names) {
  if (name.size() > 100) return "";
  std::string best;
  int best_distance = std::max(1, static_cast<int>(name.size()) / 3);
  for (const std::string& candidate : names) {
    const int distance = edit_distance(name, candidate);
    if (distance < best_distance || (distance == best_distance && best.empty())) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(name, names);
  return nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?";
}

}  // namespace flowskin::scenes
