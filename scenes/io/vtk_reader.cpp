#include "scenes/io/vtk_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/number_type.h"
#include "scenes/io/number_words.h"
#include "scenes/io/particle_columns.h"

namespace flowskin::scenes {
namespace {

constexpr std::array<std::pair<std::string_view, NumberType>, 23> vtk_types{{{"char", NumberType::int8},
                                                                             {"signed_char", NumberType::int8},
                                                                             {"unsigned_char", NumberType::uint8},
                                                                             {"short", NumberType::int16},
                                                                             {"unsigned_short", NumberType::uint16},
                                                                             {"int", NumberType::int32},
                                                                             {"unsigned_int", NumberType::uint32},
                                                                             {"long", NumberType::int64},
                                                                             {"unsigned_long", NumberType::uint64},
                                                                             {"long_long", NumberType::int64},
                                                                             {"unsigned_long_long", NumberType::uint64},
                                                                             {"__int64", NumberType::int64},
                                                                             {"vtktypeint8", NumberType::int8},
                                                                             {"vtktypeuint8", NumberType::uint8},
                                                                             {"vtktypeint16", NumberType::int16},
                                                                             {"vtktypeuint16", NumberType::uint16},
                                                                             {"vtktypeint32", NumberType::int32},
                                                                             {"vtktypeuint32", NumberType::uint32},
                                                                             {"vtktypeint64", NumberType::int64},
                                                                             {"vtktypeuint64", NumberType::uint64},
                                                                             {"vtkidtype", NumberType::int32},
                                                                             {"float", NumberType::float32},
                                                                             {"double", NumberType::float64}}};

/// More components than any attribute of a point has.
constexpr std::uint64_t most_components = 1024;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string lower(std::string_view word) {
  std::string result(word);
  std::transform(result.begin(), result.end(), result.begin(), [](char c) { return lower(c); });
  return result;
}

/// Names are written with %20 for a space.
std::string decoded_name(std::string_view written) {
  std::string name;
  for (std::size_t i = 0; i < written.size(); ++i) {
    unsigned value = 0;
    const char* digits = written.data() + i + 1;
    if (written[i] == '%' && i + 2 < written.size() &&
        std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
      name += static_cast<char>(value);
      i += 2;
    } else {
      name += written[i];
    }
  }
  return name;
}

class VtkParser {
 public:
  VtkParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  ParticleTable parse() {
    read_header();
    while (skip_blank()) read_section();
    if (!has_points_) fail("the file ends before its POINTS: it is truncated, or holds no points");
    table_.format = binary_ ? "VTK (binary)" : "VTK (ASCII)";
    return std::move(table_);
  }

 private:
  enum class Target { nothing, points, field };

  [[noreturn]] void fail(const std::string& message) const {
    if (binary_ && has_points_) throw InputError(fmt::format("{}, byte {}: {}", name_, at_, message));
    const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, bytes_.size()));
    throw InputError(fmt::format("{}, line {}: {}", name_, 1 + std::count(bytes_.begin(), end, '\n'), message));
  }

  bool skip_blank() {
    while (at_ < bytes_.size() && std::string_view(" \t\r\n").find(bytes_[at_]) != std::string_view::npos) ++at_;
    return at_ < bytes_.size();
  }

  std::string_view take_line() {
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string_view line = bytes_.substr(at_, end - at_);
    at_ = std::min(end + 1, bytes_.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  std::uint64_t take_count(std::string_view& line, const std::string& what) const {
    const std::string_view word = take_word(line);
    std::uint64_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (word.empty() || error != std::errc() || end != word.data() + word.size())
      fail(fmt::format("expected {} as a whole number, found \"{}\"", what, word.substr(0, 40)));
    return count;
  }

  NumberType take_type(std::string_view& line) const {
    const std::string word = lower(take_word(line));
    const auto* found =
        std::find_if(vtk_types.begin(), vtk_types.end(), [&](const auto& t) { return t.first == word; });
    if (found == vtk_types.end())
      fail(fmt::format("expected a type of numbers such as float, double or int, found \"{}\"", word.substr(0, 40)));
    return found->second;
  }

  void read_header() {
    if (!take_line().starts_with("# vtk DataFile Version")) {
      at_ = 0;
      fail("expected \"# vtk DataFile Version\"; this is no legacy VTK file");
    }
    take_line();  // the title may be anything
    const std::string_view line = take_line();
    const std::string mode = lower(line.substr(0, line.find_last_not_of(" \t") + 1));
    if (mode != "ascii" && mode != "binary")
      fail(fmt::format("the line before this one: expected ASCII or BINARY, found \"{}\"", mode.substr(0, 40)));
    binary_ = mode == "binary";
  }

  /// Arrays of words and bits, which no particle needs, are stepped over: true where it was one.
  bool skip_other_array(std::string_view line, std::uint64_t count) {
    const std::string word = lower(take_word(line));
    if (word == "bit") {
      if (binary_)
        take_bytes(count / 8 + (count % 8 != 0), 1, "bits");
      else
        take_numbers(count, 1, NumberType::uint8, "bits");
      return true;
    }
    if (word != "string" && word != "utf8_string" && word != "variant") return false;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (at_ >= bytes_.size()) fail("the file ends within an array of words: it is truncated");
      if (binary_)
        skip_binary_string();
      else
        take_line();
    }
    return true;
  }

  /// Its length in 1, 2, 4 or 8 bytes: the two highest bits tell in how many.
  void skip_binary_string() {
    const auto first = static_cast<unsigned char>(bytes_[at_]);
    const std::size_t width = std::size_t{1} << (3 - (first >> 6));
    const std::string_view head = take_bytes(width, 1, "a word's length");
    std::uint64_t length = first & 0x3f;
    for (std::size_t k = 1; k < width; ++k) length = length << 8 | static_cast<unsigned char>(head[k]);
    take_bytes(length, 1, "a word");
  }

  /// One keyword with what belongs to it.
  void read_section() {
    const std::size_t start = at_;
    std::string_view line = take_line();
    const std::string keyword = lower(take_word(line));
    if (keyword == "dataset") {
      read_dataset(line);
    } else if (keyword == "field") {
      read_field(line);
    } else if (keyword == "points") {
      read_points(line);
    } else if (keyword == "vertices" || keyword == "lines" || keyword == "polygons" || keyword == "triangle_strips" ||
               keyword == "cells") {
      read_cells(keyword, line);
    } else if (keyword == "cell_types") {
      skip_numbers(take_count(line, "the number of cells"), NumberType::int32);
    } else if (keyword == "offsets" || keyword == "connectivity") {
      skip_numbers(cell_numbers_[keyword == "connectivity"], take_type(line));
    } else if (keyword == "point_data" || keyword == "cell_data") {
      in_points_ = keyword == "point_data";
      tuples_ = take_count(line, "the number of " + std::string(in_points_ ? "points" : "cells"));
      if (in_points_ && tuples_ != table_.count)
        fail(fmt::format("POINT_DATA is for {} points, but there are {}", tuples_, table_.count));
      in_attributes_ = true;
    } else if (keyword == "metadata") {
      while (at_ < bytes_.size() && !take_line().empty()) {
      }
    } else if (keyword == "dimensions") {
      return;
    } else if (in_attributes_) {
      read_attribute(keyword, line, start);
    } else {
      at_ = start;
      fail(fmt::format("unknown keyword \"{}\"", keyword.substr(0, 40)));
    }
  }

  void read_dataset(std::string_view line) {
    const std::string kind = lower(take_word(line));
    if (kind != "polydata" && kind != "unstructured_grid" && kind != "structured_grid")
      fail(fmt::format("DATASET {}: particles are expected as POLYDATA or UNSTRUCTURED_GRID", kind.substr(0, 40)));
  }

  void read_points(std::string_view line) {
    if (has_points_) fail("a second POINTS");
    table_.count = take_count(line, "the number of points");
    const NumberType type = take_type(line);
    const std::vector<double> numbers = take_numbers(table_.count, 3, type, "points");
    has_points_ = true;
    store("", 3, numbers);
  }

  /// Cells of both file versions: 5.1 has an array of offsets and one of vertices, older ones a single array.
  void read_cells(const std::string& keyword, std::string_view line) {
    const std::uint64_t count = take_count(line, "the number of cells"), size = take_count(line, "their size");
    const std::size_t start = at_;
    std::string_view next = skip_blank() ? take_line() : std::string_view();
    const bool two_arrays = lower(take_word(next)) == "offsets";
    at_ = start;
    if (keyword == "polygons" || keyword == "triangle_strips")
      table_.polygons += two_arrays ? count - (count > 0) : count;
    if (two_arrays) {
      cell_numbers_[0] = count;
      cell_numbers_[1] = size;
    } else {
      skip_numbers(size, NumberType::int32);
    }
  }

  void read_field(std::string_view line) {
    take_word(line);
    const std::uint64_t arrays = take_count(line, "the number of arrays");
    for (std::uint64_t i = 0; i < arrays; ++i) {
      if (!skip_blank()) fail("the file ends within a FIELD: it is truncated");
      std::string_view head = take_line();
      if (lower(head) == "metadata") {  // of the array before
        while (at_ < bytes_.size() && !take_line().empty()) {
        }
        --i;
        continue;
      }
      const std::string array(take_word(head));
      const std::uint64_t components = take_count(head, "the number of components");
      const std::uint64_t tuples = take_count(head, "the number of tuples");
      if (components > most_components)
        fail(fmt::format("\"{}\" has {} components, more than any attribute", array, components));
      if (skip_other_array(head, components * std::min(tuples, std::uint64_t{1} << 50))) continue;
      read_array(array, components, tuples, take_type(head));
    }
  }

  void read_array(const std::string& array, std::uint64_t components, std::uint64_t tuples, NumberType type) {
    if (components > most_components)
      fail(fmt::format("\"{}\" has {} components, more than any attribute", array, components));
    const std::size_t start = at_;
    const std::vector<double> numbers = take_numbers(tuples, components, type, "\"" + array + "\"");
    const std::string plain = lower(array);
    if (!in_attributes_ && (plain == "time" || plain == "timevalue") && !numbers.empty()) table_.time = numbers.front();
    if (!in_attributes_ || !in_points_) return;
    if (tuples != table_.count) fail(fmt::format("\"{}\" has {} values for {} points", array, tuples, table_.count));
    const std::string name = decoded_name(array);
    if (components == 1 && is_id_name(name) && !table_.columns.contains(name)) store_ids(name, type, start);
    store(name, components, numbers);
  }

  /// Exactly, from the bytes between `start` and here.
  void store_ids(const std::string& name, NumberType type, std::size_t start) {
    const std::string_view bytes = bytes_.substr(start, at_ - start);
    std::vector<std::uint64_t> ids;
    if (binary_) {
      ids = whole_numbers(bytes, type, true);
    } else {
      std::string_view rest = bytes;
      for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
        const auto id = whole_number_of_word(word);
        if (!id) return;
        ids.push_back(*id);
      }
    }
    if (ids.size() == table_.count) table_.ids[name] = std::move(ids);
  }

  void read_attribute(const std::string& keyword, std::string_view line, std::size_t start) {
    const std::string array(take_word(line));
    if (keyword == "scalars") {
      if (lower(line).find(" bit") != std::string::npos) {
        skip_lookup_table();
        skip_other_array(line, tuples_);
        return;
      }
      const NumberType type = take_type(line);
      skip_space(line);
      const std::uint64_t components = line.empty() ? 1 : take_count(line, "the number of components");
      skip_lookup_table();
      read_array(array, components, tuples_, type);
    } else if (keyword == "vectors" || keyword == "normals") {
      read_array(array, 3, tuples_, take_type(line));
    } else if (keyword == "tensors" || keyword == "tensors6") {
      read_array(array, keyword == "tensors" ? 9 : 6, tuples_, take_type(line));
    } else if (keyword == "texture_coordinates") {
      const std::uint64_t components = take_count(line, "the dimension");
      read_array(array, components, tuples_, take_type(line));
    } else if (keyword == "global_ids" || keyword == "pedigree_ids") {
      read_array(array, 1, tuples_, take_type(line));
    } else if (keyword == "color_scalars") {
      const std::uint64_t components = take_count(line, "the number of components");
      read_array(array, components, tuples_, binary_ ? NumberType::uint8 : NumberType::float32);
    } else if (keyword == "lookup_table") {
      const std::uint64_t size = take_count(line, "the size of the table");
      take_numbers(size, 4, binary_ ? NumberType::uint8 : NumberType::float32, "the lookup table");
    } else {
      at_ = start;
      fail(fmt::format("unknown keyword \"{}\"", keyword.substr(0, 40)));
    }
  }

  void skip_lookup_table() {
    const std::size_t start = at_;
    std::string_view line = skip_blank() ? take_line() : std::string_view();
    if (lower(take_word(line)) != "lookup_table") at_ = start;
  }

  void skip_numbers(std::uint64_t count, NumberType type) {
    if (!binary_) {
      take_numbers(count, 1, type, "cells");
    } else {
      take_bytes(count, size_of(type), "cells");
    }
  }

  std::string_view take_bytes(std::uint64_t count, std::uint64_t size, const std::string& what) {
    const std::size_t left = bytes_.size() - at_;
    if (count > left / size)
      fail(
          fmt::format("{} numbers of {} are promised here, but only {} bytes are left: the file is truncated, or the "
                      "count is wrong",
                      count, what, left));
    const std::string_view taken = bytes_.substr(at_, static_cast<std::size_t>(count * size));
    at_ += taken.size();
    return taken;
  }

  std::vector<double> take_numbers(std::uint64_t tuples, std::uint64_t components, NumberType type,
                                   const std::string& what) {
    // A number takes at least two bytes as text, so that no count can ask for more memory than the file is long.
    const std::size_t left = bytes_.size() - at_;
    if (components > 0 && tuples > left / components)
      fail(fmt::format(
          "{} times {} numbers of {} are promised here, but only {} bytes are left: the file is truncated, or the "
          "count is wrong",
          tuples, components, what, left));
    const std::uint64_t count = tuples * components;
    std::vector<double> numbers;
    if (binary_) {
      append_numbers(take_bytes(count, size_of(type), what), type, true, numbers);
      return numbers;
    }
    numbers.reserve(static_cast<std::size_t>(count));
    std::string_view rest = bytes_.substr(at_);
    for (std::uint64_t i = 0; i < count; ++i) {
      double value = 0;
      skip_space(rest);
      const bool found = take_number_word(rest, value);
      at_ = bytes_.size() - rest.size();
      if (!found)
        fail(fmt::format("expected number {} of {} of {}, found \"{}\"", i + 1, count, what,
                         take_word(rest).substr(0, 40)));
      numbers.push_back(value);
    }
    return numbers;
  }

  /// Columns of an array's components; "" are the positions.
  void store(const std::string& array, std::uint64_t components, const std::vector<double>& numbers) {
    for (std::uint64_t k = 0; k < components; ++k) {
      std::string column = array;
      if (array.empty()) {
        column = std::string(1, "xyz"[k]);
      } else if (components > 1) {
        column += "_" + std::to_string(k);
      }
      std::vector<double>& values = table_.columns[column];
      if (!values.empty()) continue;  // the first one counts: an attribute called x is no position
      values.reserve(table_.count);
      for (std::size_t i = k; i < numbers.size(); i += components) values.push_back(numbers[i]);
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  bool binary_ = false, has_points_ = false;
  bool in_attributes_ = false, in_points_ = false;
  std::uint64_t tuples_ = 0;                     // of the attributes that follow
  std::array<std::uint64_t, 2> cell_numbers_{};  // how many offsets and vertices the next arrays have
  ParticleTable table_;
};

}  // namespace

ParticleTable parse_vtk(std::string_view bytes, const std::string& name) { return VtkParser(bytes, name).parse(); }

}  // namespace flowskin::scenes
