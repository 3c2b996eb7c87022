// Scene files. What is accepted is written and read again, and is the same.
#include <cstdlib>

#include "scenes/scene_file.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return flowskin::fuzz::read(data, size, [](std::string_view bytes) {
    using namespace flowskin::scenes;
    // No file of this computer is named by chance: there is no such folder.
    const std::filesystem::path nowhere = "/nonexistent/fuzz";
    const std::string once = write_scene(parse_scene(std::string(bytes), "fuzz.json", nowhere));
    if (write_scene(parse_scene(once, "again.json", nowhere)) != once) std::abort();
  });
}
