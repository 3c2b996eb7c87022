#include "scenes/io/unreadable_formats.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace flowskin::scenes {
namespace {

using namespace std::string_view_literals;

/// How files begin or their names end, and what they are.
using Mark = std::pair<std::string_view, std::string_view>;

constexpr auto alembic =
    "an Alembic archive; save the points as .ply or .csv (Houdini: ROP Geometry or Table Export), or by a Python "
    "script "
    "with PyAlembic"sv;
constexpr auto usd =
    "a USD file; with USD's Python: Usd.Stage.Open(FILE), UsdGeom.Points(prim).GetPointsAttr().Get(t), and "
    "numpy.savez(OUT, positions=...)"sv;
constexpr auto newer_bgeo =
    "Houdini's geometry of the newer kind (JSON); save it as classic .bgeo (gconvert IN OUT.bhclassic, or ROP Geometry "
    "with the ending .bhclassic), .ply or .csv"sv;
constexpr auto blosc_bgeo =
    "Houdini's geometry compressed by Blosc (.bgeo.sc); save it as .bgeo.gz, .ply or .csv (gconvert IN OUT.bhclassic)"sv;
constexpr auto pickle =
    "a pickled Python object, which only Python can read; in Python: numpy.savez(OUT, positions=..., velocities=...)"sv;
constexpr auto krakatoa =
    "a Krakatoa file (.prt); save it as .csv (Krakatoa's PRT Saver) or .bgeo (Partio: partconvert)"sv;
constexpr auto dualsphysics =
    "a binary file of DualSPHysics (.bi4); PartVTK converts it: PartVTK -dirin DIR -savevtk PartFluid "
    "-onlytype:-all,fluid -vars:+idp,+vel"sv;
constexpr auto net_cdf =
    "a netCDF file; convert it in Python: d = netCDF4.Dataset(FILE), numpy.savez(OUT, x=d['x'][:], y=..., z=...)"sv;
constexpr auto parquet = "a Parquet table; convert it in Python: pandas.read_parquet(FILE).to_csv(OUT, index=False)"sv;
constexpr auto arrow =
    "an Arrow (Feather) table; convert it in Python: pandas.read_feather(FILE).to_csv(OUT, index=False)"sv;
constexpr auto las =
    "a LAS or LAZ point cloud; convert it: pdal translate FILE OUT.ply, or las2txt -parse xyz -i FILE -o OUT.txt"sv;
constexpr auto pcd = "a point cloud of PCL (.pcd); convert it: pcl_pcd2ply FILE OUT.ply"sv;
constexpr auto stl = "a mesh (STL), not particles; give the particles it was made of"sv;
constexpr auto xdmf =
    "an XDMF file, which names arrays in others; give the HDF5 file itself, or save the points as .vtp in ParaView"sv;
constexpr auto gro = "a GROMACS structure (.gro); save it as .xyz (OVITO or VMD: File > Export)"sv;
constexpr auto pdb = "a protein structure (.pdb); save it as .xyz (OVITO, VMD, or obabel FILE -O OUT.xyz)"sv;
constexpr auto json_lines = "JSON with an object in each line; make it one array: jq -s . FILE > OUT.json"sv;
constexpr auto picture = "a picture"sv;
constexpr auto trajectory = "a binary trajectory; save it as .xyz or as a LAMMPS dump (OVITO or VMD: File > Export)"sv;
constexpr auto multi_block =
    "a file of VTK that names several blocks; give the .vtp or .vtu files that it names, or save one .vtp in ParaView "
    "(filter Merge Blocks)"sv;

constexpr Mark marks[] = {
    {"Ogawa", alembic},
    {"PXR-USDC", usd},
    {"#usda", usd},
    {"\x7fNSJ", newer_bgeo},
    {"\x7f"
     "bJSN",
     newer_bgeo},
    {"PGEOMETRY", "Houdini's classic geometry as text; save it as .bgeo, .ply or .csv (gconvert IN OUT.bgeo)"},
    {"scb1", blosc_bgeo},
    {"\xc0PRT\r\n\x1a\n", krakatoa},
    {"\x28\xb5\x2f\xfd", "compressed by Zstandard; unpack it: zstd -d FILE"},
    {"\xfd"
     "7zXZ",
     "compressed by xz; unpack it: xz -d FILE"},
    {"BZh", "compressed by bzip2; unpack it: bzip2 -d FILE"},
    {"7z\xbc\xaf", "a 7-Zip archive; unpack it: 7z x FILE"},
    {"Rar!", "a RAR archive; unpack it"},
    {"\x20\x42\x44\x56", "an OpenVDB file; write its points with OpenVDB's Python, or in Houdini as .ply or .csv"},
    {"\x80\x02", pickle},
    {"\x80\x03", pickle},
    {"\x80\x04", pickle},
    {"\x80\x05", pickle},
    {"PAR1", parquet},
    {"ARROW1", arrow},
    {"CDF\x01", net_cdf},
    {"CDF\x02", net_cdf},
    {"CDF\x05", net_cdf},
    {"LASF", las},
    {"ASTM-E57", "an E57 point cloud; convert it: pdal translate FILE OUT.ply"},
    {"BPHYSICS", "a point cache of Blender; docs/track.md has a script that exports particles"},
    {"BLENDER", "a Blender file; docs/track.md has a script that exports particles"},
    {"glTF", "a glTF mesh; give the particles it was made of"},
    {"Kaydara FBX", "an FBX file; save the particles as .ply or .csv"},
    {"MATLAB 5.0", "a MATLAB file; in MATLAB: writetable(table(x, y, z), 'OUT.csv')"},
    {"SQLite format 3", "an SQLite data base; save the table as .csv"},
    {"\x7f"
     "ELF",
     "a program"},
    {"%PDF", "a PDF document"},
    {"\x89PNG", picture},
    {"\xff\xd8\xff", picture},
    {"version https://git-lfs", "a placeholder of Git LFS, not the file itself; fetch it: git lfs pull"}};

constexpr Mark endings[] = {{".bgeo.sc", blosc_bgeo},
                            {".abc", alembic},
                            {".usd", usd},
                            {".usdc", usd},
                            {".usdz", usd},
                            {".prt", krakatoa},
                            {".bi4", dualsphysics},
                            {".ibi4", dualsphysics},
                            {".obi4", dualsphysics},
                            {".nc", net_cdf},
                            {".las", las},
                            {".laz", las},
                            {".pcd", pcd},
                            {".stl", stl},
                            {".xdmf", xdmf},
                            {".xmf", xdmf},
                            {".gro", gro},
                            {".pdb", pdb},
                            {".jsonl", json_lines},
                            {".ndjson", json_lines},
                            {".parquet", parquet},
                            {".feather", arrow},
                            {".dcd", trajectory},
                            {".xtc", trajectory},
                            {".trr", trajectory},
                            {".vtm", multi_block}};

bool is_binary_stl(std::string_view bytes) {
  constexpr std::size_t head = 80, triangle = 50;
  if (bytes.size() < head + 4) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + head, sizeof(count));
  return count > 0 && bytes.size() == head + 4 + triangle * count;
}

/// What an archive is by the names in it.
std::string_view kind_of_zip(std::string_view bytes) {
  if (bytes.find("xl/workbook.xml") != bytes.npos) return "a workbook of Excel; save the sheet as .csv";
  if (bytes.find(".usdc") != bytes.npos || bytes.find(".usda") != bytes.npos) return usd;
  return {};
}

}  // namespace

std::string_view unreadable_format(std::string_view bytes) {
  for (const auto& [mark, what] : marks)
    if (bytes.starts_with(mark)) return what;
  const std::string_view start = bytes.substr(0, 64);
  if (start.starts_with('[') && start.find("\"fileversion\"") != std::string_view::npos) return newer_bgeo;
  if (start.starts_with("\xda\xba\xfa\0"sv))
    return "a binary file of RealFlow (.bin); save it as .bgeo with Partio: partconvert IN OUT.bgeo";
  if (start.starts_with("#File J") && bytes.substr(0, 512).find('\0') != std::string_view::npos) return dualsphysics;
  if (start.substr(std::min<std::size_t>(4, start.size())).starts_with("CORD")) return trajectory;
  if (bytes.size() > 262 && bytes.substr(257, 5) == "ustar") return "a tar archive; unpack it: tar xf FILE";
  if (start.starts_with("PK\x03\x04")) return kind_of_zip(bytes);
  return is_binary_stl(bytes) ? stl : std::string_view();
}

std::string_view unreadable_ending(const std::string& name) {
  std::string small = name;
  for (char& c : small) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (small.ends_with(".gz")) small.resize(small.size() - 3);
  for (const auto& [ending, what] : endings)
    if (small.ends_with(ending)) return what;
  return {};
}

namespace {

constexpr std::size_t telling_text = 16384;

std::string_view line_of(std::string_view text, std::size_t number) {
  for (; number > 0; --number) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  text = text.substr(0, text.find('\n'));
  return text.ends_with('\r') ? text.substr(0, text.size() - 1) : text;
}

/// A decimal number with nothing but blanks around it.
bool is_fixed_number(std::string_view field) {
  const std::size_t first = field.find_first_not_of(' ');
  return first != field.npos && field.find('.') != field.npos &&
         field.find_first_not_of("+-.0123456789", first) == field.npos;
}

/// A title, the number of atoms, and atoms in columns of fixed width.
bool is_gromacs(std::string_view text) {
  const std::string_view count = line_of(text, 1), atom = line_of(text, 2);
  const bool is_count =
      count.find_first_of("0123456789") != count.npos && count.find_first_not_of(" 0123456789") == count.npos;
  return is_count && atom.size() >= 44 && is_fixed_number(atom.substr(20, 8)) && is_fixed_number(atom.substr(28, 8)) &&
         is_fixed_number(atom.substr(36, 8));
}

/// Lines of atoms in columns of fixed width [Protein Data Bank, format 3.3].
bool is_protein(std::string_view text) {
  for (const auto record : {"ATOM  "sv, "HETATM"sv})
    for (std::size_t at = text.find(record); at != text.npos; at = text.find(record, at + 1)) {
      if (at > 0 && text[at - 1] != '\n') continue;
      const std::string_view atom = line_of(text.substr(at), 0);
      if (atom.size() >= 54 && is_fixed_number(atom.substr(30, 8)) && is_fixed_number(atom.substr(38, 8))) return true;
    }
  return false;
}

/// Whole values of JSON in the first two lines.
bool is_lines_of_json(std::string_view text) {
  const std::string_view first = line_of(text, 0), second = line_of(text, 1);
  const auto in = [&](char open, char close) {
    return first.starts_with(open) && first.ends_with(close) && second.starts_with(open);
  };
  return in('{', '}') || in('[', ']');
}

/// Faces or normals among rows "v x y z", which alone may be particles.
bool is_mesh_of_obj(std::string_view text) {
  const std::size_t first = text.starts_with("v ") ? 0 : text.substr(0, telling_text).find("\nv ");
  return first != text.npos && (text.find("\nf ", first) != text.npos || text.find("\nvn ", first) != text.npos);
}

std::string_view unreadable_xml(std::string_view text) {
  const auto has = [&](std::string_view word) { return text.find(word) != text.npos; };
  if (has("<Xdmf")) return xdmf;
  if (has("<html") || has("<HTML") || has("<!DOCTYPE html")) return "a web page, a failed download perhaps";
  if (has("<ParaView")) return "a state of ParaView, which holds no particles; save them as .vtp (File > Save Data)";
  return has("\"vtkMultiBlockDataSet\"") ? multi_block : std::string_view();
}

}  // namespace

std::string_view unreadable_text(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (is_mesh_of_obj(text)) return "a mesh (OBJ), not particles; give the particles it was made of";
  text = text.substr(0, telling_text);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  if (text.empty()) return {};
  const auto has = [&](std::string_view word) { return text.find(word) != text.npos; };
  if (text.starts_with('<')) return unreadable_xml(text);
  if (text.starts_with('{') && has("\"asset\"") && has("\"version\""))
    return "a glTF mesh; give the particles it was made of";
  if (is_lines_of_json(text)) return json_lines;
  if (text.starts_with("# .PCD") || (has("\nFIELDS ") && has("\nPOINTS "))) return pcd;
  if (text.starts_with("solid") && has("facet normal")) return stl;
  if (text.starts_with("OFF\n") || text.starts_with("OFF\r")) return "a mesh (OFF), not particles";
  if (text.starts_with("FORMAT") && has("ensight")) return "a case of EnSight; save the points as .vtp in ParaView";
  if (has("FoamFile")) return "a file of OpenFOAM; convert the case: foamToVTK (it writes lagrangian/*.vtk or .vtp)";
  if (has(" xlo xhi") && has(" atoms"))
    return "a data file of LAMMPS; write a dump instead: write_dump all custom OUT.dump id type x y z vx vy vz";
  if (is_gromacs(text)) return gro;
  return is_protein(text) ? pdb : std::string_view();
}

}  // namespace flowskin::scenes
