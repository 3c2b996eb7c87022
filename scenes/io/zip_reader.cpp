#include "scenes/io/zip_reader.h"

#include <fmt/format.h>

#include <cstdint>

#include "common/errors.h"
#include "scenes/io/byte_cursor.h"
#include "scenes/io/inflate.h"

namespace flowskin::scenes {
namespace {

// Signatures and sizes of the parts of an archive [PKWARE, APPNOTE 6.3, sections 4.3.7 to 4.3.16].
constexpr std::uint32_t zip_local_mark = 0x04034b50, zip_central_mark = 0x02014b50;
constexpr std::string_view zip_end_mark = "PK\x05\x06", zip_wide_end_mark = "PK\x06\x06";
constexpr std::size_t longest_zip_remark = 65535 + 22;
constexpr std::uint32_t unset_in_zip = 0xffffffff;
constexpr std::uint16_t zip_wide_sizes = 1;  // id of the extra field
constexpr std::uint16_t zip_stored = 0, zip_deflated = 8;

/// A file of the archive as its directory describes it.
struct ZipEntry {
  std::string name;
  std::uint16_t flags = 0, method = 0;
  std::uint64_t packed = 0, size = 0, start = 0;
};

class ZipReader {
 public:
  ZipReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  void read(const std::function<void(const std::string&, std::string_view)>& visit) {
    ByteCursor directory = at(place_of_directory());
    std::uint64_t unpacked = 0;
    while (directory.left() >= 4 && directory.number<std::uint32_t>("a file's entry") == zip_central_mark) {
      const ZipEntry entry = read_entry(directory);
      // Entries may share their data: what they hold together must not grow beyond what the archive can.
      unpacked += entry.packed;
      if (unpacked > bytes_.size()) fail("the files in the archive overlap");
      visit_entry(entry, visit);
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  ByteCursor at(std::uint64_t place) const {
    if (place > bytes_.size()) fail("the zip archive is truncated or damaged");
    return {bytes_.substr(static_cast<std::size_t>(place)), false, name_};
  }

  /// The directory's place stands at the end of the archive, before a remark.
  std::uint64_t place_of_directory() const {
    const std::size_t end = bytes_.rfind(zip_end_mark);
    if (end == std::string_view::npos || bytes_.size() - end > longest_zip_remark)
      fail("the zip archive has no directory at its end: it is truncated");
    ByteCursor cursor = at(end);
    cursor.take(16, "the directory's place");
    const auto place = cursor.number<std::uint32_t>("the directory's place");
    if (place != unset_in_zip) return place;
    const std::size_t wide_end = bytes_.rfind(zip_wide_end_mark, end);
    if (wide_end == std::string_view::npos) fail("the directory of the large zip archive is missing");
    ByteCursor wide = at(wide_end);
    wide.take(48, "the directory's place");
    return wide.number<std::uint64_t>("the directory's place");
  }

  static ZipEntry read_entry(ByteCursor& cursor) {
    ZipEntry entry;
    cursor.take(4, "versions");
    entry.flags = cursor.number<std::uint16_t>("flags");
    entry.method = cursor.number<std::uint16_t>("the method");
    cursor.take(8, "time and checksum");
    entry.packed = cursor.number<std::uint32_t>("a size");
    entry.size = cursor.number<std::uint32_t>("a size");
    const auto name_length = cursor.number<std::uint16_t>("a length");
    const auto extra_length = cursor.number<std::uint16_t>("a length");
    const auto remark_length = cursor.number<std::uint16_t>("a length");
    cursor.take(8, "attributes");
    entry.start = cursor.number<std::uint32_t>("a place");
    entry.name = cursor.take(name_length, "a name");
    read_wide_sizes(cursor.take(extra_length, "extra fields"), entry);
    cursor.take(remark_length, "a remark");
    return entry;
  }

  /// Sizes that do not fit 32 bits stand in an extra field, in this order.
  static void read_wide_sizes(std::string_view extra, ZipEntry& entry) {
    const std::string none;
    ByteCursor cursor(extra, false, none);
    while (cursor.left() >= 4) {
      const auto id = cursor.number<std::uint16_t>("an extra field");
      const auto length = cursor.number<std::uint16_t>("an extra field");
      if (length > cursor.left()) return;
      ByteCursor field(cursor.take(length, "an extra field"), false, none);
      if (id != zip_wide_sizes) continue;
      for (std::uint64_t* size : {&entry.size, &entry.packed, &entry.start})
        if (*size == unset_in_zip && field.left() >= 8) *size = field.number<std::uint64_t>("a size");
    }
  }

  void visit_entry(const ZipEntry& entry,
                   const std::function<void(const std::string&, std::string_view)>& visit) const {
    ByteCursor cursor = at(entry.start);
    if (cursor.number<std::uint32_t>("a file") != zip_local_mark) fail("the zip archive is damaged");
    cursor.take(22, "a file's head");
    const auto name_length = cursor.number<std::uint16_t>("a length");
    const auto extra_length = cursor.number<std::uint16_t>("a length");
    cursor.take(name_length, "a name");
    cursor.take(extra_length, "extra fields");
    const std::string_view packed = cursor.take(entry.packed, "a file's data");
    if (entry.flags & 1) fail(fmt::format("\"{}\" in the archive is encrypted", entry.name));
    if (entry.method == zip_stored) return visit(entry.name, packed);
    if (entry.method != zip_deflated)
      fail(fmt::format("\"{}\" in the archive is compressed by method {}; expected deflate", entry.name, entry.method));
    visit(entry.name, inflated(packed, entry.size, name_ + "/" + entry.name));
  }

  std::string_view bytes_;
  const std::string& name_;
};

}  // namespace

void for_each_in_zip(std::string_view bytes, const std::string& name,
                     const std::function<void(const std::string&, std::string_view)>& visit) {
  ZipReader(bytes, name).read(visit);
}

}  // namespace flowskin::scenes
