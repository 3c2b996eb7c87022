#include "scenes/io/vtk_data.h"

#include <fmt/format.h>
#include <lz4.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace flowskin::scenes {
namespace {

/// zlib makes nothing smaller than to this share.
constexpr std::uint64_t largest_ratio = 1040;

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Hands out the bytes of raw or base64 text piece by piece.
class Bytes {
 public:
  Bytes(std::string_view data, bool base64) : data_(data), base64_(base64) {}

  std::string take(std::uint64_t count) {
    const std::uint64_t most = base64_ ? ready_.size() + 3 * ((data_.size() + 3) / 4) : data_.size();
    if (count > most) throw VtkDataError(fmt::format("{} bytes are promised, but at most {} are there", count, most));
    const auto wanted = static_cast<std::size_t>(count);
    if (!base64_) {
      const std::string_view taken = data_.substr(0, wanted);
      data_.remove_prefix(wanted);
      return std::string(taken);
    }
    while (ready_.size() < wanted) decode_four();
    std::string taken = ready_.substr(0, wanted);
    ready_.erase(0, wanted);
    return taken;
  }

 private:
  /// Four digits are three bytes, fewer where "=" stands for digits; after that the text may go on.
  void decode_four() {
    std::uint32_t bits = 0;
    int digits = 0, pads = 0;
    while (digits + pads < 4) {
      if (data_.empty()) throw VtkDataError("the base64 text ends too early");
      const char c = data_.front();
      data_.remove_prefix(1);
      if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
      const int digit = base64_digit(c);
      if (c == '=' && digits >= 2) {
        ++pads;
      } else if (digit < 0 || pads > 0) {
        throw VtkDataError("a character that is none of base64");
      } else {
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        ++digits;
      }
    }
    bits <<= 6 * pads;
    for (int k = 0; k < 3 - pads; ++k) ready_ += static_cast<char>(bits >> (16 - 8 * k) & 0xff);
  }

  std::string_view data_;
  bool base64_;
  std::string ready_;  // decoded, not yet taken
};

std::uint64_t take_length(Bytes& bytes, const VtkEncoding& encoding) {
  const std::size_t size = encoding.wide_header ? 8 : 4;
  const std::string raw = bytes.take(size);
  std::uint64_t length = 0;
  for (std::size_t k = 0; k < size; ++k)
    length = length << 8 | static_cast<unsigned char>(raw[encoding.big_endian ? k : size - 1 - k]);
  return length;
}

void check_size(std::uint64_t size, std::size_t expected) {
  if (size != expected) throw VtkDataError(fmt::format("the array has {} bytes, {} were expected", size, expected));
}

/// Appends what a block of zlib or LZ4 holds, `size` bytes.
void append_inflated(const std::string& packed, std::uint64_t size, VtkEncoding::Compressor compressor,
                     std::string& result) {
  const std::size_t start = result.size();
  if (size > largest_ratio * (packed.size() + 1)) throw VtkDataError("a compressed block with an impossible size");
  result.resize(start + static_cast<std::size_t>(size));
  if (compressor == VtkEncoding::Compressor::lz4) {
    constexpr std::uint64_t most = std::numeric_limits<int>::max();
    if (size > most || packed.size() > most ||
        LZ4_decompress_safe(packed.data(), result.data() + start, static_cast<int>(packed.size()),
                            static_cast<int>(size)) != static_cast<int>(size))
      throw VtkDataError("a compressed block is damaged");
    return;
  }
  uLongf length = static_cast<uLongf>(size);
  const int status = uncompress(reinterpret_cast<Bytef*>(result.data() + start), &length,
                                reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  if (status != Z_OK || length != size) throw VtkDataError("a compressed block is damaged");
}

std::string take_compressed(Bytes& bytes, const VtkEncoding& encoding, std::size_t expected) {
  const std::uint64_t blocks = take_length(bytes, encoding);
  const std::uint64_t block_size = take_length(bytes, encoding), last_size = take_length(bytes, encoding);
  const std::uint64_t whole = last_size > 0 && blocks > 0 ? blocks - 1 : blocks;
  if (blocks > expected || (whole > 0 && block_size > expected / whole))
    throw VtkDataError(
        fmt::format("{} compressed blocks of {} bytes for an array of {} bytes", blocks, block_size, expected));
  check_size(whole * block_size + (blocks > 0 ? last_size : 0), expected);
  std::vector<std::uint64_t> sizes;
  for (std::uint64_t i = 0; i < blocks; ++i) sizes.push_back(take_length(bytes, encoding));
  std::string result;
  for (std::uint64_t i = 0; i < blocks; ++i)
    append_inflated(bytes.take(sizes[i]), i < whole ? block_size : last_size, encoding.compressor, result);
  return result;
}

}  // namespace

std::string vtk_array_bytes(std::string_view data, bool base64, const VtkEncoding& encoding, std::size_t expected) {
  Bytes bytes(data, base64);
  if (encoding.compressor != VtkEncoding::Compressor::none) return take_compressed(bytes, encoding, expected);
  check_size(take_length(bytes, encoding), expected);
  return bytes.take(expected);
}

}  // namespace flowskin::scenes
