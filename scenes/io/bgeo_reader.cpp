#include "scenes/io/bgeo_reader.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "scenes/io/byte_cursor.h"
#include "scenes/io/number_type.h"
#include "scenes/io/particle_columns.h"

namespace flowskin::scenes {
namespace {

constexpr std::string_view bgeo_magic = "BgeoV";
constexpr std::int32_t bgeo_version = 5;
constexpr std::int32_t most_bgeo_attributes = 4096;
constexpr std::size_t bgeo_number_size = 4;
constexpr std::size_t bgeo_position_numbers = 4;  // x, y, z, w

/// Numbers in which the file says what an attribute is.
enum BgeoKind { floats = 0, integers = 1, text = 2, indices = 4, vector = 5 };

struct BgeoAttribute {
  std::string name;
  std::size_t size = 0;  // numbers a point
  std::int32_t kind = floats;
  std::size_t start = 0;  // in numbers from the start of a point
};

class BgeoParser {
 public:
  BgeoParser(std::string_view bytes, const std::string& name) : cursor_(bytes, true, name) {}

  ParticleTable parse() {
    read_head();
    std::size_t width = bgeo_position_numbers;
    for (BgeoAttribute& attribute : attributes_) {
      read_attribute(attribute);
      attribute.start = width;
      width += attribute.size;
    }
    const std::size_t width_in_bytes = width * bgeo_number_size;
    if (table_.count > cursor_.left() / width_in_bytes)
      cursor_.fail(fmt::format("{} points are promised, but {} bytes of points are there: the file is truncated",
                               table_.count, cursor_.left()));
    points_ = cursor_.take(table_.count * width_in_bytes, "the points");
    for (const std::size_t k : {0, 1, 2})
      table_.columns[std::string(1, "xyz"[k])] = numbers(k, width, NumberType::float32);
    for (const BgeoAttribute& attribute : attributes_) add_attribute(attribute, width);
    table_.format = "BGEO";
    return std::move(table_);
  }

 private:
  void read_head() {
    cursor_.take(bgeo_magic.size(), "BgeoV");
    if (const auto version = cursor_.number<std::int32_t>("the version"); version != bgeo_version)
      cursor_.fail(fmt::format("version {} of the format; expected {}", version, bgeo_version));
    const auto points = cursor_.number<std::int32_t>("the number of points");
    const auto primitives = cursor_.number<std::int32_t>("the number of primitives");
    cursor_.number<std::int32_t>("the number of groups of points");
    cursor_.number<std::int32_t>("the number of groups of primitives");
    const auto attributes = cursor_.number<std::int32_t>("the number of attributes of points");
    cursor_.take(3 * bgeo_number_size, "the numbers of other attributes");
    if (points < 0 || primitives < 0 || attributes < 0 || attributes > most_bgeo_attributes)
      cursor_.fail(fmt::format("{} points, {} primitives and {} attributes: the file is damaged", points, primitives,
                               attributes));
    table_.count = static_cast<std::size_t>(points);
    attributes_.resize(static_cast<std::size_t>(attributes));
  }

  void read_attribute(BgeoAttribute& attribute) {
    attribute.name = cursor_.take(cursor_.number<std::uint16_t>("the length of a name"), "a name");
    attribute.size = cursor_.number<std::uint16_t>("the size of an attribute");
    attribute.kind = cursor_.number<std::int32_t>("the kind of an attribute");
    switch (attribute.kind) {
      case floats:
      case integers:
      case vector:
        cursor_.take(attribute.size * bgeo_number_size, "the default of an attribute");
        return;
      case indices: {
        const auto words = cursor_.number<std::int32_t>("the number of words of an attribute");
        for (std::int32_t k = 0; k < words; ++k)
          cursor_.take(cursor_.number<std::uint16_t>("the length of a word"), "a word");
        return;
      }
      default:
        cursor_.fail(
            fmt::format("the attribute \"{}\" is of kind {}, which is not understood; expected numbers, "
                        "vectors or words (leave it out: Attribute Delete in Houdini)",
                        attribute.name.substr(0, 40), attribute.kind));
    }
  }

  /// The same 4 bytes of each point.
  std::string bytes_at(std::size_t start, std::size_t width) const {
    std::string bytes;
    bytes.reserve(table_.count * bgeo_number_size);
    for (std::size_t i = 0; i < table_.count; ++i)
      bytes += points_.substr((i * width + start) * bgeo_number_size, bgeo_number_size);
    return bytes;
  }

  std::vector<double> numbers(std::size_t start, std::size_t width, NumberType type) const {
    std::vector<double> result;
    append_numbers(bytes_at(start, width), type, true, result);
    return result;
  }

  /// The first attribute of a name counts: one called x is no position.
  void add_attribute(const BgeoAttribute& attribute, std::size_t width) {
    const bool whole = attribute.kind == integers || attribute.kind == indices;
    const NumberType type = whole ? NumberType::int32 : NumberType::float32;
    for (std::size_t k = 0; k < attribute.size; ++k) {
      const std::string column = attribute.size == 1 ? attribute.name : fmt::format("{}_{}", attribute.name, k);
      if (table_.columns.size() > most_bgeo_attributes || table_.columns.contains(column)) continue;
      table_.columns[column] = numbers(attribute.start + k, width, type);
      if (whole && is_id_name(column))
        table_.ids[column] = whole_numbers(bytes_at(attribute.start + k, width), type, true);
    }
  }

  ByteCursor cursor_;
  std::vector<BgeoAttribute> attributes_;
  std::string_view points_;
  ParticleTable table_;
};

}  // namespace

bool is_bgeo(std::string_view bytes) { return bytes.starts_with(bgeo_magic); }

ParticleTable parse_bgeo(std::string_view bytes, const std::string& name) { return BgeoParser(bytes, name).parse(); }

}  // namespace flowskin::scenes
