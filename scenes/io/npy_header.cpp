#include "scenes/io/npy_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "common/number_text.h"
#include "scenes/io/named_arrays.h"

namespace flowskin::scenes {
namespace {

constexpr std::array<std::pair<std::string_view, NumberType>, 12> npy_types{{{"b1", NumberType::uint8},
                                                                             {"i1", NumberType::int8},
                                                                             {"u1", NumberType::uint8},
                                                                             {"i2", NumberType::int16},
                                                                             {"u2", NumberType::uint16},
                                                                             {"i4", NumberType::int32},
                                                                             {"u4", NumberType::uint32},
                                                                             {"i8", NumberType::int64},
                                                                             {"u8", NumberType::uint64},
                                                                             {"f2", NumberType::float16},
                                                                             {"f4", NumberType::float32},
                                                                             {"f8", NumberType::float64}}};
constexpr std::size_t most_npy_fields = 4096;
constexpr std::size_t most_npy_indices = 16;

class NpyHeaderParser {
 public:
  NpyHeaderParser(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  NpyHeader parse() {
    expect('{');
    bool has_type = false, has_shape = false;
    while (!accept('}')) {
      const std::string_view key = quoted();
      expect(':');
      if (key == "descr") {
        read_type();
        has_type = true;
      } else if (key == "shape") {
        header_.shape = shape();
        has_shape = true;
      } else if (key == "fortran_order") {
        header_.first_index_fastest = accept_word("True");
        if (!header_.first_index_fastest && !accept_word("False")) fail("expected True or False");
      } else {
        fail("expected descr, shape or fortran_order");
      }
      if (!accept(',') && !rest_.starts_with('}')) fail("expected , or }");
    }
    if (!has_type || !has_shape) fail("descr or shape is missing");
    if (header_.fields.empty()) throw NpyNotNumbers(fmt::format("{}: the array holds {}", name_, what_else()));
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw InputError(fmt::format("{}: the header of the NumPy array is damaged: {}, found \"{}\"", name_, what,
                                 rest_.substr(0, 20)));
  }
  bool accept(char c) {
    skip_space(rest_);
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    skip_space(rest_);
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail("another sign was expected");
  }
  bool accept_word(std::string_view word) {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  std::string_view quoted() {
    skip_space(rest_);
    if (!rest_.starts_with('\'') && !rest_.starts_with('"')) fail("expected a word in quotes");
    const std::size_t end = rest_.find(rest_.front(), 1);
    if (end == std::string_view::npos) fail("a quote does not end");
    const std::string_view word = rest_.substr(1, end - 1);
    rest_.remove_prefix(end + 1);
    skip_space(rest_);
    return word;
  }

  /// (3,) or (8, 3) or 3
  std::vector<std::uint64_t> shape() {
    std::vector<std::uint64_t> lengths;
    if (!accept('(')) return {whole_number()};
    while (!accept(')')) {
      if (lengths.size() == most_npy_indices) fail("too many indices");
      lengths.push_back(whole_number());
      if (!accept(',') && !rest_.starts_with(')')) fail("expected , or )");
    }
    return lengths;
  }
  std::uint64_t whole_number() {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc() || value > std::uint64_t{1} << 40) fail("expected a length");
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    accept_word("L");
    return value;
  }

  /// '<f8', or a list of fields ('x', '<f4') or ('pos', '<f4', (3,)).
  void read_type() {
    skip_space(rest_);
    if (!rest_.starts_with('[')) return add_field("", quoted(), {});
    expect('[');
    while (!accept(']')) {
      expect('(');
      const std::string_view field = quoted();
      expect(',');
      skip_space(rest_);
      if (!rest_.starts_with('\'') && !rest_.starts_with('"')) fail("fields within fields are not understood");
      const std::string_view type = quoted();
      std::vector<std::uint64_t> lengths;
      if (accept(',') && !rest_.starts_with(')')) lengths = shape();
      expect(')');
      if (header_.fields.size() == most_npy_fields) fail("too many fields");
      add_field(field, type, std::move(lengths));
      if (!accept(',') && !rest_.starts_with(']')) fail("expected , or ]");
    }
  }

  /// A type such as <f8: order of bytes, kind, size in bytes (of words: in letters).
  void add_field(std::string_view field, std::string_view type, std::vector<std::uint64_t> lengths) {
    char order = '=';
    if (!type.empty() && std::string_view("<>=|").find(type.front()) != std::string_view::npos) {
      order = type.front();
      type.remove_prefix(1);
    }
    const std::uint64_t count = lengths.empty() ? 1 : entries_of(lengths);
    const auto* found =
        std::find_if(npy_types.begin(), npy_types.end(), [&](const auto& t) { return t.first == type; });
    std::uint64_t size = 0;
    if (found != npy_types.end()) {
      size = count * size_of(found->second);
      header_.fields.push_back(
          {std::string(field), found->second, order == '>', std::move(lengths), header_.record_size, size});
    } else {
      const bool known = !type.empty() && std::string_view("OSUVMmcfg").find(type.front()) != std::string_view::npos;
      std::uint64_t letters = 0;
      if (known) std::from_chars(type.data() + 1, type.data() + type.size(), letters);
      other_kind_ = known && other_kind_ == 0 ? type.front() : other_kind_;
      if (!known || letters > std::uint64_t{1} << 30) fail("a type that is not understood");
      size = count * letters * (type.front() == 'U' ? 4 : 1) + (type.front() == 'O' ? 8 * count : 0);
    }
    header_.record_size += size;
  }

  /// Of a type that is none of the real numbers that are read.
  std::string_view what_else() const {
    switch (other_kind_) {
      case 'c':
        return "complex numbers; expected float or int: save the part that counts (array.real)";
      case 'f':
      case 'g':
        return "numbers longer than 8 bytes; expected float or int: save array.astype(float)";
      case 'M':
      case 'm':
        return "dates or durations; expected float or int";
      case 'O':
        return "pickled Python objects, which only Python can read; expected float or int: save array.astype(float)";
      default:
        return "words or raw bytes; expected float or int";
    }
  }

  std::string_view rest_;
  const std::string& name_;
  char other_kind_ = 0;  // of a type that is not read
  NpyHeader header_;
};

}  // namespace

NpyHeader parse_npy_header(std::string_view text, const std::string& name) {
  return NpyHeaderParser(text, name).parse();
}

}  // namespace flowskin::scenes
