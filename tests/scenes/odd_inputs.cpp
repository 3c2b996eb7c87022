// Inputs that are no files, never end, or are cut short in odd places: refused at once, with the reason.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <ctime>

#include "common/errors.h"
#include "io_fixture.h"
#include "scene_file_helpers.h"
#include "scenes/io/file_info.h"
#include "scenes/io/obj_reader.h"
#include "scenes/io/particle_file.h"
#include "scenes/io/read_bytes.h"
#include "scenes/io/vtp_reader.h"
#include "scenes/sources/particle_sequence.h"

namespace flowskin::scenes::odd_inputs_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

void open_files(const std::string& pattern) {
  RecordedSpec spec;
  spec.files = {pattern};
  open_sequence(spec, "");
}

class OddInputs : public IoTest {
 protected:
  /// Names of things that are no regular files.
  std::vector<std::string> no_files() {
    EXPECT_EQ(::mkfifo(path("fifo").c_str(), 0600), 0);
    std::filesystem::create_directories(path("folder"));
    std::filesystem::create_symlink("/dev/zero", path("zero"));
    std::filesystem::create_symlink("fifo", path("link"));
    std::vector<std::string> names;
    for (const char* name : {"fifo", "folder", "zero", "link"}) names.push_back(path(name).string());
    return names;
  }
};

TEST_F(OddInputs, WhatIsNoRegularFileIsRefusedByEveryReader) {
  for (const std::string& name : no_files()) {
    SCOPED_TRACE(name);
    const auto refused = AllOf(HasSubstr(name), HasSubstr("is not a regular file"));
    EXPECT_THAT(message_of<InputError>([&] { read_bytes(name); }), refused);
    EXPECT_THAT(message_of<InputError>([&] { read_scene(name); }), refused);
    EXPECT_THAT(message_of<InputError>([&] { read_obj(name); }), refused);
    EXPECT_THAT(message_of<InputError>([&] { read_particles(name); }), refused);
    EXPECT_THAT(message_of<InputError>([&] { describe_file(name); }), HasSubstr("is not a regular file"));
    const std::string wall = small_scene(fmt::format(R"("boundaries": [{{"file": "{}"}}])", name));
    EXPECT_THAT(error_of(wall), refused);
    EXPECT_THAT(error_of(small_scene(fmt::format(R"("texture": {{"image": "{}"}})", name))), refused);
  }
  EXPECT_THAT(message_of<InputError>([&] { read_bytes(path("fifo")); }), HasSubstr("process substitution"));
  std::filesystem::create_symlink(path("fifo"), path("p_1.csv"));
  EXPECT_THAT(message_of<InputError>([&] { open_files(path("p_*.csv").string()); }),
              HasSubstr("is not a regular file"));
}

TEST_F(OddInputs, LinksThatLeadInACircleSayWhy) {
  std::filesystem::create_symlink("b", path("a"));
  std::filesystem::create_symlink("a", path("b"));
  for (const auto& message :
       {message_of<InputError>([&] { read_scene(path("a")); }),
        message_of<InputError>([&] { read_particles(path("a")); }),
        error_of(small_scene(fmt::format(R"("boundaries": [{{"file": "{}"}}])", path("a").string())))})
    EXPECT_THAT(message, HasSubstr("symbolic links"));
}

TEST_F(OddInputs, FilesLargerThanTheMemoryAreRefusedUnread) {
  write_text("sparse.csv", "x,y,z\n");
  std::filesystem::resize_file(path("sparse.csv"), std::uintmax_t{1} << 43);
  EXPECT_THAT(message_of<InputError>([&] { read_particles(path("sparse.csv")); }), HasSubstr("too large"));
  EXPECT_THAT(message_of<InputError>([&] { read_scene(path("sparse.csv")); }), HasSubstr("too large"));
}

/// Whether the reader takes the text, or says what is wrong: it must do one of the two.
template <class Read>
bool takes(Read read) {
  try {
    read();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

TEST_F(OddInputs, VtpFilesCutShortOrClosedTooSoonAreErrors) {
  const auto error = [](const std::string& text) {
    return message_of<InputError>([&] { parse_particle_table(text, "odd.vtp"); });
  };
  EXPECT_THAT(error(R"(<VTKFile type="PolyData"/><Piece/><AppendedData>)"), HasSubstr("closes itself"));
  EXPECT_THAT(error(R"(<VTKFile type="PolyData"/><AppendedData>)"), HasSubstr("closes itself"));
  EXPECT_THAT(error(R"(<VTKFile type="PolyData"/>)"), HasSubstr("closes itself"));
  EXPECT_THAT(error(R"(<VTKFile type="PolyData"><AppendedData/>)"), HasSubstr("AppendedData"));
  EXPECT_THAT(error(R"(<VTKFile type="PolyData"></VTKFile><AppendedData>)"), HasSubstr("truncated or empty"));
  EXPECT_THAT(error(R"(<VTKFile type="PolyData"><VTKFile type="PolyData">)"), HasSubstr("second <VTKFile>"));
  EXPECT_THAT(error(R"(<VTKFile type="PolyData"><Piece NumberOfPoints="3"/></VTKFile>)"), HasSubstr("<Points>"));
  EXPECT_THAT(error(R"(<VTKFile type="PolyData"><Piece NumberOfPoints="1"><Points/></Piece></VTKFile>)"),
              HasSubstr("<Points>"));
  EXPECT_THAT(error(R"(<VTKFile type="PolyData"><Piece NumberOfPoints="1"><Points><DataArray type="Float32" )"
                    R"(NumberOfComponents="3"/></Points></Piece></VTKFile>)"),
              HasSubstr("number 1 of 3"));
  EXPECT_THAT(error(R"(<AppendedData>)"), HasSubstr("VTKFile"));
  std::string deep = R"(<VTKFile type="PolyData">)";
  for (int k = 0; k < 1000; ++k) deep += "<a>";
  EXPECT_THAT(error(deep), HasSubstr("nested too deeply"));
  // Words of the format inside a remark are no tags.
  EXPECT_TRUE(takes([] {
    parse_particle_table(R"(<VTKFile type="PolyData"><!-- <AppendedData --><Piece NumberOfPoints="0"/></VTKFile>)",
                         "a");
  }));
}

TEST_F(OddInputs, EveryBeginningOfXmlFilesIsReadOrRefused) {
  const std::string vtp =
      R"(<?xml version="1.0"?><VTKFile type="PolyData" byte_order="LittleEndian"><PolyData><Piece NumberOfPoints="1">)"
      R"(<PointData><DataArray Name="id" type="Int32" format="appended" offset="0"/></PointData><Points><DataArray )"
      R"(type="Float32" NumberOfComponents="3">1 2 3</DataArray></Points></Piece></PolyData><AppendedData encoding=)"
      R"("base64">_BAAAAAcAAAA=</AppendedData></VTKFile>)";
  const std::string pvd =
      R"(<?xml version="1.0"?><VTKFile type="Collection"><Collection><DataSet timestep="0.5" file="a.vtp"/>)"
      R"(<DataSet timestep="1" file="b.vtp"></DataSet></Collection></VTKFile>)";
  EXPECT_TRUE(takes([&] { parse_vtp(vtp, "a"); }));
  EXPECT_TRUE(takes([&] { parse_pvd(pvd, "a.pvd"); }));
  for (std::size_t n = 0; n < vtp.size(); ++n) takes([&] { parse_vtp(vtp.substr(0, n), "a"); });
  for (std::size_t n = 0; n < pvd.size(); ++n) EXPECT_FALSE(takes([&] { parse_pvd(pvd.substr(0, n), "a.pvd"); })) << n;
  // Tags that close themselves, closing tags and tags that are gone, in every place.
  for (const std::string& text : {vtp, pvd}) {
    for (std::size_t at = text.find('>'); at != std::string::npos; at = text.find('>', at + 1)) {
      const std::size_t start = text.rfind('<', at);
      std::string closed = text, other_way = text, gone = text;
      closed.insert(at, "/");
      other_way.insert(start + 1, "/");
      gone.erase(start, at + 1 - start);
      for (const std::string& odd : {closed, other_way, gone}) {
        takes([&] { parse_vtp(odd, "a"); });
        takes([&] { parse_pvd(odd, "a.pvd"); });
      }
    }
  }
}

TEST_F(OddInputs, TimesOfCollectionsAreFiniteNumbers) {
  const auto error = [](const std::string& attributes) {
    return message_of<InputError>([&] {
      parse_pvd("<VTKFile type=\"Collection\"><Collection><DataSet " + attributes + "/></Collection></VTKFile>",
                "a.pvd");
    });
  };
  for (const char* time : {"nan", "NaN", "inf", "-inf", "-nan"})
    EXPECT_THAT(error(fmt::format("timestep=\"{}\" file=\"a.vtp\"", time)),
                AllOf(HasSubstr(time), HasSubstr("not finite")));
  for (const char* time : {"1e999", "", "x", "1 2", "0x"})
    EXPECT_THAT(error(fmt::format("timestep=\"{}\" file=\"a.vtp\"", time)), HasSubstr("expected <DataSet"));
  EXPECT_THAT(error("timestep=\"0\" file=\"\""), HasSubstr("expected <DataSet"));
}

TEST_F(OddInputs, TimesThatCannotBePlayedAreErrorsOfTheFiles) {
  for (const char* name : {"a.csv", "b.csv"}) write_text(name, "x,y,z\n0,0,0\n1,0,0\n0,1,0\n");
  for (const char* times : {"-1e308 1e308", "0 1e300", "0 1e-300", "0 1e12"}) {
    const std::string both = times;
    const std::size_t space = both.find(' ');
    write_text("t.pvd", fmt::format("<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"{}\" file=\"a.csv\"/>"
                                    "<DataSet timestep=\"{}\" file=\"b.csv\"/></Collection></VTKFile>",
                                    both.substr(0, space), both.substr(space + 1)));
    EXPECT_THAT(message_of<InputError>([&] { open_files(path("t.pvd").string()); }),
                AllOf(HasSubstr("none that can be played"), HasSubstr("--time-step")))
        << times;
  }
}

// A scene with so many keys of this name and a number, or where it has none the same key so often.
std::string many_keys(const std::string& name, int count, const std::string& section) {
  std::string keys;
  for (int k = 0; k < count; ++k) keys += name.empty() ? "\"frames\": 1,\n" : fmt::format("\"{}_{}\": 1,\n", name, k);
  return section.empty() ? "{" + keys + R"("frames": 1})" : "{\"" + section + "\": {" + keys + R"("spacing": 0.1}})";
}

TEST_F(OddInputs, ManyUnknownKeysAreRefusedBriefly) {
  std::string long_key(1000000, 'k');
  const int count = 20000;
  for (const std::string& text :
       {many_keys("unknown", count, ""), many_keys("", count, ""), many_keys("spacings", count, "particles"),
        "{\"" + long_key + "\": 1}", "{\"" + long_key + "\"", R"({"frames": ")" + long_key + "\"}"}) {
    const std::string message = error_of(text);
    EXPECT_LT(message.size(), 10000U);
    EXPECT_THAT(message, Not(HasSubstr("no error")));
    if (text.size() < long_key.size()) {
      EXPECT_THAT(message, AllOf(HasSubstr("... and "), HasSubstr(" more")));
    }
  }
}

TEST_F(OddInputs, TheTimeToRefuseUnknownKeysGrowsWithTheirNumberAlone) {
  // Processor time, so that other work on the machine does not count; were it quadratic, the ratio would be 256.
  const auto seconds = [&](int count) {
    const std::string text = many_keys("unknown", count, "");
    const std::clock_t start = std::clock();
    error_of(text);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  seconds(1000);
  const double few = seconds(1000), many = seconds(16000);
  EXPECT_LT(many, 100 * few + 0.1);
}

}  // namespace
}  // namespace flowskin::scenes::odd_inputs_test
