#include "scenes/io/npy_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/byte_cursor.h"
#include "scenes/io/named_arrays.h"
#include "scenes/io/npy_header.h"
#include "scenes/io/number_type.h"
#include "scenes/io/particle_columns.h"
#include "scenes/io/zip_reader.h"

namespace flowskin::scenes {
namespace {

constexpr std::string_view npy_magic = "\x93NUMPY";

/// The numbers of one field of every record.
NamedArray array_of(std::string_view records, const NpyField& field, const NpyHeader& header) {
  NamedArray array{field.name, header.shape, {}, {}};
  array.shape.insert(array.shape.end(), field.shape.begin(), field.shape.end());
  const std::uint64_t per_record = field.size / size_of(field.type);
  std::string bytes;
  const std::uint64_t count = header.record_size == 0 ? 0 : records.size() / header.record_size;
  bytes.reserve(count * field.size);
  for (std::uint64_t i = 0; i < count; ++i) bytes += records.substr(i * header.record_size + field.start, field.size);
  append_numbers(bytes, field.type, field.big_endian, array.values);
  array.whole = whole_numbers(bytes, field.type, field.big_endian);
  if (header.first_index_fastest && header.shape.size() > 1 && per_record == 1) {
    array.values = last_index_fastest(array.values, header.shape);
    array.whole = last_index_fastest(array.whole, header.shape);
  }
  return array;
}

/// The arrays of a file: one, or one for each named field.
std::vector<NamedArray> arrays_of(std::string_view bytes, const std::string& name) {
  ByteCursor cursor(bytes, false, name);
  cursor.take(npy_magic.size(), "NUMPY");
  const auto version = cursor.number<std::uint8_t>("the version");
  cursor.number<std::uint8_t>("the version");
  const std::uint64_t length =
      version == 1 ? cursor.number<std::uint16_t>("the header") : cursor.number<std::uint32_t>("the header");
  const NpyHeader header = parse_npy_header(cursor.take(length, "the header"), name);
  const std::uint64_t entries = header.shape.empty() ? 1 : entries_of(header.shape);
  if (header.record_size > 0 && entries > cursor.left() / header.record_size)
    cursor.fail(fmt::format("{} entries of {} bytes are promised, but {} bytes are there: the file is truncated",
                            entries, header.record_size, cursor.left()));
  const std::string_view records = cursor.take(entries * header.record_size, "the numbers");
  std::vector<NamedArray> arrays;
  for (const NpyField& field : header.fields) arrays.push_back(array_of(records, field, header));
  return arrays;
}

void name_format(std::vector<ParticleTable>& tables, const char* format) {
  for (ParticleTable& table : tables) table.format = format;
}

}  // namespace

bool is_npy(std::string_view bytes) { return bytes.starts_with(npy_magic); }
bool is_zip(std::string_view bytes) { return bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06"); }

std::vector<ParticleTable> parse_npy(std::string_view bytes, const std::string& name) {
  std::vector<NamedArray> arrays = arrays_of(bytes, name);
  if (arrays.size() == 1 && arrays.front().name.empty()) {
    if (arrays.front().shape.size() < 2 || arrays.front().shape.size() > 3 || arrays.front().shape.back() != 3)
      throw InputError(fmt::format(
          "{}: the array has {} indices, the last of {}; expected N x 3, or steps x N x 3, or records with named "
          "fields; "
          "numpy.savez(FILE, positions=..., velocities=...) writes several arrays by their names",
          name, arrays.front().shape.size(), arrays.front().shape.empty() ? 0 : arrays.front().shape.back()));
    arrays.front().name = "positions";
  }
  std::vector<ParticleTable> tables = tables_from_arrays(arrays, name);
  name_format(tables, "NumPy");
  return tables;
}

std::vector<ParticleTable> parse_npz(std::string_view bytes, const std::string& name) {
  std::vector<NamedArray> arrays;
  bool any = false;
  std::string unread;  // the first array that holds no numbers, and why
  bool is_pickled = false;
  for_each_in_zip(bytes, name, [&](const std::string& member, std::string_view content) {
    if (!member.ends_with(".npy") || !is_npy(content)) return;
    any = true;
    const std::string key = member.substr(0, member.size() - 4);
    try {
      for (NamedArray& array : arrays_of(content, name + "/" + key)) {
        array.name = array.name.empty() ? key : array.name;
        arrays.push_back(std::move(array));
      }
    } catch (const NpyNotNumbers& error) {
      if (is_velocity_name(key)) throw InputError(error.what());  // never without a word
      is_pickled = is_pickled || std::string_view(error.what()).find("pickled") != std::string_view::npos;
      if (unread.empty()) unread = error.what();  // nobody may need it
    }
  });
  if (!any) throw InputError(name + ": this is a zip archive without NumPy arrays; unpack it and give the files in it");
  std::vector<ParticleTable> tables;
  try {
    tables = tables_from_arrays(arrays, name);
  } catch (const InputError&) {
    if (unread.empty()) throw;
    throw InputError(
        unread +
        (is_pickled
             ? ". PySPH writes such files where h5py is missing; with it (python3-h5py) it writes .hdf5, which "
               "FlowSkin "
               "reads. Or convert the file: d = pysph.solver.utils.load(FILE)['arrays']['fluid']; numpy.savez(OUT, "
               "x=d.x, y=d.y, z=d.z, u=d.u, v=d.v, w=d.w)"
             : ""));
  }
  name_format(tables, "NumPy archive");
  return tables;
}

}  // namespace flowskin::scenes
