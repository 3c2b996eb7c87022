#include "scenes/io/checksum.h"

#include <zlib.h>

namespace flowskin::scenes {

std::uint32_t checksum(std::uint32_t before, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<z_size_t>(bytes.size())));
}

}  // namespace flowskin::scenes
