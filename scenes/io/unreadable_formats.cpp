#include "scenes/io/unreadable_formats.h"

#include <array>
#include <utility>

namespace flowskin::scenes {
namespace {

using Mark = std::pair<std::string_view, std::string_view>;

/// How files begin, and what they are.
constexpr std::array<Mark, 19> marks{
    {{"Ogawa",
      "an Alembic archive; save the points as .ply or .csv (Houdini: ROP Geometry or Table Export), or by a "
      "Python script with PyAlembic"},
     {"PXR-USDC",
      "a USD file (binary); with USD's Python: Usd.Stage.Open(FILE), UsdGeom.Points(prim).GetPointsAttr().Get(t), "
      "and numpy.savez(OUT, positions=...)"},
     {"#usda",
      "a USD file (text); with USD's Python: Usd.Stage.Open(FILE), UsdGeom.Points(prim).GetPointsAttr().Get(t), "
      "and numpy.savez(OUT, positions=...)"},
     {"\x7fNSJ",
      "Houdini's geometry of the newer kind (binary JSON); save it as classic .bgeo (gconvert IN OUT.bhclassic, "
      "or ROP Geometry with the ending .bhclassic), .ply or .csv"},
     {"\x7f"
      "bJSN",
      "Houdini's geometry of the newer kind (binary JSON); save it as .ply or .csv, or as classic .bgeo "
      "(ROP Geometry with the ending .bhclassic)"},
     {"PGEOMETRY", "Houdini's classic geometry as text; save it as .bgeo, .ply or .csv (gconvert IN OUT.bgeo)"},
     {"scb1", "Houdini's geometry compressed by Blosc (.bgeo.sc); save it as .bgeo.gz, .ply or .csv"},
     {"\x28\xb5\x2f\xfd", "compressed by Zstandard; unpack it: zstd -d FILE"},
     {"\xfd"
      "7zXZ",
      "compressed by xz; unpack it: xz -d FILE"},
     {"BZh", "compressed by bzip2; unpack it: bzip2 -d FILE"},
     {"7z\xbc\xaf", "a 7-Zip archive; unpack it"},
     {"\x20\x42\x44\x56", "an OpenVDB file; write its points with OpenVDB's Python, or in Houdini as .ply or .csv"},
     {"\x80\x02",
      "a pickled Python object, which only Python can read; in Python: numpy.savez(OUT, positions=..., "
      "velocities=...)"},
     {"\x80\x03",
      "a pickled Python object, which only Python can read; in Python: numpy.savez(OUT, positions=..., "
      "velocities=...)"},
     {"\x80\x04",
      "a pickled Python object, which only Python can read; in Python: numpy.savez(OUT, positions=..., "
      "velocities=...)"},
     {"\x80\x05",
      "a pickled Python object, which only Python can read; in Python: numpy.savez(OUT, positions=..., "
      "velocities=...)"},
     {"glTF", "a glTF mesh; give the particles it was made of"},
     {"BLENDER", "a Blender file; docs/track.md has a script that exports particles"},
     {"%PDF", "a PDF document"}}};

constexpr std::string_view newer_bgeo =
    "Houdini's geometry of the newer kind (JSON); save it as classic .bgeo (ROP Geometry with the ending .bhclassic), "
    ".ply or .csv";

}  // namespace

std::string_view unreadable_format(std::string_view bytes) {
  for (const auto& [mark, what] : marks)
    if (bytes.starts_with(mark)) return what;
  const std::string_view start = bytes.substr(0, 64);
  if (start.starts_with('[') && start.find("\"fileversion\"") != std::string_view::npos) return newer_bgeo;
  if (start.starts_with(std::string_view("\xda\xba\xfa\0", 4)))
    return "a binary file of RealFlow (.bin); save it as .bgeo with Partio: partconvert IN OUT.bgeo";
  return {};
}

}  // namespace flowskin::scenes
