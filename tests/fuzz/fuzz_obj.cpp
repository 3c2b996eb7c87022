// Meshes of walls and bodies in OBJ files.
#include "scenes/io/obj_reader.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return flowskin::fuzz::read(
      data, size, [](std::string_view bytes) { flowskin::scenes::parse_obj(std::string(bytes), "fuzz.obj"); });
}
