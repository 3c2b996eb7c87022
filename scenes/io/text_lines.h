// Lines of a text, counted, for readers of formats in which each line has its place.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "common/errors.h"

namespace flowskin::scenes {

/// Hands out lines that end in LF, CR LF or CR. `name` stands for the file in messages and must outlive it.
class TextLines {
 public:
  TextLines(std::string_view text, const std::string& name)
      : text_(text), line_end_(text.find('\n') != text.npos ? '\n' : '\r'), name_(name) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);  // the mark that Windows programs put first
  }

  /// The next line without its end; false where there is none.
  bool next(std::string_view& line) {
    if (text_.empty()) return false;
    const std::size_t end = text_.find(line_end_);
    line = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number_;
    return true;
  }
  /// @throws InputError where there is none
  std::string_view expect(const char* what) {
    std::string_view line;
    if (!next(line))
      throw InputError(
          fmt::format("{}, line {}: {} should be here, but the file ends: it is truncated", name_, number_ + 1, what));
    return line;
  }
  /// Characters that are left.
  std::size_t left() const { return text_.size(); }
  std::size_t number() const { return number_; }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(fmt::format("{}, line {}: {}", name_, number_, message));
  }

 private:
  std::string_view text_;
  char line_end_;
  std::size_t number_ = 0;
  const std::string& name_;
};

}  // namespace flowskin::scenes
