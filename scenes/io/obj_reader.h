// Reads triangle meshes from OBJ files (tinyobjloader).
#pragma once

#include <filesystem>
#include <string>

#include "scenes/scene.h"

namespace flowskin::scenes {

/// Polygons are triangulated; unreferenced vertices are dropped.
/// @throws InputError naming the file and what is wrong with it (missing, no triangles, bad index, not finite).
sph::TriangleMesh read_obj(const std::filesystem::path& file);
/// The same from text in memory; `name` stands for the file in messages.
sph::TriangleMesh parse_obj(const std::string& text, const std::string& name);

/// Scales, rotates and translates; a mirroring scale turns the triangles round so that outside stays outside.
sph::TriangleMesh place(sph::TriangleMesh mesh, const MeshPlacement& placement);

}  // namespace flowskin::scenes
