// Particles and surfaces in PLY files.
#include "scenes/io/frame_files.h"
#include "scenes/io/particle_columns.h"
#include "scenes/io/ply_reader.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace flowskin;

void read_surface(std::string_view bytes) {
  const fuzz::MemoryFile file(bytes);
  scenes::SurfaceFrame frame;
  frame.mesh = scenes::read_surface_ply(file.path());
  scenes::read_surface_blend(file.path(), frame);
  scenes::read_surface_confidence(file.path());
}

void read_particles(std::string_view bytes) {
  const scenes::PlyFile ply = scenes::parse_ply(bytes, "fuzz.ply");
  scenes::particles_from_table(scenes::table_from_ply(ply), "fuzz.ply");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::read(data, size, read_surface) | fuzz::read(data, size, read_particles);
}
