// Particle files: those of VTK's own writers (data/make_particle_files.py), tables as programs write them, damaged
// ones.
#include "scenes/io/particle_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <locale>

#include "scene_file_helpers.h"
#include "scenes/io/read_bytes.h"
#include "scenes/io/vtp_reader.h"

namespace flowskin::scenes::particle_files_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::filesystem::path data_folder() { return source_folder() / "tests/scenes/data"; }

std::vector<std::filesystem::path> files_of_vtk() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder()))
    if (is_particle_extension(entry.path().extension().string())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

ParticleFile parse_particles(const std::string& text) {
  return particles_from_table(parse_particle_table(text, "a.csv"), "a.csv");
}

std::string error_of_file(const std::string& text) {
  try {
    parse_particles(text);
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("a.csv"), 0U) << error.what();
    return error.what();
  }
  return "no error";
}

TEST(ParticleFiles, EveryKindThatVtkWritesIsRead) {
  const auto files = files_of_vtk();
  ASSERT_EQ(files.size(), 12U);
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename());
    const ParticleFile particles = read_particles(file);
    const ParticleState& state = particles.state;
    EXPECT_TRUE(particles.has_ids && particles.has_velocities && !particles.has_rest_positions);
    EXPECT_EQ(particles.radius, 0.25);
    ASSERT_EQ(state.ids.size(), 8U);
    for (std::size_t i = 0; i < 8; ++i) {
      const double k = 7 - static_cast<double>(i);  // ids run the other way
      EXPECT_EQ(state.ids[i], 93 + i);
      EXPECT_EQ(state.positions[i], Vec3(k / 8, k * k / 64, -k));
      EXPECT_EQ(state.velocities[i], Vec3(k, 0.5, -k / 4));
    }
    const auto time = read_particle_table(file).time;
    if (file.extension() != ".csv") {
      EXPECT_EQ(time, 1.5);
    }
  }
}

TEST(ParticleFiles, EveryTruncationOfVtkFilesIsAnErrorOrLosesOnlyTheEnd) {
  for (const auto& file : files_of_vtk()) {
    SCOPED_TRACE(file.filename());
    const std::string bytes = read_bytes(file);
    std::size_t errors = 0;
    for (std::size_t size = 1; size < bytes.size(); ++size) {
      try {
        const ParticleTable table = parse_particle_table(bytes.substr(0, size), "a");
        for (const auto& column : table.columns) ASSERT_EQ(column.second.size(), table.count) << size;
      } catch (const InputError&) {
        ++errors;
      }
    }
    // Text may end after a whole line, and what stands behind the last attribute is nobody's loss.
    EXPECT_GT(errors, bytes.size() / 2);
  }
}

TEST(ParticleFiles, EveryChangedByteIsSurvived) {
  for (const auto& file : files_of_vtk()) {
    SCOPED_TRACE(file.filename());
    const std::string bytes = read_bytes(file);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      for (const char replacement : {'\0', '\xff', '9', ' ', '<', '"'}) {
        std::string changed = bytes;
        changed[i] = replacement;
        try {
          const ParticleTable table = parse_particle_table(changed, "a");
          for (const auto& column : table.columns) ASSERT_EQ(column.second.size(), table.count) << i;
          particles_from_table(table, "a");
        } catch (const InputError&) {
        }
      }
    }
  }
}

TEST(ParticleFiles, TablesInAllDialects) {
  const std::vector<std::string> dialects = {
      "x,y,z,vx,vy,vz,id,radius\n1,2,3,4,5,6,7,0.5\n-1,2e-3,+3,4,5,6,8,0.5\n",
      "\xEF\xBB\xBFX;Y;Z;VX;VY;VZ;ID;Radius\r\n1;2;3;4;5;6;7;0.5\r\n-1;2e-3;3;4;5;6;8;0.5\r\n",
      "# made by hand\n\nid\tPosition X\tPosition Y\tPosition Z\tVel.x [m/s]\tVel.y [m/s]\tVel.z [m/s]\tpscale\n"
      "8\t-1\t0.002\t3\t4\t5\t6\t0.5\n# between\n7\t1\t2\t3\t4\t5\t6\t0.5",
      "x y z vx vy vz id radius\n  1   2 3 4 5 6 7 0.5  \n-1 0.002 3 4 5 6 8 0.5 \n",
      "\"velocity:0\",\"velocity:1\",\"velocity:2\",\"Points:0\",\"Points:1\",\"Points:2\",\"name\",\"Idp\","
      "\"radius\"\n"
      "4,5,6,1,2,3,\"a, b\",7,0.5\n4,5,6,-1,0.002,3,\"c\",8,0.5\n",
      "# x, y, z, vx, vy, vz, id, radius\n1,2,3,4,5,6,7,0.5\n-1,0.002,3,4,5,6,8,0.5\n",
      "P[x],P[y],P[z],v[x],v[y],v[z],id,radius,\n1,2,3,4,5,6,7,0.5,\n-1,0.002,3,4,5,6,8,0.5,\n"};
  for (const std::string& text : dialects) {
    SCOPED_TRACE(text);
    const ParticleFile file = parse_particles(text);
    EXPECT_TRUE(file.has_ids && file.has_velocities);
    EXPECT_EQ(file.radius, 0.5);
    EXPECT_EQ(file.state.ids, (std::vector<std::uint64_t>{7, 8}));
    ASSERT_EQ(file.state.positions.size(), 2U);
    EXPECT_EQ(file.state.positions[0], Vec3(1, 2, 3));
    EXPECT_EQ(file.state.positions[1], Vec3(-1, 0.002, 3));
    EXPECT_EQ(file.state.velocities[1], Vec3(4, 5, 6));
  }
  const ParticleFile bare = parse_particles("x,y,z\n1,2,3\n");
  EXPECT_FALSE(bare.has_ids || bare.has_velocities || bare.has_rest_positions);
  EXPECT_EQ(parse_particle_table("Time,x,y,z\n0.25,1,2,3\n", "a").time, 0.25);
  EXPECT_TRUE(parse_particles("x,y,z\n").state.positions.empty());
}

TEST(ParticleFiles, WrongTablesAreErrorsWithTheirLine) {
  EXPECT_THAT(error_of_file("x,y\n1,2\n"), AllOf(HasSubstr("no third coordinate"), HasSubstr("two dimensions")));
  EXPECT_THAT(error_of_file("a,b,c\n1,2,3\n"), AllOf(HasSubstr("x, y and z"), HasSubstr("a, b, c")));
  EXPECT_THAT(error_of_file("1,2,3\n4,5,6\n"), AllOf(HasSubstr("line 1"), HasSubstr("column names")));
  EXPECT_THAT(error_of_file("x,y,z\n1,2,3\n1,2\n"), AllOf(HasSubstr("line 3"), HasSubstr("2 values"), HasSubstr("3")));
  EXPECT_THAT(error_of_file("x,y,z\n1,2,3,4\n"), AllOf(HasSubstr("line 2"), HasSubstr("more values")));
  EXPECT_THAT(error_of_file("x,y,z\n\"1,5\",2,3\n"), AllOf(HasSubstr("line 2"), HasSubstr("1,5"), HasSubstr("point")));
  EXPECT_THAT(error_of_file("x,y,z\n1,2,abc\n"), AllOf(HasSubstr("line 2"), HasSubstr("\"z\""), HasSubstr("abc")));
  EXPECT_THAT(error_of_file("x,y,z\n1,2,nan\n"), HasSubstr("not finite"));
  EXPECT_THAT(error_of_file("x,y,z\n1,2,inf\n"), HasSubstr("not finite"));
  EXPECT_THAT(error_of_file("x,y,z,id\n1,2,3,1.5\n"), HasSubstr("whole number"));
  EXPECT_THAT(error_of_file("x,y,z,id\n1,2,3,4\n1,2,3,4\n"), HasSubstr("two particles have the id 4"));
  EXPECT_THAT(error_of_file("x,y,z,vx\n1,2,3,4\n"), AllOf(HasSubstr("only some"), HasSubstr("velocity")));
  EXPECT_THAT(error_of_file("x,x,y,z\n1,1,2,3\n"), HasSubstr("twice"));
  EXPECT_THAT(error_of_file(std::string("\0\1\2\3", 4)), HasSubstr("docs/track.md"));
  EXPECT_THAT(error_of_file(""), HasSubstr("empty"));
  EXPECT_THAT(error_of_file("# only a remark\n"), HasSubstr("column names"));
}

TEST(ParticleFiles, AbsurdCountsDoNotAskForMemory) {
  const std::string vtk = "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS ";
  EXPECT_THAT(error_of_file(vtk + "99999999999 float\n"), HasSubstr("only 0 bytes are left"));
  EXPECT_THAT(error_of_file(vtk + "18446744073709551615 float\n"), HasSubstr("promised"));
  EXPECT_THAT(error_of_file(vtk + "-1 float\n"), HasSubstr("whole number"));
  const auto vtp = [](const std::string& count, const std::string& data) {
    return "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"" + count +
           "\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"" + data +
           "</DataArray></Points></Piece></PolyData></VTKFile>";
  };
  EXPECT_THAT(error_of_file(vtp("1000000000000", "ascii\">1 2 3")), HasSubstr("number 4 of 3000000000000"));
  EXPECT_THAT(error_of_file(vtp("99999999999999999", "ascii\">1 2 3")), HasSubstr("NumberOfPoints"));
  EXPECT_THAT(error_of_file(vtp("1000000000", "binary\">AAAA")), HasSubstr("4 bytes are promised"));
  // Headers that promise the right number of bytes (12000 and 3600000000), which are not there.
  EXPECT_THAT(error_of_file(vtp("1000", "binary\">4C4AAA==")), HasSubstr("12000 bytes are promised"));
  EXPECT_THAT(error_of_file(vtp("300000000", "binary\">AKST1g==")), HasSubstr("3600000000 bytes are promised"));
}

TEST(ParticleFiles, OtherVtkFilesAreErrorsThatSayWhatToDo) {
  EXPECT_THAT(error_of_file("<VTKFile type=\"ImageData\"/>"), HasSubstr("PolyData"));
  EXPECT_THAT(error_of_file("<VTKFile type=\"PPolyData\"/>"), HasSubstr("parallel run"));
  EXPECT_THAT(error_of_file("<VTKFile type=\"PolyData\" compressor=\"vtkLZMADataCompressor\"/>"),
              AllOf(HasSubstr("vtkLZMADataCompressor"), HasSubstr("zlib")));
  EXPECT_THAT(error_of_file("<points></points>"), HasSubstr("VTKFile"));
  EXPECT_THAT(error_of_file("<html></html>"), HasSubstr("a web page"));
  EXPECT_THAT(error_of_file("# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n"),
              AllOf(HasSubstr("line 5"), HasSubstr("POLYDATA")));
  EXPECT_THAT(error_of_file("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n1 2 x\n"),
              AllOf(HasSubstr("line 6"), HasSubstr("number 3 of 3"), HasSubstr("\"x\"")));
}

/// Old styles that VTK itself does not write for such data any more.
TEST(ParticleFiles, LegacyAttributesOfAllKinds) {
  const ParticleFile file = parse_particles(
      "# vtk DataFile Version 2.0\nby hand\nASCII\nDATASET POLYDATA\nPOINTS 2 double\n1 2 3\n4 5 6\n"
      "VERTICES 2 4\n1 0\n1 1\n\nPOINT_DATA 2\nSCALARS id int 1\nLOOKUP_TABLE default\n5\n3\n"
      "SCALARS radius float\n0.5 0.5\nNORMALS n float\n0 0 1 0 0 1\nVECTORS velocity float\n1 0 0\n0 1 0\n"
      "COLOR_SCALARS c 3\n0 0 1 1 1 1\nTEXTURE_COORDINATES t 2 float\n0 0 1 1\n");
  EXPECT_EQ(file.state.ids, (std::vector<std::uint64_t>{3, 5}));
  EXPECT_EQ(file.state.positions[0], Vec3(4, 5, 6));
  EXPECT_EQ(file.state.velocities[0], Vec3(0, 1, 0));
  EXPECT_EQ(file.radius, 0.5);
}

TEST(ParticleFiles, CollectionsOfFiles) {
  const auto entries = parse_pvd(
      "<?xml version=\"1.0\"?><VTKFile type=\"Collection\"><Collection>\n<DataSet timestep=\"0.5\" part=\"0\" "
      "file=\"a&amp;b.vtp\"/><DataSet timestep='1e0' file='/c.vtp'></DataSet></Collection></VTKFile>",
      "folder/run.pvd");
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].first, 0.5);
  EXPECT_EQ(entries[0].second, "folder/a&b.vtp");
  EXPECT_EQ(entries[1].second, "/c.vtp");
  EXPECT_THROW(parse_pvd("<VTKFile/>", "a.pvd"), InputError);
  EXPECT_THROW(parse_pvd("<Collection><DataSet file=\"x\"/></Collection>", "a.pvd"), InputError);
}

}  // namespace
}  // namespace flowskin::scenes::particle_files_test
