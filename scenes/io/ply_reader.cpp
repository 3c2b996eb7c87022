#include "scenes/io/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/number_words.h"
#include "scenes/io/particle_columns.h"
#include "scenes/io/ply_header.h"
#include "scenes/io/read_bytes.h"

namespace flowskin::scenes {
namespace {

/// What a cursor throws at the end of the data or where a number should be; the caller adds the place.
struct DataError {
  std::string what;
};

/// Values of a binary file, one after the other.
class BinaryCursor {
 public:
  BinaryCursor(std::string_view data, bool swap) : data_(data), swap_(swap) {}

  double next(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return take<std::int8_t>();
      case PlyType::uint8:
        return take<std::uint8_t>();
      case PlyType::int16:
        return take<std::int16_t>();
      case PlyType::uint16:
        return take<std::uint16_t>();
      case PlyType::int32:
        return take<std::int32_t>();
      case PlyType::uint32:
        return take<std::uint32_t>();
      case PlyType::int64:
        return static_cast<double>(take<std::int64_t>());
      case PlyType::uint64:
        return static_cast<double>(take<std::uint64_t>());
      case PlyType::float32:
        return take<float>();
      case PlyType::float64:
        break;
    }
    return take<double>();
  }

  void skip(PlyType type, std::size_t count) {
    if (count > data_.size() / size_of(type)) throw DataError{"the file ends here: it is truncated"};
    data_.remove_prefix(count * size_of(type));
  }

  /// The next value, which is a whole number of 8 bytes, as its bits.
  std::uint64_t next_whole() { return take<std::uint64_t>(); }

  /// How many elements of this kind could follow at most: what keeps an absurd count from allocating memory.
  std::uint64_t room_for(const PlyElement& element) const {
    std::size_t size = 0;
    for (const PlyProperty& property : element.properties)
      size += size_of(property.is_list ? property.count_type : property.type);
    return data_.size() / std::max<std::size_t>(size, 1);
  }

 private:
  template <class T>
  T take() {
    if (data_.size() < sizeof(T)) throw DataError{"the file ends here: it is truncated"};
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), data_.data(), sizeof(T));
    if (swap_) std::reverse(bytes.begin(), bytes.end());
    data_.remove_prefix(sizeof(T));
    return std::bit_cast<T>(bytes);
  }

  std::string_view data_;
  bool swap_;
};

/// Values of an ascii file; line ends count as white space.
class AsciiCursor {
 public:
  explicit AsciiCursor(std::string_view data) : data_(data) {}

  double next(PlyType) {
    skip_space(data_);
    if (data_.empty()) throw DataError{"the file ends here: it is truncated"};
    double value = 0;
    if (!take_number_word(data_, value))
      throw DataError{"expected a number, found \"" + std::string(take_word(data_).substr(0, 40)) + "\""};
    return value;
  }

  std::uint64_t next_whole() {
    skip_space(data_);
    if (data_.empty()) throw DataError{"the file ends here: it is truncated"};
    const std::string_view word = take_word(data_);
    const auto value = whole_number_of_word(word);
    if (!value) throw DataError{"expected a whole number, found \"" + std::string(word.substr(0, 40)) + "\""};
    return *value;
  }

  void skip(PlyType type, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) next(type);
  }

  std::uint64_t room_for(const PlyElement& element) const {
    return (data_.size() + 1) / std::max<std::size_t>(2 * element.properties.size(), 1);
  }

 private:
  std::string_view data_;
};

template <class Cursor>
std::size_t take_list_length(Cursor& cursor, const PlyProperty& property) {
  const double length = cursor.next(property.count_type);
  if (!(length >= 0) || length != std::floor(length) || length > 1e9)
    throw DataError{"the length of the list \"" + property.name + "\" is no whole number that could be right"};
  return static_cast<std::size_t>(length);
}

/// Reads the data of one file, element by element.
template <class Cursor>
class PlyDataReader {
 public:
  PlyDataReader(Cursor cursor, const std::string& name) : cursor_(cursor), name_(name) {}

  PlyFile read(const PlyHeader& header) {
    for (const PlyElement& element : header.elements) {
      if (element.properties.empty()) continue;
      if (element.count > cursor_.room_for(element))
        throw InputError(name_ + ": the header promises " + std::to_string(element.count) + " of \"" + element.name +
                         "\", but the file is too short for them: it is truncated, or the header is wrong");
      read_element(element);
    }
    check_indices();
    return std::move(ply_);
  }

 private:
  void read_element(const PlyElement& element) {
    std::uint64_t item = 0;
    try {
      if (element.name == "vertex") {
        read_vertices(element, item);
      } else {
        for (; item < element.count; ++item) read_item(element);
      }
    } catch (const DataError& error) {
      throw InputError(name_ + ", " + element.name + " " + std::to_string(item + 1) + " of " +
                       std::to_string(element.count) + ": " + error.what);
    }
  }

  void read_vertices(const PlyElement& element, std::uint64_t& item) {
    if (element.count > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
      throw DataError{"more vertices than can be counted"};
    ply_.vertex_count = static_cast<std::size_t>(element.count);
    std::vector<std::vector<double>*> columns;
    std::vector<std::vector<std::uint64_t>*> ids;
    for (const PlyProperty& property : element.properties) {
      const bool is_new = !property.is_list && !ply_.vertex.contains(property.name);
      if (!property.is_list && !is_new) ply_.repeated.insert(property.name);
      const bool is_wide = property.type == PlyType::int64 || property.type == PlyType::uint64;
      columns.push_back(is_new ? &ply_.vertex[property.name] : nullptr);
      ids.push_back(is_new && is_wide && is_id_name(property.name) ? &ply_.ids[property.name] : nullptr);
      if (columns.back() != nullptr) columns.back()->resize(ply_.vertex_count);
      if (ids.back() != nullptr) ids.back()->resize(ply_.vertex_count);
    }
    for (; item < element.count; ++item)
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        if (property.is_list) {
          cursor_.skip(property.type, take_list_length(cursor_, property));
        } else if (ids[k] != nullptr) {
          (*ids[k])[item] = cursor_.next_whole();
          (*columns[k])[item] = property.type == PlyType::int64
                                    ? static_cast<double>(static_cast<std::int64_t>((*ids[k])[item]))
                                    : static_cast<double>((*ids[k])[item]);
        } else {
          const double value = cursor_.next(property.type);
          if (columns[k] != nullptr) (*columns[k])[item] = value;
        }
      }
  }

  /// A face, or an element that nobody asked for.
  void read_item(const PlyElement& element) {
    const bool is_face = element.name == "face" || element.name == "faces";
    for (const PlyProperty& property : element.properties) {
      if (!property.is_list) {
        cursor_.skip(property.type, 1);
        continue;
      }
      const std::size_t length = take_list_length(cursor_, property);
      if (is_face && (property.name == "vertex_indices" || property.name == "vertex_index"))
        read_polygon(property, length);
      else if (is_face)
        read_face_list(property, length);
      else
        cursor_.skip(property.type, length);
    }
  }

  void read_face_list(const PlyProperty& property, std::size_t length) {
    std::vector<double>& values = ply_.face_lists[property.name];
    for (std::size_t k = 0; k < length; ++k) values.push_back(cursor_.next(property.type));
  }

  void read_polygon(const PlyProperty& property, std::size_t length) {
    if (length < 3) return cursor_.skip(property.type, length);  // a point or a line, as some programs write
    int first = 0, previous = 0;
    for (std::size_t k = 0; k < length; ++k) {
      const double value = cursor_.next(property.type);
      if (!(value >= 0) || value != std::floor(value) || value > std::numeric_limits<int>::max())
        throw DataError{"a corner is no vertex index"};
      const auto corner = static_cast<int>(value);
      if (k == 0) first = corner;
      if (k >= 2) ply_.triangles.push_back({first, previous, corner});
      previous = corner;
    }
  }

  /// Faces may stand before the vertices, so their indices are checked when all is read.
  void check_indices() {
    for (const auto& triangle : ply_.triangles)
      for (const int vertex : triangle)
        if (static_cast<std::size_t>(vertex) >= ply_.vertex_count)
          throw InputError(name_ + ": a face refers to vertex " + std::to_string(vertex) + ", but there are only " +
                           std::to_string(ply_.vertex_count) + " (counting from 0)");
  }

  Cursor cursor_;
  const std::string& name_;
  PlyFile ply_;
};

}  // namespace

PlyFile read_ply(const std::filesystem::path& file) { return parse_ply(read_bytes(file), file.string()); }

PlyFile parse_ply(std::string_view bytes, const std::string& name) {
  const PlyHeader header = parse_ply_header(bytes, name);
  const bool has_vertices = std::any_of(header.elements.begin(), header.elements.end(),
                                        [](const PlyElement& element) { return element.name == "vertex"; });
  if (!has_vertices) throw InputError(name + ": there is no element \"vertex\"");
  const std::string_view data = bytes.substr(header.data_start);
  PlyFile ply;
  if (header.format == PlyFormat::ascii) {
    ply = PlyDataReader(AsciiCursor(data), name).read(header);
  } else {
    const bool is_native = (header.format == PlyFormat::little_endian) == (std::endian::native == std::endian::little);
    ply = PlyDataReader(BinaryCursor(data, !is_native), name).read(header);
  }
  ply.comments = header.comments;
  return ply;
}

ParticleTable table_from_ply(const PlyFile& ply) {
  ParticleTable table;
  table.format = "PLY";
  table.count = ply.vertex_count;
  table.columns = ply.vertex;
  table.ids = ply.ids;
  for (const std::string& name : ply.repeated)
    note_fault(table, name, fmt::format("header: the property \"{}\" is there twice", name));
  table.polygons = ply.triangles.size();
  for (const std::string& comment : ply.comments) {
    std::string_view rest = comment;
    const std::string_view keyword = take_word(rest);
    skip_space(rest);
    double value = 0;
    if (!take_number(rest, value)) continue;
    if (keyword == "time") table.time = value;
    if (keyword == "radius" && value > 0) table.radius = value;
  }
  return table;
}

}  // namespace flowskin::scenes
