// A surface frame as OBJ, PLY and VTP.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenes/io/frames.h"

namespace flowskin::scenes {

/// frame_NNNN.obj: v, vt (one per corner, equal ones shared), vn, usemtl; `material_file` is the MTL's name beside it.
void write_surface_obj(const std::filesystem::path& file, const SurfaceFrame& frame, const std::string& material_file);
/// The MTL that all frames share; `texture_file` is the image's name relative to it.
void write_material(const std::filesystem::path& file, const std::string& texture_file);
/// Binary little-endian PLY: x y z, nx ny nz, s t, texture_u texture_v, red green blue, vx vy vz, rest_x rest_y rest_z,
/// id, and where the frame has them confidence and confidence_strong, s2 t2 texture_u2 texture_v2, texture_blend; faces
/// with a texcoord list per corner, and texcoord2 likewise.
void write_surface_ply(const std::filesystem::path& file, const SurfaceFrame& frame);
/// ParaView's PolyData, binary: point arrays Normals, TCoords, color, velocity, rest_position, id, and where the frame
/// has them confidence (weak and strong), TCoords2, texture_blend.
void write_surface_vtp(const std::filesystem::path& file, const SurfaceFrame& frame);
/// A ParaView collection: time (s) and file name, relative to the .pvd.
void write_pvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& entries);

void write_particles_ply(const std::filesystem::path& file, const ParticleFrame& frame);
void write_particles_vtp(const std::filesystem::path& file, const ParticleFrame& frame);

/// Reads back what write_surface_ply wrote (positions, rest positions, velocities, ids, triangles).
/// @throws InputError where the file is not such a surface.
tracking::SurfaceMesh read_surface_ply(const std::filesystem::path& file);
/// Gives the frame the blend weights and both sets of corner coordinates of the file, where it has them.
/// @throws InputError
void read_surface_blend(const std::filesystem::path& file, SurfaceFrame& frame);
/// Its confidences, or nothing where it has none. @throws InputError
std::vector<Vec2f> read_surface_confidence(const std::filesystem::path& file);

}  // namespace flowskin::scenes
