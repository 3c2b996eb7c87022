// Collections of files (.pvd).
#include "scenes/io/vtp_reader.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return flowskin::fuzz::read(data, size,
                              [](std::string_view bytes) { flowskin::scenes::parse_pvd(bytes, "fuzz.pvd"); });
}
