// Particles in VTK files.
#include "scenes/io/particle_columns.h"
#include "scenes/io/vtk_reader.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return flowskin::fuzz::read(data, size, [](std::string_view bytes) {
    flowskin::scenes::particles_from_table(flowskin::scenes::parse_vtk(bytes, "fuzz.vtk"), "fuzz.vtk");
  });
}
