#include "scenes/io/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "common/errors.h"
#include "common/number_text.h"

namespace flowskin::scenes {
namespace {

/// The names of the first PLY description, those with widths, and the 64-bit integers that some programs add.
constexpr std::array<std::pair<std::string_view, PlyType>, 18> ply_types{{{"char", PlyType::int8},
                                                                          {"int8", PlyType::int8},
                                                                          {"uchar", PlyType::uint8},
                                                                          {"uint8", PlyType::uint8},
                                                                          {"short", PlyType::int16},
                                                                          {"int16", PlyType::int16},
                                                                          {"ushort", PlyType::uint16},
                                                                          {"uint16", PlyType::uint16},
                                                                          {"int", PlyType::int32},
                                                                          {"int32", PlyType::int32},
                                                                          {"uint", PlyType::uint32},
                                                                          {"uint32", PlyType::uint32},
                                                                          {"int64", PlyType::int64},
                                                                          {"uint64", PlyType::uint64},
                                                                          {"float", PlyType::float32},
                                                                          {"float32", PlyType::float32},
                                                                          {"double", PlyType::float64},
                                                                          {"float64", PlyType::float64}}};

std::string rest_of(std::string_view line) {
  skip_space(line);
  return std::string(line);
}

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  PlyHeader parse() {
    if (take_line() != "ply") fail("a PLY file starts with the line \"ply\"");
    bool has_format = false;
    for (;;) {
      std::string_view line = take_line();
      const std::string_view keyword = take_word(line);
      if (keyword == "end_header") break;
      if (keyword == "format") {
        parse_format(line);
        has_format = true;
      } else if (keyword == "element") {
        parse_element(line);
      } else if (keyword == "property") {
        parse_property(line);
      } else if (keyword == "comment") {
        header_.comments.push_back(rest_of(line));
      } else if (keyword != "obj_info" && !keyword.empty()) {
        fail("unknown keyword \"" + std::string(keyword.substr(0, 40)) + "\"");
      }
    }
    if (!has_format) fail("the header has no line \"format\"");
    header_.data_start = at_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(name_ + ", line " + std::to_string(line_number_) + " of the header: " + message);
  }

  std::string_view take_line() {
    ++line_number_;
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) fail("the file ends before \"end_header\": it is truncated or no PLY file");
    std::string_view line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  void parse_format(std::string_view line) {
    const std::string_view format = take_word(line), version = take_word(line);
    if (format == "ascii")
      header_.format = PlyFormat::ascii;
    else if (format == "binary_little_endian")
      header_.format = PlyFormat::little_endian;
    else if (format == "binary_big_endian")
      header_.format = PlyFormat::big_endian;
    else
      fail("expected format ascii, binary_little_endian or binary_big_endian");
    if (version != "1.0") fail("expected version 1.0");
  }

  void parse_element(std::string_view line) {
    PlyElement element;
    element.name = take_word(line);
    const std::string_view count = take_word(line);
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (element.name.empty() || count.empty() || error != std::errc() || end != count.data() + count.size())
      fail("expected \"element NAME COUNT\" with a whole number as COUNT");
    for (const PlyElement& other : header_.elements)
      if (other.name == element.name) fail("a second element \"" + element.name + "\"");
    header_.elements.push_back(std::move(element));
  }

  PlyType parse_type(std::string_view word) const {
    const auto* found =
        std::find_if(ply_types.begin(), ply_types.end(), [&](const auto& t) { return t.first == word; });
    if (found == ply_types.end()) fail("unknown type \"" + std::string(word.substr(0, 40)) + "\"");
    return found->second;
  }

  void parse_property(std::string_view line) {
    if (header_.elements.empty()) fail("a property before the first element");
    PlyProperty property;
    std::string_view type = take_word(line);
    if (type == "list") {
      property.is_list = true;
      property.count_type = parse_type(take_word(line));
      type = take_word(line);
    }
    property.type = parse_type(type);
    property.name = take_word(line);
    if (property.name.empty()) fail("a property without a name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_number_ = 0;
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    default:
      return 8;
  }
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, 3) != "ply") throw InputError(name + ": this is no PLY file: it does not start with \"ply\"");
  return HeaderParser(bytes, name).parse();
}

}  // namespace flowskin::scenes
