// Particle files of any format, by what they start with; the corpus is that of tests/scenes/data/anyone. HDF5 is left
// out: libhdf5 1.10 itself reads past its heap where a file is damaged, which is not ours to mend.
#include "scenes/io/particle_file.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return flowskin::fuzz::read(data, size, [](std::string_view bytes) {
    if (bytes.find("\x89HDF\r\n\x1a\n") != std::string_view::npos) return;
    for (const auto& step : flowskin::scenes::parse_particle_steps(bytes, "fuzz"))
      flowskin::scenes::particles_of_file(step, "fuzz");
  });
}
