#include "scenes/io/inflate.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>

#include "common/errors.h"

namespace flowskin::scenes {
namespace {

constexpr int gzip_window = 15 + 16, raw_window = -15;
/// No numbers shrink more than this; what does is there to fill the memory.
constexpr std::uint64_t largest_inflation = 400;
/// Of small files, in bytes.
constexpr std::uint64_t always_inflated = 1 << 20;
constexpr std::size_t inflate_block = 1 << 18;

/// zlib's state, freed at the end.
class Inflater {
 public:
  Inflater(std::string_view bytes, int window, const std::string& name) : rest_(bytes), name_(name) {
    if (inflateInit2(&stream_, window) != Z_OK) fail("zlib cannot be started: there is too little memory");
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream_); }

  /// Appends what one member holds. @throws InputError where `result` would be longer than `most`.
  void append_member(std::string& result, std::uint64_t most) {
    int status = Z_OK;
    while (status != Z_STREAM_END) {
      const std::size_t start = result.size(), room = std::min<std::uint64_t>(inflate_block, most + 1 - start);
      result.resize(start + room);
      stream_.next_out = reinterpret_cast<Bytef*>(result.data() + start);
      stream_.avail_out = static_cast<uInt>(room);
      status = step();
      result.resize(start + room - stream_.avail_out);
      if (status != Z_OK && status != Z_STREAM_END)
        fail(status == Z_BUF_ERROR ? "the compressed data end too early: the file is truncated"
                                   : "the compressed data are damaged");
      if (result.size() > most) fail(fmt::format("holds more than {} bytes, which cannot be meant", most));
    }
  }

  std::string_view rest() const { return rest_; }
  void restart() { inflateReset(&stream_); }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  int step() {
    const auto given = static_cast<uInt>(std::min<std::size_t>(rest_.size(), std::numeric_limits<uInt>::max()));
    // zlib does not write to its input.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));
    stream_.avail_in = given;
    const int status = inflate(&stream_, Z_NO_FLUSH);
    rest_.remove_prefix(given - stream_.avail_in);
    return status;
  }

  z_stream stream_{};
  std::string_view rest_;
  const std::string& name_;
};

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b\x08"); }

std::string gunzipped(std::string_view bytes, const std::string& name) {
  const std::uint64_t most = always_inflated + largest_inflation * bytes.size();
  Inflater inflater(bytes, gzip_window, name);
  std::string result;
  inflater.append_member(result, most);
  // Whole files may follow; what else stands behind (zeros to fill a block) is left out, as gzip does.
  while (is_gzip(inflater.rest())) {
    inflater.restart();
    inflater.append_member(result, most);
  }
  return result;
}

std::string inflated(std::string_view bytes, std::uint64_t size, const std::string& name) {
  if (size > always_inflated + largest_inflation * bytes.size())
    throw InputError(fmt::format("{}: {} bytes cannot hold the {} that are promised", name, bytes.size(), size));
  Inflater inflater(bytes, raw_window, name);
  std::string result;
  inflater.append_member(result, size);
  if (result.size() != size)
    throw InputError(fmt::format("{}: holds {} bytes, {} were promised", name, result.size(), size));
  return result;
}

}  // namespace flowskin::scenes
