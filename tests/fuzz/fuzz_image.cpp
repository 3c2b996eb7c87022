// Textures.
#include "tests/fuzz/fuzz.h"
#include "tools/textures/image.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return flowskin::fuzz::read(data, size, [](std::string_view bytes) {
    const flowskin::fuzz::MemoryFile file(bytes);
    flowskin::tools::read_image(file.path());
  });
}
