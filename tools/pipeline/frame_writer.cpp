#include "tools/pipeline/frame_writer.h"

#include "scenes/io/frame_files.h"

namespace flowskin::tools {

namespace {
constexpr const char* kMaterialFile = "surface.mtl";
}  // namespace

FrameWriter::FrameWriter(const RunDirectory& directory, const scenes::OutputSpec& formats, const Image& texture)
    : directory_(directory), formats_(formats) {
  write_png(directory_.surface_folder() / kTextureFile, texture);
  if (formats_.obj) scenes::write_material(directory_.surface_folder() / kMaterialFile, kTextureFile);
}

void FrameWriter::write(int frame, const SurfaceFrame& surface) {
  if (formats_.obj) scenes::write_surface_obj(directory_.surface(frame, ".obj"), surface, kMaterialFile);
  if (formats_.ply) scenes::write_surface_ply(directory_.surface(frame, ".ply"), surface);
  if (!formats_.vtp) return;
  const auto file = directory_.surface(frame, ".vtp");
  scenes::write_surface_vtp(file, surface);
  surface_files_.emplace_back(surface.time, file.filename().string());
  scenes::write_pvd(directory_.surface_folder() / "surface.pvd", surface_files_);
}

void FrameWriter::write(int frame, const ParticleFrame& particles) {
  if (!formats_.particles) return;
  scenes::write_particles_ply(directory_.particles(frame, ".ply"), particles);
  if (!formats_.vtp) return;
  const auto file = directory_.particles(frame, ".vtp");
  scenes::write_particles_vtp(file, particles);
  particle_files_.emplace_back(particles.state.time, file.filename().string());
  scenes::write_pvd(directory_.particle_folder() / "particles.pvd", particle_files_);
}

}  // namespace flowskin::tools
