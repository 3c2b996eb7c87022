// Reads the points of VTK's XML files (.vtp, .vtu) and ParaView's collections of files (.pvd).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/io/particle_table.h"

namespace flowskin::scenes {

/// Points and point data of PolyData or UnstructuredGrid, all pieces after one another; arrays as text, base64 or raw
/// bytes, inline or appended, either byte order, plain or compressed by zlib or LZ4. Vectors become columns name_0,
/// name_1, name_2. The field array TimeValue gives the time.
/// @param name stands for the file in messages
/// @throws InputError naming the line or the array and what was expected.
ParticleTable parse_vtp(std::string_view bytes, const std::string& name);

/// The files that a .pvtp or .pvtu names, relative to it; none where the bytes are something else.
/// @throws InputError naming the line that lacks a name
std::vector<std::filesystem::path> pieces_of_vtk(std::string_view bytes, const std::filesystem::path& file);

/// Time (s) and file of every entry of a collection, in its order; names relative to the collection become those beside
/// it. @throws InputError where it is no collection, is empty, or an entry lacks its time or file.
std::vector<std::pair<double, std::filesystem::path>> parse_pvd(std::string_view bytes,
                                                                const std::filesystem::path& file);

}  // namespace flowskin::scenes
