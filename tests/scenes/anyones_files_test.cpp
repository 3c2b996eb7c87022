// Particle files of other programs, written by data/make_anyones_files.py with NumPy, h5py and by hand.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "io_fixture.h"
#include "scene_file_helpers.h"
#include "scenes/io/inflate.h"
#include "scenes/io/named_arrays.h"
#include "scenes/io/particle_file.h"
#include "scenes/io/read_bytes.h"
#include "scenes/io/unreadable_formats.h"
#include "scenes/sources/make_source.h"
#include "scenes/sources/particle_sequence.h"

namespace flowskin::scenes::anyones_files_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::filesystem::path data_file(const std::string& name) { return source_folder() / "tests/scenes/data/anyone" / name; }

/// What a file of data/anyone holds.
struct ExpectedFile {
  const char* name;
  std::size_t steps;
  bool ids, velocities;
  double tolerance = 0;  ///< Of places, where the file holds them rounded.
};

const std::vector<ExpectedFile> expected_files{{"table.csv.gz", 1, true, true},
                                               {"carriage_returns.csv", 1, true, true},
                                               {"points.bgeo", 1, true, true},
                                               {"points_gz.bgeo", 1, true, true},
                                               {"plain.dump", 3, true, true},
                                               {"scaled.dump", 3, true, true, 1e-14},
                                               {"tilted.lammpstrj.gz", 3, true, true, 1e-14},
                                               {"plain.xyz", 3, false, false},
                                               {"extended.xyz", 3, true, true},
                                               {"bare.xyz", 1, false, false},
                                               {"element.xyz", 1, false, false},
                                               {"places.npy", 1, false, false},
                                               {"fortran.npy", 1, false, false},
                                               {"steps.npy", 3, false, false},
                                               {"records.npy", 1, true, true},
                                               {"arrays.npz", 1, true, true},
                                               {"pysph_like.npz", 1, true, true},
                                               {"steps.npz", 3, true, true},
                                               {"rows.json", 1, false, false},
                                               {"objects.json", 1, true, true},
                                               {"object.json", 1, true, true},
                                               {"columns.json", 1, false, false},
                                               {"frames.json", 3, false, false},
                                               {"time.csv", 3, true, true},
                                               {"time_step.csv", 3, true, true},
                                               {"lz4.vtp", 1, true, true},
                                               {"pieces.pvtp", 1, true, true},
                                               {"steps.h5part", 3, true, true},
                                               {"pysph.hdf5", 1, true, true},
                                               {"plain.h5", 1, true, true},
                                               {"points.vtkhdf", 1, true, true}};

void expect_particles(const ParticleFile& file, std::size_t step, const ExpectedFile& expected) {
  EXPECT_EQ(file.has_ids, expected.ids);
  EXPECT_EQ(file.has_velocities, expected.velocities);
  ASSERT_EQ(file.state.ids.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    const double k = static_cast<double>(expected.ids ? 7 - i : i);  // ids run the other way
    EXPECT_EQ(file.state.ids[i], expected.ids ? 93 + i : i);
    const Vec3 place(k / 8 + static_cast<double>(step) / 2, k * k / 64, -k);
    EXPECT_LE((file.state.positions[i] - place).cwiseAbs().maxCoeff(), expected.tolerance) << i;
    if (expected.velocities) {
      EXPECT_EQ(file.state.velocities[i], Vec3(k, 0.5, -k / 4));
    }
  }
}

TEST(AnyonesFiles, OfAllFormatsAreRead) {
  for (const ExpectedFile& expected : expected_files) {
    SCOPED_TRACE(expected.name);
    const std::vector<ParticleTable> steps = read_particle_steps(data_file(expected.name));
    ASSERT_EQ(steps.size(), expected.steps);
    for (std::size_t step = 0; step < steps.size(); ++step)
      expect_particles(particles_of_file(steps[step], expected.name), step, expected);
  }
}

TEST(AnyonesFiles, TellTimesAndRadii) {
  for (const char* name : {"arrays.npz", "object.json", "pysph.hdf5"})
    EXPECT_EQ(read_particle_table(data_file(name)).time, 0.75) << name;
  for (const char* name : {"extended.xyz", "steps.npz", "frames.json", "time.csv", "steps.h5part"}) {
    const auto steps = read_particle_steps(data_file(name));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(steps[k].time, static_cast<double>(k) / 4) << name;
  }
  for (const char* name : {"plain.dump", "plain.xyz"}) {
    const auto steps = read_particle_steps(data_file(name));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(steps[k].step, 100 * k) << name;
  }
  for (const char* name : {"points.bgeo", "plain.dump", "records.npy", "arrays.npz", "lz4.vtp"})
    EXPECT_EQ(read_particles(data_file(name)).radius, 0.25) << name;
}

ParticleSequence sequence_of(const std::vector<std::string>& names) {
  RecordedSpec spec;
  for (const std::string& name : names) spec.files.push_back(data_file(name).string());
  return open_sequence(spec, "/");
}

TEST(AnyonesFiles, OfManyStepsArePlayedStepByStep) {
  for (const ExpectedFile& expected : expected_files) {
    if (expected.steps == 1) continue;
    SCOPED_TRACE(expected.name);
    const ParticleSequence sequence = sequence_of({expected.name});
    ASSERT_EQ(sequence.places.size(), 3U);
    EXPECT_EQ(sequence.ids, expected.ids ? ParticleSequence::Ids::of_files : ParticleSequence::Ids::order);
    // Backwards, too: the file is read once and kept.
    for (const std::size_t k : {0, 1, 2, 1, 0}) expect_particles(read_sequence_file(sequence, k), k, expected);
  }
  EXPECT_THAT(sequence_of({"time.csv"}).times, ElementsAre(0, 0.25, 0.5));
  EXPECT_EQ(sequence_of({"plain.dump"}).interval, 1.0 / 30);
}

TEST(AnyonesFiles, NamedByCollectionsArePlayedByTheirTimes) {
  for (const char* name : {"parts.pvd", "series.vtk.series"}) {
    SCOPED_TRACE(name);
    const ParticleSequence sequence = sequence_of({name});
    EXPECT_THAT(sequence.times, ElementsAre(0, 0.25, 0.5));
    for (std::size_t k = 0; k < 3; ++k) expect_particles(read_sequence_file(sequence, k), k, {name, 3, true, true});
  }
}

TEST(AnyonesFiles, ASingleOneIsOneFrame) {
  const ParticleSequence still = sequence_of({"places.npy"});
  EXPECT_THAT(still.times, ElementsAre(0));
  EXPECT_THAT(fmt::format("{}", fmt::join(still.notes, "; ")), HasSubstr("its velocity is zero"));
  EXPECT_THAT(fmt::format("{}", fmt::join(sequence_of({"points.bgeo"}).notes, "; ")),
              HasSubstr("velocities in the file"));
}

TEST(AnyonesFiles, ThatCannotBeReadAreNamed) {
  const auto error_of_bytes = [](const std::string& bytes) {
    return message_of<InputError>([&] { parse_particle_table(bytes, "a"); });
  };
  EXPECT_THAT(message_of<InputError>([] { read_particle_table(data_file("pickled.npz")); }),
              AllOf(HasSubstr("particles"), HasSubstr("pickled"), HasSubstr("numpy.savez")));
  EXPECT_THAT(error_of_bytes("Ogawa\xff more"), HasSubstr("Alembic"));
  EXPECT_THAT(error_of_bytes("PXR-USDC more"), HasSubstr("USD"));
  EXPECT_THAT(error_of_bytes("#usda 1.0\n"), HasSubstr("USD"));
  EXPECT_THAT(error_of_bytes("\x7fNSJb"), HasSubstr("Houdini"));
  EXPECT_THAT(error_of_bytes("[\n\t\"fileversion\",\"18.0\"]"), HasSubstr("Houdini"));
  EXPECT_THAT(error_of_bytes(std::string(" BDV\0\0\0\0", 8)), HasSubstr("OpenVDB"));
  EXPECT_THAT(error_of_bytes("\x80\x04\x95"), HasSubstr("pickled"));
  EXPECT_THAT(error_of_bytes(std::string("PK\x05\x06", 4) + std::string(18, '\0')), HasSubstr("zip"));
  EXPECT_THAT(error_of_bytes("\xfd"
                             "7zXZ"),
              HasSubstr("xz -d"));
  EXPECT_EQ(unreadable_format("x,y,z\n"), "");
}

std::string binary(const std::string& start, std::size_t size = 400) { return start + std::string(size, '\0'); }

TEST(AnyonesFiles, ThatCannotBeReadAreNamedByTheirContent) {
  const std::string stl_head = "made by x" + std::string(71, ' ') + std::string("\2\0\0\0", 4);
  const std::string gro = "Water, t= 0.0\n    1\n    1SOL     OW    1   0.230   0.628   0.113\n   1.86 1.86 1.86\n";
  const std::string atom = "ATOM      1  N   ALA A   1      11.104   6.134  -6.504  1.00  0.00           N\n";
  const std::vector<std::array<std::string, 2>> files{
      {binary("scb1"), "gconvert"},
      {binary("\xc0PRT\r\n\x1a\n"), "partconvert"},
      {binary("#File JPartDataBi4"), "PartVTK"},
      {"<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\"><Domain/></Xdmf>", "HDF5 file itself"},
      {gro, "GROMACS"},
      {"solid a\n facet normal 0 0 1\n outer loop\n vertex 0 0 0\n", "STL"},
      {stl_head + std::string(100, '\0'), "STL"},
      {"HEADER    A\n" + atom, "protein"},
      {atom, "protein"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "mesh (OBJ)"},
      {binary("PAR1"), "read_parquet"},
      {binary("CDF\x01"), "netCDF4"},
      {binary("LASF"), "pdal"},
      {"{\"x\": 1}\n{\"x\": 2}\n", "jq -s"},
      {"[0,0,0]\r\n[1,0,0]\r\n", "jq -s"},
      {"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nPOINTS 1\nDATA ascii\n0 0 0\n", "pcl_pcd2ply"},
      {"VERSION 0.7\nFIELDS x y z\nPOINTS 1\nDATA binary\n" + std::string(12, '\0'), "pcl_pcd2ply"},
      {"PK\x03\x04 a.usdc", "USD"},
      {"7z\xbc\xaf\x27\x1c", "7z x"},
      {"\x89PNG\r\n", "picture"},
      {"%PDF-1.4", "PDF"},
      {"<!DOCTYPE html><html>", "web page"},
      {"LAMMPS data file\n\n1 atoms\n\n0 1 xlo xhi\n", "write_dump"},
      {"<VTKFile type=\"vtkMultiBlockDataSet\"/>", "Merge Blocks"}};
  for (const auto& file : files) {
    const std::string bytes = file[0], word = file[1];
    EXPECT_THAT(message_of<InputError>([&] { parse_particle_steps(bytes, "a"); }),
                AllOf(HasSubstr("cannot be read, this is"), HasSubstr(word)));
  }
}

TEST(AnyonesFiles, ThatCannotBeReadAreNamedByTheirEndingsAtLast) {
  const auto error = [](const std::string& bytes, const std::string& name) {
    return message_of<InputError>([&] { parse_particle_steps(bytes, name); });
  };
  EXPECT_THAT(error(binary("?"), "Part_0001.bi4"), HasSubstr("PartVTK"));
  EXPECT_THAT(error(binary("?"), "a.XTC"), HasSubstr("OVITO"));
  EXPECT_THAT(error(binary("?"), "a.unknown"), HasSubstr("docs/track.md"));
  EXPECT_EQ(parse_particle_table("x,y,z\n0,0,0\n", "a.pdb").count, 1U) << "the content decides";
  EXPECT_EQ(parse_particle_table("v 0 0 0\nv 1 0 0\n", "a.obj").count, 2U) << "points only";
}

TEST(AnyonesFiles, OfNumbersOfHalfPrecisionAreRead) {
  const auto npy = [](const std::string& type, const std::string& numbers) {
    std::string head = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (1, 3), }";
    return std::string("\x93NUMPY\1\0", 8) + static_cast<char>(head.size()) + '\0' + head + numbers;
  };
  // 1.5, -2^-24 (the smallest there is), 65504 (the largest) [IEEE 754].
  const ParticleTable table = parse_particle_table(npy("<f2", std::string("\x00\x3e\x01\x80\xff\x7b", 6)), "a");
  EXPECT_EQ(table.columns.at("x")[0], 1.5);
  EXPECT_EQ(table.columns.at("y")[0], -std::ldexp(1, -24));
  EXPECT_EQ(table.columns.at("z")[0], 65504);
  const auto error = [&](const std::string& type) {
    return message_of<InputError>([&] { parse_particle_table(npy(type, std::string(100, '\0')), "a"); });
  };
  EXPECT_THAT(error("<c16"), HasSubstr("complex numbers"));
  EXPECT_THAT(error("<f16"), HasSubstr("astype(float)"));
  EXPECT_THAT(error("|O"), HasSubstr("pickled"));
  EXPECT_THAT(error("<U3"), HasSubstr("words"));
}

TEST(AnyonesFiles, CutShortAreErrorsOrLoseOnlyTheEnd) {
  for (const ExpectedFile& expected : expected_files) {
    if (std::string(expected.name) == "pieces.pvtp") continue;
    SCOPED_TRACE(expected.name);
    const std::string bytes = read_bytes(data_file(expected.name));
    // HDF5 files are the largest, and take the longest to open.
    const std::size_t stride = bytes.size() > 4000 ? 131 : 1;
    std::size_t errors = 0, all = 0;
    for (std::size_t size = 1; size < bytes.size(); size += stride, ++all) {
      try {
        for (const ParticleTable& table : parse_particle_steps(bytes.substr(0, size), "a"))
          for (const auto& column : table.columns) ASSERT_EQ(column.second.size(), table.count) << size;
      } catch (const InputError&) {
        ++errors;
      }
    }
    EXPECT_GT(2 * errors, all);
  }
}

TEST(AnyonesFiles, ChangedBytesAreSurvived) {
  for (const ExpectedFile& expected : expected_files) {
    SCOPED_TRACE(expected.name);
    const std::string bytes = read_bytes(data_file(expected.name));
    if (bytes.size() > 4000) continue;  // HDF5's library answers for itself
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      for (const char replacement : {'\0', '\xff', '9', ' ', '<', '"'}) {
        std::string changed = bytes;
        changed[i] = replacement;
        try {
          for (const ParticleTable& table : parse_particle_steps(changed, "a")) {
            for (const auto& column : table.columns) ASSERT_EQ(column.second.size(), table.count) << i;
            for (const auto& ids : table.ids) ASSERT_EQ(ids.second.size(), table.count) << i;
            particles_of_file(table, "a");
          }
        } catch (const InputError&) {
        }
      }
    }
  }
}

TEST(AnyonesFiles, SaySpotAndExpectation) {
  const auto error_of_text = [](const std::string& text) {
    return message_of<InputError>([&] { parse_particle_steps(text, "a"); });
  };
  const std::string dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: ATOMS x y z\n1 2 3\n";
  EXPECT_THAT(error_of_text(dump), AllOf(HasSubstr("a, line 7"), HasSubstr("truncated")));
  EXPECT_THAT(error_of_text(dump + "1 2\n"), AllOf(HasSubstr("a, line 7"), HasSubstr("2 values, 3")));
  EXPECT_THAT(error_of_text("3\ncomment\n1 2 3\n1 2 3\n"), AllOf(HasSubstr("a, line 5"), HasSubstr("truncated")));
  EXPECT_THAT(error_of_text("1\ncomment\n1 2 3\n1 2 3\n"),
              AllOf(HasSubstr("line 4"), HasSubstr("number of particles")));
  EXPECT_THAT(error_of_text("[[1, 2, 3], [1, 2]]"), AllOf(HasSubstr("particle 2"), HasSubstr("[x, y, z]")));
  EXPECT_THAT(error_of_text("[[1, 2, 3],"), HasSubstr("no JSON"));
  EXPECT_THAT(error_of_text("{\"a\": 1}"), HasSubstr("positions"));
  EXPECT_THAT(error_of_text("{\"positions\": [[1, 2, 3], [1, 2, 4]], \"velocities\": [[0, 0, 0]]}"),
              HasSubstr("\"velocities\" has 1 entries for 2 particles"));
}

TEST(AnyonesFiles, ArraysOfAnotherLengthAreNotLeftOutWithoutAWord) {
  const NamedArray places{"pos", {2, 3}, {0, 0, 0, 1, 0, 0}};
  const auto error_with = [&](const NamedArray& array) {
    return message_of<InputError>([&] {
      for (const ParticleTable& table : tables_from_arrays({places, array}, "a")) particles_of_file(table, "a");
    });
  };
  EXPECT_THAT(error_with({"vel", {1, 3}, {0, 0, 0}}), AllOf(HasSubstr("\"vel\""), HasSubstr("1 x 3")));
  EXPECT_THAT(error_with({"id", {3}, {0, 1, 2}}), HasSubstr("3, which does not fit 2 particles"));
  EXPECT_EQ(tables_from_arrays({places, {"mass", {3}, {0, 1, 2}}}, "a").front().columns.count("mass"), 0u);
  const NamedArray steps{"pos", {2, 1, 3}, {0, 0, 0, 1, 0, 0}};
  EXPECT_THAT(message_of<InputError>([&] {
                tables_from_arrays({steps, {"time", {3}, {0, 1, 2}}}, "a");
              }),
              HasSubstr("3 times for 2 time steps"));
}

TEST(AnyonesFiles, MembersOfGzipFollowOneAnother) {
  const std::string bytes = read_bytes(data_file("table.csv.gz"));
  EXPECT_EQ(gunzipped(bytes + bytes, "a"), gunzipped(bytes, "a") + gunzipped(bytes, "a"));
  EXPECT_EQ(gunzipped(bytes + std::string(512, '\0'), "a"), gunzipped(bytes, "a"));
  EXPECT_THAT(message_of<InputError>([&] { gunzipped(bytes.substr(0, 60), "a"); }), HasSubstr("truncated"));
}

TEST_F(IoTest, ACollectionOfWindowsNamesItsFiles) {
  std::filesystem::create_directory(path("dat\xC3\xA9 & co"));
  for (const char* name : {"step_0.vtp", "step_1.vtp"})
    std::filesystem::copy(data_file(name), path("dat\xC3\xA9 & co") / name);
  RecordedSpec spec;
  spec.files = {
      write_text("a.pvd",
                 "<VTKFile type=\"Collection\"><Collection>"
                 "<DataSet timestep=\"0\" file=\"dat&#xE9; &amp; co\\step_0.vtp\"/>"
                 "<DataSet timestep=\"0.25\" file=\"dat&#233; &amp; co\\step_1.vtp\"/></Collection></VTKFile>")};
  const ParticleSequence sequence = open_sequence(spec, "/");
  EXPECT_THAT(sequence.times, ElementsAre(0, 0.25));
  for (const std::size_t k : {0, 1}) expect_particles(read_sequence_file(sequence, k), k, {"a.pvd", 2, true, true});
}

/// Files that have been moved are found beside the collection, with as many of their folders as are there.
TEST_F(IoTest, ACollectionFromAnotherComputerNamesItsFiles) {
  std::filesystem::create_directory(path("data"));
  std::filesystem::copy(data_file("step_0.vtp"), path("data/step_0.vtp"));
  std::filesystem::copy(data_file("step_1.vtp"), path("step_1.vtp"));
  RecordedSpec spec;
  spec.files = {write_text("a.pvd",
                           "<VTKFile type=\"Collection\"><Collection>"
                           "<DataSet timestep=\"0\" file=\"C:\\sim\\run 1\\data\\step_0.vtp\"/>"
                           "<DataSet timestep=\"1\" file=\"/home/else/step_1.vtp\"/></Collection></VTKFile>")};
  const ParticleSequence sequence = open_sequence(spec, "/");
  EXPECT_EQ(sequence.places[0].file, path("data/step_0.vtp"));
  EXPECT_EQ(sequence.places[1].file, path("step_1.vtp"));
}

/// A run over the steps of one file is saved in the middle and goes on; another file is refused.
TEST_F(IoTest, AFileOfManyStepsCanBeResumed) {
  std::string text = read_bytes(data_file("plain.dump"));
  Scene scene;
  scene.directory = folder_.string();
  scene.particles.source = ParticlesSpec::Source::recorded;
  scene.particles.spacing = 0.25;
  scene.particles.recorded.files = {write_text("run.dump", text)};
  scene.particles.recorded.frame_interval = 0.5;
  const auto whole = make_source(scene), first = make_source(scene);
  first->advance_to(0.5);
  std::string saved;
  {
    StateWriter writer([&](std::string_view bytes) { saved += bytes; });
    first->save(writer);
    writer.flush();
  }
  const auto resumed = [&] {
    const auto source = make_source(scene);
    StateReader reader(saved);
    source->restore(reader);
    source->advance_to(0.75);
    return source->state().positions;
  };
  whole->advance_to(0.75);
  EXPECT_EQ(resumed(), whole->state().positions);
  // More steps may have come.
  const std::string more = "ITEM: TIMESTEP\n300\nITEM: NUMBER OF ATOMS\n0\nITEM: ATOMS id x y z vx vy vz\n";
  write_text("run.dump", text + more);
  EXPECT_EQ(resumed(), whole->state().positions);
  text.replace(text.find("\n99 1 0.125"), 11, "\n99 1 0.126");
  write_text("run.dump", text);
  EXPECT_THAT(message_of<InputError>(resumed), HasSubstr("has changed"));
}

}  // namespace
}  // namespace flowskin::scenes::anyones_files_test
