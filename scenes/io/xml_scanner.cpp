#include "scenes/io/xml_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>

#include "common/errors.h"
#include "scenes/io/utf16.h"

namespace flowskin::scenes {
namespace {

constexpr std::string_view blanks = " \t\r\n";
constexpr std::string_view name_ends = " \t\r\n=/>\"'<";

/// Takes &#233; or &#xE9; off the value and puts its character to the text, in UTF-8; false where there is none.
bool take_number_entity(std::string_view& value, std::string& text) {
  constexpr std::size_t longest = 10;
  const std::size_t end = value.substr(0, longest).find(';');
  if (!value.starts_with("&#") || end == std::string_view::npos) return false;
  const bool is_hex = end > 3 && value[2] == 'x';
  const std::string_view digits = value.substr(is_hex ? 3 : 2, end - (is_hex ? 3 : 2));
  std::uint32_t letter = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), letter, is_hex ? 16 : 10);
  if (error != std::errc() || stop != digits.data() + digits.size()) return false;
  append_utf8(letter, text);
  value.remove_prefix(end + 1);
  return true;
}

/// With &amp; and its like replaced.
std::string decoded(std::string_view value) {
  constexpr std::array<std::pair<std::string_view, char>, 5> entities{
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string text;
  while (!value.empty()) {
    if (take_number_entity(value, text)) continue;
    const auto* entity =
        std::find_if(entities.begin(), entities.end(), [&](const auto& e) { return value.starts_with(e.first); });
    text += entity == entities.end() ? value.front() : entity->second;
    value.remove_prefix(entity == entities.end() ? 1 : entity->first.size());
  }
  return text;
}

}  // namespace

const std::string* XmlTag::find(std::string_view attribute) const {
  const auto found =
      std::find_if(attributes.begin(), attributes.end(), [&](const auto& a) { return a.first == attribute; });
  return found == attributes.end() ? nullptr : &found->second;
}

void XmlScanner::fail(std::size_t place, const std::string& message) const {
  const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(place, text_.size()));
  throw InputError(fmt::format("{}, line {}: {}", name_, 1 + std::count(text_.begin(), end, '\n'), message));
}

bool XmlScanner::next(XmlTag& tag) {
  for (;;) {
    at_ = text_.find('<', at_);
    if (at_ == std::string_view::npos) {
      at_ = text_.size();
      return false;
    }
    const bool comment = text_.substr(at_).starts_with("<!--");
    if (!comment && !text_.substr(at_).starts_with("<!") && !text_.substr(at_).starts_with("<?")) break;
    const std::size_t end = text_.find(comment ? "-->" : ">", at_);
    if (end == std::string_view::npos) fail(at_, "a tag that does not end: the file is truncated");
    at_ = end + 1;
  }
  tag = {};
  tag.start = at_++;
  tag.opens = true;
  if (at_ < text_.size() && text_[at_] == '/') {
    ++at_;
    tag.opens = false;
    tag.closes = true;
  }
  const std::size_t name_end = std::min(text_.find_first_of(name_ends, at_), text_.size());
  tag.name = text_.substr(at_, name_end - at_);
  at_ = name_end;
  if (tag.name.empty()) fail(tag.start, "a tag without a name");
  for (;;) {
    at_ = text_.find_first_not_of(blanks, at_);
    if (at_ == std::string_view::npos)
      fail(tag.start, "the tag <" + tag.name + "> does not end: the file is truncated");
    if (text_[at_] == '>') break;
    if (text_[at_] == '/') {
      tag.closes = true;
      ++at_;
    } else {
      read_attribute(tag);
    }
  }
  tag.end = ++at_;
  return true;
}

void XmlScanner::read_attribute(XmlTag& tag) {
  const std::size_t name_end = text_.find_first_of(name_ends, at_);
  const std::size_t equals = name_end == std::string_view::npos ? name_end : text_.find_first_not_of(blanks, name_end);
  const std::size_t quote = equals == std::string_view::npos || text_[equals] != '='
                                ? std::string_view::npos
                                : text_.find_first_not_of(blanks, equals + 1);
  if (name_end == at_ || quote == std::string_view::npos || (text_[quote] != '"' && text_[quote] != '\''))
    fail(at_, "expected an attribute NAME=\"VALUE\" in the tag <" + tag.name + ">");
  const std::size_t end = text_.find(text_[quote], quote + 1);
  if (end == std::string_view::npos) fail(at_, "an attribute without a closing quote: the file is truncated");
  tag.attributes.emplace_back(text_.substr(at_, name_end - at_), decoded(text_.substr(quote + 1, end - quote - 1)));
  at_ = end + 1;
}

}  // namespace flowskin::scenes
