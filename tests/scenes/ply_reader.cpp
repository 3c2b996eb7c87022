#include "scenes/io/ply_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/errors.h"

namespace flowskin::scenes::ply_reader_test {
namespace {

PlyFile read(const std::string& bytes) { return parse_ply(bytes, "a.ply"); }
ParticleState read_particles(const std::string& bytes) { return particles_from_ply(read(bytes), "a.ply"); }

template <class Action>
std::string error_of(Action&& action) {
  try {
    action();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("a.ply"), 0U) << "the file is not named";
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}
std::string error(const std::string& bytes) {
  return error_of([&] { read(bytes); });
}
std::string particle_error(const std::string& bytes) {
  return error_of([&] { read_particles(bytes); });
}

/// Appends the bytes of a number in the byte order asked for.
template <class T>
void put(std::string& bytes, T value, bool big_endian) {
  std::string part(reinterpret_cast<const char*>(&value), sizeof(T));  // this test runs on little-endian machines
  if (big_endian) std::reverse(part.begin(), part.end());
  bytes += part;
}

/// Every type, a list between the scalars, an unknown element, and faces with three to five corners.
std::string header(const std::string& format, const std::string& line_end) {
  std::string text;
  for (const char* line : {"ply",
                           "format FORMAT 1.0",
                           "comment made by hand",
                           "obj_info none",
                           "element camera 1",
                           "property list uint8 float parameters",
                           "property short id",
                           "element vertex 5",
                           "property float x",
                           "property double y",
                           "property float32 z",
                           "property list ushort uchar extra",
                           "property char a",
                           "property ushort b",
                           "property int c",
                           "property uint32 d",
                           "element face 3",
                           "property uchar flag",
                           "property list uchar int vertex_indices",
                           "property list int16 float texcoord",
                           "end_header"})
    text += line + line_end;
  text.replace(text.find("FORMAT"), 6, format);
  return text;
}

const std::string ascii_data =
    "2 1.5 2.5 -7\n"
    "0 0.125 0 0 -1 65535 -3 4000000000\n1 0.25 0 1 9 -2 1 2 3\n0 1 0 2 9 9 -3 1 2 3\n0 0 1 0 -4 1 2 3\n1 1e-3 1 0 -5 "
    "1 2 3\n"
    "1 3 0 1 2 0\n0 4 0 1 4 2 2 0.5 0.5\n0 5 0 1 2 3 4 0\n";

std::string binary_data(bool big) {
  std::string bytes;
  put<std::uint8_t>(bytes, 2, big);
  put<float>(bytes, 1.5F, big);
  put<float>(bytes, 2.5F, big);
  put<std::int16_t>(bytes, -7, big);
  const double ys[5] = {0.125, 0.25, 1, 0, 1e-3};
  const float xs[5] = {0, 1, 0, 0, 1}, zs[5] = {0, 0, 0, 1, 1};
  const int extras[5] = {0, 1, 2, 0, 0};
  for (int i = 0; i < 5; ++i) {
    put<float>(bytes, xs[i], big);
    put<double>(bytes, ys[i], big);
    put<float>(bytes, zs[i], big);
    put<std::uint16_t>(bytes, static_cast<std::uint16_t>(extras[i]), big);
    bytes.append(static_cast<std::size_t>(extras[i]), '\x09');
    put<std::int8_t>(bytes, static_cast<std::int8_t>(-1 - i), big);
    put<std::uint16_t>(bytes, i == 0 ? 65535 : 1, big);
    put<std::int32_t>(bytes, i == 0 ? -3 : 2, big);
    put<std::uint32_t>(bytes, i == 0 ? 4000000000U : 3U, big);
  }
  const std::vector<std::vector<int>> faces{{0, 1, 2}, {0, 1, 4, 2}, {0, 1, 2, 3, 4}};
  for (std::size_t i = 0; i < 3; ++i) {
    put<std::uint8_t>(bytes, i == 0, big);
    put<std::uint8_t>(bytes, static_cast<std::uint8_t>(faces[i].size()), big);
    for (const int corner : faces[i]) put<std::int32_t>(bytes, corner, big);
    put<std::int16_t>(bytes, i == 1 ? 2 : 0, big);
    for (int k = 0; k < (i == 1 ? 2 : 0); ++k) put<float>(bytes, 0.5F, big);
  }
  return bytes;
}

void expect_sample(const PlyFile& ply) {
  ASSERT_EQ(ply.vertex_count, 5U);
  EXPECT_EQ(ply.vertex.size(), 7U);
  EXPECT_EQ(ply.vertex.at("x"), (std::vector<double>{0, 1, 0, 0, 1}));
  EXPECT_EQ(ply.vertex.at("y"), (std::vector<double>{0.125, 0.25, 1, 0, 1e-3}));
  EXPECT_EQ(ply.vertex.at("z"), (std::vector<double>{0, 0, 0, 1, 1}));
  EXPECT_EQ(ply.vertex.at("a"), (std::vector<double>{-1, -2, -3, -4, -5}));
  EXPECT_EQ(ply.vertex.at("b")[0], 65535);
  EXPECT_EQ(ply.vertex.at("c")[0], -3);
  EXPECT_EQ(ply.vertex.at("d")[0], 4000000000.0);
  EXPECT_EQ(ply.triangles,
            (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 1, 4}, {0, 4, 2}, {0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  EXPECT_EQ(ply.comments, std::vector<std::string>{"made by hand"});
}

TEST(PlyReader, ReadsAllFormatsAndLineEnds) {
  for (const std::string line_end : {"\n", "\r\n"}) {
    expect_sample(read(header("ascii", line_end) + ascii_data));
    expect_sample(read(header("binary_little_endian", line_end) + binary_data(false)));
    expect_sample(read(header("binary_big_endian", line_end) + binary_data(true)));
  }
}

TEST(PlyReader, EveryTruncationIsNoticed) {
  for (const std::string& bytes :
       {header("ascii", "\n") + ascii_data, header("binary_little_endian", "\n") + binary_data(false),
        header("binary_big_endian", "\r\n") + binary_data(true)}) {
    // The last "0" of the ascii file is its last value: without line end it is still whole.
    const std::size_t whole = bytes.size() - (bytes.back() == '\n' ? 1 : 0);
    for (std::size_t size = 0; size < whole; ++size) EXPECT_THROW(read(bytes.substr(0, size)), InputError) << size;
  }
}

TEST(PlyReader, SurvivesEveryChangedByte) {
  for (const std::string& bytes :
       {header("ascii", "\n") + ascii_data, header("binary_little_endian", "\n") + binary_data(false)})
    for (std::size_t i = 0; i < bytes.size(); ++i)
      for (const char replacement : {'\0', '\xff', '9', ' ', '\n'}) {
        std::string changed = bytes;
        changed[i] = replacement;
        try {
          for (const auto& triangle : read(changed).triangles)
            for (const int vertex : triangle) EXPECT_GE(vertex, 0);
        } catch (const InputError&) {
        }
      }
}

std::string particle_header(const std::string& count, const std::string& more = "") {
  return "ply\nformat ascii 1.0\nelement vertex " + count + "\nproperty float x\nproperty float y\nproperty float z\n" +
         more + "end_header\n";
}

TEST(PlyReader, AbsurdCountsTakeNoMemory) {
  EXPECT_NE(error(particle_header("4000000000000000000") + "0 0 0\n").find("promises 4000000000000000000"),
            std::string::npos);
  std::string binary = particle_header("1000000000") + std::string(1000, '\0');
  binary.replace(binary.find("ascii"), 5, "binary_little_endian");
  EXPECT_NE(error(binary).find("too short"), std::string::npos);
  EXPECT_NE(error(particle_header("99999999999999999999999")).find("whole number"), std::string::npos);
  EXPECT_NE(error(particle_header("-1")).find("whole number"), std::string::npos);
  // A list that says it has 2^32 - 1 values.
  std::string list =
      "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nelement face 1\n"
      "property list uint int vertex_indices\nend_header\n";
  EXPECT_THROW(read(list + std::string(4, '\xff') + std::string(100, '\0')), InputError);
  // Elements without properties take no room, so any number of them is possible.
  EXPECT_EQ(read("ply\nformat ascii 1.0\nelement nothing 4000000000000000000\nelement vertex 1\nproperty float "
                 "x\nend_header\n1\n")
                .vertex_count,
            1U);
}

TEST(PlyReader, SaysWhatIsWrong) {
  EXPECT_NE(error("").find("no PLY file"), std::string::npos);
  EXPECT_NE(error("plywood\n").find("starts with the line"), std::string::npos);
  EXPECT_NE(error("ply\nformat ascii 1.0\n").find("before \"end_header\""), std::string::npos);
  EXPECT_NE(error("ply\nformat ascii 2.0\nend_header\n").find("version 1.0"), std::string::npos);
  EXPECT_NE(error("ply\nformat text 1.0\nend_header\n").find("line 2 of the header: expected format"),
            std::string::npos);
  EXPECT_NE(error("ply\nend_header\n").find("no line \"format\""), std::string::npos);
  EXPECT_NE(error("ply\nformat ascii 1.0\nend_header\n").find("no element \"vertex\""), std::string::npos);
  EXPECT_NE(error("ply\nformat ascii 1.0\nproperty int a\nend_header\n").find("before the first element"),
            std::string::npos);
  EXPECT_NE(error("ply\nformat ascii 1.0\nbogus\nend_header\n").find("unknown keyword \"bogus\""), std::string::npos);
  EXPECT_NE(error(particle_header("1", "property quad w\n")).find("unknown type \"quad\""), std::string::npos);
  EXPECT_NE(error(particle_header("1", "property float\n")).find("without a name"), std::string::npos);
  EXPECT_NE(error(particle_header("2") + "0 0 0\n1 two 3\n").find("vertex 2 of 2: expected a number, found \"two\""),
            std::string::npos);
  EXPECT_NE(error(particle_header("2") + "0 0 0\n1 0,5 3\n").find("found \"0,5\""), std::string::npos);
  const std::string faces =
      particle_header("3", "element face 1\nproperty list uchar int vertex_index\n") + "0 0 0 1 0 0 0 1 0\n";
  EXPECT_NE(error(faces + "3 0 1 3\n").find("refers to vertex 3"), std::string::npos);
  EXPECT_NE(error(faces + "3 0 1 -1\n").find("no vertex index"), std::string::npos);
  EXPECT_NE(error(faces + "3 0 1 1.5\n").find("no vertex index"), std::string::npos);
  EXPECT_NE(error(faces + "-3 0 1\n").find("length of the list"), std::string::npos);
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "flowskin_ply_reader_test.ply";
  std::ofstream(file) << particle_header("1") << "1 2 3\n";
  EXPECT_EQ(particles_from_ply(file).positions[0], Vec3(1, 2, 3));
  std::filesystem::remove(file);
  EXPECT_THROW(read_ply("/no/such/file.ply"), InputError);
  EXPECT_THROW(read_ply(std::filesystem::temp_directory_path()), InputError);
}

TEST(PlyReader, ParticlesGetDefaultsForWhatIsMissing) {
  const ParticleState state = read_particles((particle_header("2") + "1 2 3\n4 5 6\n"));
  EXPECT_EQ(state.ids, (std::vector<std::uint64_t>{0, 1}));
  EXPECT_EQ(state.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(state.rest_positions, state.positions);
  EXPECT_EQ(state.velocities, std::vector<Vec3>(2, Vec3::Zero()));
  EXPECT_EQ(state.densities, std::vector<double>(2, 0.0));
  EXPECT_EQ(state.time, 0);
  EXPECT_TRUE(read_particles((particle_header("0"))).ids.empty());
}

TEST(PlyReader, ParticlesAreSortedByIdWithAllTheyCarry) {
  for (const std::string v : {"v", "velocity_"}) {
    const std::string more =
        "property float " + v + "x\nproperty float " + v + "y\nproperty float " + v +
        "z\nproperty uint id\nproperty float density\nproperty float rest_x\nproperty float rest_y\n"
        "property float rest_z\n";
    const ParticleState state =
        read_particles((particle_header("3", more) +
                        "1 0 0 10 0 0 7 1001 100 0 0\n2 0 0 20 0 0 3 1002 200 0 0\n3 0 0 30 0 0 5 1003 300 0 0\n"));
    EXPECT_EQ(state.ids, (std::vector<std::uint64_t>{3, 5, 7}));
    EXPECT_EQ(state.positions, (std::vector<Vec3>{{2, 0, 0}, {3, 0, 0}, {1, 0, 0}}));
    EXPECT_EQ(state.velocities, (std::vector<Vec3>{{20, 0, 0}, {30, 0, 0}, {10, 0, 0}}));
    EXPECT_EQ(state.rest_positions, (std::vector<Vec3>{{200, 0, 0}, {300, 0, 0}, {100, 0, 0}}));
    EXPECT_EQ(state.densities, (std::vector<double>{1002, 1003, 1001}));
  }
}

TEST(PlyReader, SaysWhatIsWrongWithParticles) {
  EXPECT_NE(
      particle_error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n").find("x, y and z"),
      std::string::npos);
  EXPECT_NE(particle_error(particle_header("2") + "0 0 0\n0 nan 0\n").find("particle 2: the position is not finite"),
            std::string::npos);
  EXPECT_NE(particle_error(particle_header("1", "property float vx\n") + "0 0 0 1\n")
                .find("only some components of the velocity"),
            std::string::npos);
  EXPECT_NE(particle_error(particle_header("2", "property int id\n") + "0 0 0 5\n1 1 1 5\n")
                .find("two particles have the id 5"),
            std::string::npos);
  for (const char* id : {"1.5", "nan", "1e300"})
    EXPECT_NE(particle_error(particle_header("1", "property double id\n") + "0 0 0 " + id + "\n")
                  .find("id is no whole number"),
              std::string::npos);
  // Densities are only passed on: those that say nothing are not there.
  EXPECT_EQ(read_particles(particle_header("1", "property float density\n") + "0 0 0 inf\n").densities[0], 0);
}

}  // namespace
}  // namespace flowskin::scenes::ply_reader_test
