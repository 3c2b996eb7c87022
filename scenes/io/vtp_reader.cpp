#include "scenes/io/vtp_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/number_type.h"
#include "scenes/io/number_words.h"
#include "scenes/io/particle_columns.h"
#include "scenes/io/vtk_data.h"
#include "scenes/io/xml_scanner.h"

namespace flowskin::scenes {
namespace {

constexpr std::array<std::pair<std::string_view, NumberType>, 10> vtp_types{{{"Int8", NumberType::int8},
                                                                             {"UInt8", NumberType::uint8},
                                                                             {"Int16", NumberType::int16},
                                                                             {"UInt16", NumberType::uint16},
                                                                             {"Int32", NumberType::int32},
                                                                             {"UInt32", NumberType::uint32},
                                                                             {"Int64", NumberType::int64},
                                                                             {"UInt64", NumberType::uint64},
                                                                             {"Float32", NumberType::float32},
                                                                             {"Float64", NumberType::float64}}};
constexpr std::uint64_t most_vtp_components = 1024;
constexpr std::size_t most_tag_levels = 64;
/// No file of this size exists; larger counts would overflow the arithmetic below.
constexpr std::uint64_t most_points = std::uint64_t{1} << 40;

using Compressor = VtkEncoding::Compressor;

/// An array as its tag describes it.
struct Array {
  std::string name;
  NumberType type = NumberType::float32;
  std::uint64_t components = 1;
  std::string format;
  std::optional<std::uint64_t> offset;  ///< into the appended data
  std::size_t start = 0;                ///< of its tag
  std::string_view text;                ///< between its tags
};

/// The faces of a piece, as corners and the end of each face among them.
struct Polygons {
  std::uint64_t count = 0, points = 0, first_point = 0;
  std::optional<Array> corners, ends;
};

class VtpParser {
 public:
  VtpParser(std::string_view bytes, const std::string& name)
      : name_(name), head_(split_off_appended_data(bytes, name)), scanner_(head_, name) {}

  ParticleTable parse() {
    XmlTag tag;
    while (scanner_.next(tag)) {
      if (tag.opens) open(tag);
      if (tag.closes && !open_.empty() && open_.back() == tag.name) open_.pop_back();
    }
    if (!has_root_) scanner_.fail(0, "expected <VTKFile ...>; this is no VTK XML file");
    if (!has_piece_) scanner_.fail(head_.size(), "there is no <Piece> with points: the file is truncated or empty");
    if (!open_.empty())
      scanner_.fail(head_.size(), fmt::format("<{}> is never closed: the file is truncated", open_.back()));
    check_columns();
    for (const Polygons& polygons : polygons_) add_triangles(polygons);
    table_.format = fmt::format("VTK XML ({}{}{})",
                                encoding_.compressor == Compressor::none   ? ""
                                : encoding_.compressor == Compressor::zlib ? "zlib, "
                                                                           : "lz4, ",
                                encoding_.big_endian ? "big endian, " : "", formats_.empty() ? "no data" : formats_);
    return std::move(table_);
  }

 private:
  /// The data after <AppendedData> may hold any byte: it is cut off before the other tags are read.
  std::string_view split_off_appended_data(std::string_view bytes, const std::string& name) {
    XmlScanner scanner(bytes, name);
    for (XmlTag tag; scanner.next(tag);) {
      if (tag.name != "AppendedData") continue;
      if (tag.closes) scanner.fail(tag.start, "<AppendedData> has no data: the file is truncated or damaged");
      const std::string* encoding = tag.find("encoding");
      appended_base64_ = encoding == nullptr || *encoding != "raw";
      const std::size_t underscore = bytes.find('_', tag.end);
      if (underscore != std::string_view::npos) appended_ = bytes.substr(underscore + 1);
      has_appended_ = true;
      return bytes.substr(0, tag.start);
    }
    return bytes;
  }

  void open(const XmlTag& tag) {
    if (!tag.closes) open_.push_back(tag.name);
    if (open_.size() > most_tag_levels) scanner_.fail(tag.start, "tags are nested too deeply; this is no VTK XML file");
    if (tag.name == "VTKFile") {
      read_root(tag);
      if (has_appended_) open_.pop_back();  // its end was cut off with the data
    } else if (!has_root_) {
      scanner_.fail(tag.start, "expected <VTKFile ...>; this is no VTK XML file");
    } else if (tag.name == "Piece") {
      start_piece(tag);
    } else if (tag.name == "DataArray") {
      read_array(tag);
    }
  }

  bool inside(std::string_view name) const { return std::find(open_.begin(), open_.end(), name) != open_.end(); }

  void read_root(const XmlTag& tag) {
    if (has_root_) scanner_.fail(tag.start, "a second <VTKFile>: one file was expected");
    const auto value = [&tag](std::string_view name) { return tag.find(name) ? *tag.find(name) : std::string(); };
    const std::string type = value("type"), order = value("byte_order"), header = value("header_type");
    if (type.starts_with("P") && type != "PolyData")
      scanner_.fail(tag.start, type + ": this only names the files of a parallel run, which must lie beside it");
    if (type == "Collection")
      scanner_.fail(tag.start, "this is a collection of files; give it alone, with the end .pvd");
    if (type != "PolyData" && type != "UnstructuredGrid")
      scanner_.fail(tag.start,
                    fmt::format("type \"{}\": particles are expected as PolyData or UnstructuredGrid", type));
    if (order != "LittleEndian" && order != "BigEndian" && !order.empty())
      scanner_.fail(tag.start, "byte_order: expected LittleEndian or BigEndian");
    if (header != "UInt32" && header != "UInt64" && !header.empty())
      scanner_.fail(tag.start, "header_type: expected UInt32 or UInt64");
    const std::string compressor = value("compressor");
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor" && compressor != "vtkLZ4DataCompressor")
      scanner_.fail(tag.start, compressor +
                                   " is not supported; write the file with zlib, lz4 or without compression "
                                   "(ParaView: Compressor Type in the dialogue of Save Data)");
    if (tag.closes) scanner_.fail(tag.start, "<VTKFile> closes itself: there are no particles in it");
    encoding_ = {order == "BigEndian", header == "UInt64",
                 compressor.empty()                     ? Compressor::none
                 : compressor == "vtkLZ4DataCompressor" ? Compressor::lz4
                                                        : Compressor::zlib};
    has_root_ = true;
  }

  std::uint64_t count_of(const XmlTag& tag, std::string_view attribute, std::uint64_t fallback,
                         std::uint64_t most) const {
    const std::string* text = tag.find(attribute);
    if (text == nullptr) return fallback;
    std::uint64_t count = 0;
    std::string_view digits = *text;
    skip_space(digits);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
    if (error != std::errc() || count > most)
      scanner_.fail(tag.start,
                    fmt::format("{}=\"{}\": expected a whole number up to {}", attribute, text->substr(0, 40), most));
    return count;
  }

  void start_piece(const XmlTag& tag) {
    piece_points_ = count_of(tag, "NumberOfPoints", 0, most_points);
    table_.count += static_cast<std::size_t>(piece_points_);
    table_.polygons += static_cast<std::size_t>(count_of(tag, "NumberOfPolys", 0, most_points) +
                                                count_of(tag, "NumberOfStrips", 0, most_points));
    polygons_.push_back({count_of(tag, "NumberOfPolys", 0, most_points), piece_points_,
                         table_.count - static_cast<std::size_t>(piece_points_), std::nullopt, std::nullopt});
    has_piece_ = true;
  }

  /// Cuts polygons into fans.
  void add_triangles(const Polygons& polygons) {
    if (polygons.count == 0 || !polygons.corners || !polygons.ends) return;
    const std::vector<double> ends = numbers_of(*polygons.ends, polygons.count);
    const double corner_count = ends.back();
    if (!(corner_count >= 0 && corner_count <= static_cast<double>(most_points)))
      scanner_.fail(polygons.ends->start, "the faces of the mesh end nowhere");
    const std::vector<double> corners = numbers_of(*polygons.corners, static_cast<std::uint64_t>(corner_count));
    std::size_t start = 0;
    for (const double face_end : ends) {
      if (!(face_end >= static_cast<double>(start) && face_end <= corner_count))
        scanner_.fail(polygons.ends->start, "the faces of the mesh overlap");
      const auto end = static_cast<std::size_t>(face_end);
      const auto corner = [&](std::size_t place) {
        const double index = corners[place];
        if (!(index >= 0 && index < static_cast<double>(polygons.points)))
          scanner_.fail(polygons.corners->start, fmt::format("a face has the corner {}, which is no point", index));
        return static_cast<int>(polygons.first_point + static_cast<std::uint64_t>(index));
      };
      for (std::size_t k = start + 1; k + 1 < end; ++k)
        table_.triangles.push_back({corner(start), corner(k), corner(k + 1)});
      start = end;
    }
  }

  Array described(const XmlTag& tag) const {
    Array array;
    array.start = tag.start;
    if (const std::string* name = tag.find("Name")) array.name = *name;
    const std::string* type = tag.find("type");
    const auto* found = std::find_if(vtp_types.begin(), vtp_types.end(),
                                     [&](const auto& t) { return type != nullptr && t.first == *type; });
    if (found == vtp_types.end())
      scanner_.fail(tag.start, fmt::format("the array \"{}\" has the type \"{}\"; expected Float32, Int64 or the like",
                                           array.name, type ? type->substr(0, 40) : ""));
    array.type = found->second;
    array.components = count_of(tag, "NumberOfComponents", 1, most_vtp_components);
    const std::string* format = tag.find("format");
    array.format = format ? *format : "ascii";
    if (tag.find("offset")) array.offset = count_of(tag, "offset", 0, std::uint64_t{1} << 62);
    if (!tag.closes) {
      const std::size_t end = std::min(head_.find('<', tag.end), head_.size());
      array.text = head_.substr(tag.end, end - tag.end);
    }
    return array;
  }

  void read_array(const XmlTag& tag) {
    const std::string* type = tag.find("type");
    if (type && *type == "String") return;
    const std::string* name = tag.find("Name");
    if (inside("FieldData") && name && (*name == "TimeValue" || *name == "TIME" || *name == "Time")) {
      const std::vector<double> time = numbers_of(described(tag), 1);
      if (!time.empty()) table_.time = time.front();
    } else if (inside("Points")) {
      Array points = described(tag);
      if (points.components != 3) scanner_.fail(tag.start, "points need 3 components");
      add_columns(points, {"x", "y", "z"});
    } else if (inside("PointData")) {
      read_attribute(tag);
    } else if (inside("Polys") && name && !polygons_.empty()) {
      if (*name == "connectivity") polygons_.back().corners = described(tag);
      if (*name == "offsets") polygons_.back().ends = described(tag);
    }
  }

  /// What is wrong with an attribute only stops who needs it.
  void read_attribute(const XmlTag& tag) {
    Array array;
    try {
      array = described(tag);
    } catch (const InputError& error) {
      const std::string* name = tag.find("Name");
      if (name != nullptr) note_fault(table_, *name, without_file(error.what()));
      return;
    }
    std::vector<std::string> columns;
    for (std::uint64_t k = 0; k < array.components; ++k)
      columns.push_back(array.components == 1 ? array.name : array.name + "_" + std::to_string(k));
    try {
      if (array.components == 1 && is_id_name(array.name)) add_ids(array);
      add_columns(array, columns);
    } catch (const InputError& error) {
      for (const std::string& column : columns) {
        note_fault(table_, column, without_file(error.what()));
        table_.columns.try_emplace(column);  // check_columns fills it up, when so many points turn out to be there
      }
    }
  }

  /// Faults are told with the name of the file in front.
  std::string without_file(const std::string& message) const {
    return message.starts_with(name_ + ", ") ? message.substr(name_.size() + 2) : message;
  }

  void add_columns(const Array& array, const std::vector<std::string>& columns) {
    const std::vector<double> numbers = numbers_of(array, piece_points_ * array.components);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      std::vector<double>& values = table_.columns[columns[k]];
      // The first array of a name counts: an attribute called x is no position.
      if (values.size() + piece_points_ > table_.count) continue;
      for (std::size_t i = k; i < numbers.size(); i += columns.size()) values.push_back(numbers[i]);
    }
  }

  /// The array's numbers. @throws InputError where there are not `count`.
  std::vector<double> numbers_of(const Array& array, std::uint64_t count) {
    if (formats_.find(array.format) == std::string::npos) formats_ += (formats_.empty() ? "" : ", ") + array.format;
    const auto fail = [&](const std::string& message) {
      scanner_.fail(array.start, fmt::format("the array \"{}\": {}", array.name, message));
    };
    std::vector<double> numbers;
    if (count == 0) return numbers;
    if (array.format == "ascii") {
      std::string_view rest = array.text;
      for (std::uint64_t i = 0; i < count; ++i) {
        double value = 0;
        skip_space(rest);
        if (!take_number_word(rest, value))
          fail(fmt::format("expected number {} of {}, found \"{}\"", i + 1, count, take_word(rest).substr(0, 40)));
        numbers.push_back(value);
      }
      return numbers;
    }
    append_numbers(bytes_of(array, count), array.type, encoding_.big_endian, numbers);
    return numbers;
  }

  /// The bytes of an array that is not written as text.
  std::string bytes_of(const Array& array, std::uint64_t count) {
    const auto fail = [&](const std::string& message) {
      scanner_.fail(array.start, fmt::format("the array \"{}\": {}", array.name, message));
    };
    std::string_view data = array.text;
    bool base64 = true;
    if (array.format == "appended") {
      if (!has_appended_ || !array.offset || *array.offset > appended_.size())
        fail("its data is not in the file: the file is truncated, or its offset is wrong");
      data = appended_.substr(static_cast<std::size_t>(*array.offset));
      base64 = appended_base64_;
    } else if (array.format != "binary") {
      fail(fmt::format("format \"{}\": expected ascii, binary or appended", array.format.substr(0, 40)));
    }
    try {
      return vtk_array_bytes(data, base64, encoding_, static_cast<std::size_t>(count * size_of(array.type)));
    } catch (const VtkDataError& error) {
      fail(error.what());
    }
    return {};
  }

  /// Exact values of ids of this piece, where they are whole numbers.
  void add_ids(const Array& array) {
    std::vector<std::uint64_t>& ids = table_.ids[array.name];
    if (ids.size() + piece_points_ != table_.count || piece_points_ == 0) return;
    if (array.format != "ascii") {
      const std::vector<std::uint64_t> more =
          whole_numbers(bytes_of(array, piece_points_), array.type, encoding_.big_endian);
      ids.insert(ids.end(), more.begin(), more.end());
      return;
    }
    std::string_view rest = array.text;
    for (std::uint64_t i = 0; i < piece_points_; ++i) {
      const auto id = whole_number_of_word(take_word(rest));
      if (!id) return;
      ids.push_back(*id);
    }
  }

  /// An array that only some pieces have is of no use to anyone.
  void check_columns() {
    for (const char* axis : {"x", "y", "z"})
      if (table_.columns[axis].size() != table_.count)
        scanner_.fail(head_.size(), "a <Piece> without <Points>: the file is truncated or damaged");
    for (auto& [name, values] : table_.columns) {
      if (values.size() == table_.count) continue;
      note_fault(table_, name, fmt::format("the array \"{}\" is not in every <Piece>", name));
      values.resize(table_.count, std::nan(""));
    }
    std::erase_if(table_.ids, [this](const auto& ids) { return ids.second.size() != table_.count; });
  }

  const std::string& name_;
  std::string_view appended_;
  bool has_appended_ = false, appended_base64_ = false;
  std::string_view head_;
  XmlScanner scanner_;
  std::vector<std::string> open_;  // tags around the present place
  bool has_root_ = false, has_piece_ = false;
  VtkEncoding encoding_;
  std::uint64_t piece_points_ = 0;
  std::vector<Polygons> polygons_;
  std::string formats_;
  ParticleTable table_;
};

}  // namespace

ParticleTable parse_vtp(std::string_view bytes, const std::string& name) { return VtpParser(bytes, name).parse(); }

namespace {

using PvdEntry = std::pair<double, std::filesystem::path>;

/// Whether a path starts at the root, of a drive of Windows perhaps.
bool starts_at_root(const std::string& path) {
  return path.starts_with('/') || (path.size() > 2 && path[1] == ':' && path[2] == '/');
}

/// A name in a file that names others; those of Windows have \ between folders. Paths from the root of another computer
/// are looked for beside the file, with as many of their folders as are there.
std::filesystem::path path_beside(std::string entry, const std::filesystem::path& file) {
  std::error_code error;
  const auto found = [&] { return file.parent_path() / entry; };
  if (std::filesystem::exists(found(), error)) return found();
  std::replace(entry.begin(), entry.end(), '\\', '/');
  if (!starts_at_root(entry) || std::filesystem::exists(found(), error)) return found();
  const std::filesystem::path as_it_stands = found();
  const bool of_windows = !entry.starts_with('/');
  while (entry.find('/') != std::string::npos) {
    entry.erase(0, entry.find('/') + 1);
    if (std::filesystem::exists(found(), error)) return found();
  }
  return of_windows ? found() : as_it_stands;
}

PvdEntry entry_of(const XmlTag& tag, const std::filesystem::path& file, const XmlScanner& scanner) {
  const std::string *time = tag.find("timestep"), *entry = tag.find("file");
  double value = 0;
  std::string_view rest = time ? std::string_view(*time) : std::string_view();
  skip_space(rest);
  const bool is_number = take_number(rest, value);
  skip_space(rest);
  if (entry == nullptr || entry->empty() || !is_number || !rest.empty())
    scanner.fail(tag.start, "expected <DataSet timestep=\"TIME\" file=\"NAME\"/>");
  if (!std::isfinite(value))
    scanner.fail(tag.start, fmt::format("timestep=\"{}\": the time is not finite", time->substr(0, 40)));
  if (entry->find('\0') != std::string::npos) scanner.fail(tag.start, "the name of the file has a zero byte");
  return {value, path_beside(*entry, file)};
}

}  // namespace

std::vector<PvdEntry> parse_pvd(std::string_view bytes, const std::filesystem::path& file) {
  const std::string name = file.string();
  XmlScanner scanner(bytes, name);
  std::vector<PvdEntry> entries;
  std::vector<std::string> open;
  bool is_collection = false;
  for (XmlTag tag; scanner.next(tag);) {
    if (tag.opens && tag.name == "Collection") is_collection = true;
    if (tag.opens && tag.name == "DataSet") {
      if (!is_collection) scanner.fail(tag.start, "a <DataSet> before <Collection>; this is no ParaView collection");
      entries.push_back(entry_of(tag, file, scanner));
    }
    if (tag.opens && !tag.closes) open.push_back(tag.name);
    if (tag.closes && !tag.opens && !open.empty() && open.back() == tag.name) open.pop_back();
    if (open.size() > most_tag_levels) scanner.fail(tag.start, "tags are nested too deeply");
  }
  if (!is_collection) scanner.fail(0, "expected <Collection>; this is no ParaView collection");
  if (!open.empty())
    scanner.fail(bytes.size(), fmt::format("<{}> is never closed: the file is truncated", open.back()));
  if (entries.empty()) scanner.fail(bytes.size(), "the collection names no files");
  return entries;
}

std::vector<std::filesystem::path> pieces_of_vtk(std::string_view bytes, const std::filesystem::path& file) {
  const std::string_view start = bytes.substr(0, 4096);
  if (start.find("\"PPolyData\"") == start.npos && start.find("\"PUnstructuredGrid\"") == start.npos) return {};
  const std::string name = file.string();
  XmlScanner scanner(bytes, name);
  std::vector<std::filesystem::path> pieces;
  bool is_whole = false;
  for (XmlTag tag; scanner.next(tag);) {
    if (tag.closes && tag.name == "VTKFile") is_whole = true;
    if (!tag.opens || tag.name != "Piece") continue;
    const std::string* source = tag.find("Source");
    if (source == nullptr || source->empty() || source->find('\0') != std::string::npos)
      scanner.fail(tag.start, "expected <Piece Source=\"NAME\"/>");
    pieces.push_back(path_beside(*source, file));
  }
  if (!is_whole) scanner.fail(bytes.size(), "<VTKFile> is never closed: the file is truncated");
  if (pieces.empty()) scanner.fail(bytes.size(), "there is no <Piece>: no file is named");
  return pieces;
}

}  // namespace flowskin::scenes
