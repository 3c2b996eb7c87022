// Tables as programs of all kinds write them: what is needed is understood or an error, what nobody needs is no matter.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <limits>

#include "common/errors.h"
#include "io_fixture.h"
#include "scenes/io/number_words.h"
#include "scenes/io/obj_reader.h"
#include "scenes/io/particle_file.h"
#include "scenes/io/utf16.h"

namespace flowskin::scenes::odd_tables_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

ParticleFile parsed(const std::string& text, const ParticleNeeds& needs = {}) {
  return particles_from_table(parse_particle_table(text, "a.csv"), "a.csv", needs);
}
std::string error_of(const std::string& text, const ParticleNeeds& needs = {}) {
  return message_of<InputError>([&] { parsed(text, needs); });
}

TEST(NumberWords, OfAllLibraries) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<std::string, double>> words{
      {"0.0D+00", 0},           {"-1.5d-01", -0.15},  {"1D3", 1000},         {"0.1234-100", 0.1234e-100},
      {"0.5+002", 50},          {"+1.5", 1.5},        {"1e-400", 0},         {"-1e-400", -0.0},
      {"1e-310", 1e-310},       {"1e400", infinity},  {"-1e400", -infinity}, {"Inf", infinity},
      {"-Infinity", -infinity}, {"1.#INF", infinity}, {"-1.#INF00", 0}};
  for (const auto& [word, value] : words) {
    if (word == "-1.#INF00") continue;
    ASSERT_TRUE(number_of_word(word)) << word;
    EXPECT_EQ(*number_of_word(word), value) << word;
  }
  for (const char* word : {"nan", "-nan", "NaN", "-1.#IND", "1.#QNAN", "nan(ind)", "-nan(snan)", "-1.#IND00"}) {
    ASSERT_TRUE(number_of_word(word)) << word;
    EXPECT_TRUE(std::isnan(*number_of_word(word))) << word;
  }
  for (const char* word : {"", "****", "N/A", "-", "+", "1.2.3", "1-", "e5", "0x10", "1,5", "+-1", "--1", "d", "1e"})
    EXPECT_FALSE(number_of_word(word)) << word;
  EXPECT_EQ(number_with_comma("-1,25e2"), -125);
  EXPECT_EQ(number_with_comma("1.5"), 1.5);
  EXPECT_FALSE(number_with_comma("1.000,5"));
  EXPECT_EQ(whole_number_of_word("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(whole_number_of_word("-1"), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(whole_number_of_word("9007199254740993"), 9007199254740993U);
  EXPECT_EQ(whole_number_of_word("1.0e3"), 1000U);
  EXPECT_FALSE(whole_number_of_word("1.5"));
  EXPECT_FALSE(whole_number_of_word("1e17"));
}

TEST(OddTables, NeededColumnsAreReadOrRefused) {
  const std::string head = "id,x,y,z,vx,vy,vz\n1,0,0,0,0,-1,0\n";
  for (const std::string velocity : {"1e-400,-1,0", "0.0D+00,-1.0D+00,0.0D+00", "1e-310,-1,4.9E-400"}) {
    const ParticleFile file = parsed("id,x,y,z,vx,vy,vz\n1,0,0,0," + velocity + "\n");
    ASSERT_TRUE(file.has_velocities);
    EXPECT_NEAR((file.state.velocities[0] - Vec3(0, -1, 0)).norm(), 0, 1e-300);
  }
  for (const std::string velocity : {"****,****,****", "-1.#IND,-1.#IND,-1.#IND", ",,", "a,b,c", "1e999,0,0"}) {
    SCOPED_TRACE(velocity);
    const std::string first = "id,x,y,z,vx,vy,vz\n1,0,0,0," + velocity + "\n2,0,0,0,0,0,0\n";
    EXPECT_THAT(error_of(first), testing::ContainsRegex("line 2|particle 1"));
    EXPECT_THAT(error_of(head + "2,0,0,0," + velocity + "\n"), testing::ContainsRegex("line 3|particle 2"));
  }
  EXPECT_THAT(error_of("id,x,y,z\n1,0,0,N/A\n"), AllOf(HasSubstr("line 2"), HasSubstr("N/A")));
  EXPECT_EQ(parsed("x,y,z,X\n1,2,3,4\n").state.positions[0], Vec3(1, 2, 3));
  EXPECT_THAT(error_of("x,y,Z!,Z?\n1,2,3,4\n"), HasSubstr("a.csv"));
}

TEST(OddTables, ColumnsThatNobodyNeedsMayHoldAnything) {
  for (const std::string text :
       {"id,x,y,z\n7,1,2,3,\n8,1,2,4\n", "id,x,y,z,temperature\n7,1,2,3,\n8,1,2,4,20\n",
        ",x,y,z,id\n0,1,2,3,7\n1,1,2,4,8\n", "id,x,y,z,t,T,p,P,m,M\n7,1,2,3,0,20,1,2,3,4\n8,1,2,4,0,20,1,2,3,4\n",
        "id,x,y,z,state\n7,1,2,3,\n8,1,2,4,alive\n", "id,x,y,z,phase\n7,1,2,3,1\n8,1,2,4,liquid\n",
        "id,x,y,z,T\n7,1,2,3,N/A\n8,1,2,4,2\n", "id,x,y,z,a,a\n7,1,2,3,1,2\n8,1,2,4,1,2\n",
        "id [-],x (m),y (m),z (m)\n7,1,2,3\n8,1,2,4\n",
        "Exported by a program\nTime: 0.25 s\n\nid,x,y,z\n7,1,2,3\n8,1,2,4\n", "id;x;y;z\n7;1,0;2,0;3,0\n8;1;2;4\n",
        "id,x,y,z\r7,1,2,3\r8,1,2,4\r", "id,x,y,z,density\n7,1,2,3,nan\n8,1,2,4,1e99\n",
        "id,x,y,z,radius\n7,1,2,3,nan\n8,1,2,4,\n", "# made by hand\n# id x y z\n7 1 2 3\n8 1 2 4\n"}) {
    SCOPED_TRACE(text);
    const ParticleFile file = parsed(text);
    EXPECT_TRUE(file.has_ids && !file.has_velocities);
    EXPECT_EQ(file.state.ids, (std::vector<std::uint64_t>{7, 8}));
    EXPECT_EQ(file.state.positions, (std::vector<Vec3>{{1, 2, 3}, {1, 2, 4}}));
    EXPECT_EQ(file.radius, 0);
  }
  EXPECT_EQ(parse_particle_table("Exported\nTime: 0.25 s\n\nid,x,y,z\n7,1,2,3\n", "a").time, 0.25);
}

TEST(OddTables, IdsAreAnyWholeNumbersAndNotLookedAtUnlessNeeded) {
  const ParticleFile file =
      parsed("id,x,y,z\n9007199254740993,1,2,3\n9007199254740992,4,5,6\n18446744073709551615,0,0,0\n-2,1,1,1\n");
  EXPECT_EQ(file.state.ids, (std::vector<std::uint64_t>{9007199254740992U, 9007199254740993U, 18446744073709551614U,
                                                        18446744073709551615U}));
  for (const std::string ids : {"0", "1.5", "N/A", ""}) {
    const std::string text = "id,x,y,z\n" + ids + ",1,2,3\n" + ids + ",1,2,4\n";
    EXPECT_THAT(error_of(text), HasSubstr("a.csv"));
    const ParticleFile without = parsed(text, {false});
    EXPECT_FALSE(without.has_ids);
    EXPECT_EQ(without.state.ids, (std::vector<std::uint64_t>{0, 1}));
  }
  EXPECT_THAT(error_of("id,x,y,z\n0,1,2,3\n0,1,2,4\n"), HasSubstr("--no-ids"));
}

TEST(OddTables, ParticlesAreChosenByColumnsPlaceAndValidity) {
  const std::string text =
      "id,x,y,z,Type,Point Data\n1,0,0,0,1,5\n2,1,0,0,2,6\n3,2,0,0,1,7\n4,nan,0,0,1,8\n5,3,0,0,,9\n";
  const auto kept = [&](const ParticleNeeds& needs) { return parsed(text, needs).state.ids; };
  const auto keep = [&](const std::string& expression) {
    ParticleNeeds needs;
    needs.keep = expression;
    needs.skip_invalid = true;
    return kept(needs);
  };
  using Ids = std::vector<std::uint64_t>;
  EXPECT_THAT(error_of(text), AllOf(HasSubstr("particle 4"), HasSubstr("--skip-invalid")));
  ParticleNeeds valid;
  valid.skip_invalid = true;
  EXPECT_EQ(kept(valid), (Ids{1, 2, 3, 5}));
  EXPECT_EQ(parsed(text, valid).left_out.invalid, 1U);
  EXPECT_EQ(keep("x >= 1"), (Ids{2, 3, 5}));
  EXPECT_EQ(keep("x >= 1 and x < 3 or id == 1"), (Ids{1, 2, 3}));
  EXPECT_EQ(keep("x >= 1 && (x < 2 || !(x != 3))"), (Ids{2, 5}));
  EXPECT_EQ(keep("not X >= 1"), (Ids{1})) << "a place that is none is invalid";
  EXPECT_EQ(keep("'Point Data' > 6.5 and point_data<9"), (Ids{3}));
  EXPECT_EQ(keep("2 == id"), (Ids{2}));
  EXPECT_EQ(keep("0.5 < x <= 2"), (Ids{2, 3}));
  EXPECT_EQ(keep("-1 < y < x < 2.5"), (Ids{2, 3}));
  ParticleNeeds bad;
  for (const std::string wrong : {"Type", "Type ==", "Type == 1 x", "(Type == 1", "Typ == 1", "== 1", "Type == one",
                                  "Type == 1 and", "1 == 1", "x < nan", "x < 1 <", "2x < 1", "x == y + 1", " "}) {
    bad.keep = wrong;
    EXPECT_THAT(error_of(text, bad), HasSubstr("--keep '")) << wrong;
  }
  const std::size_t many = 30000;
  for (const std::string& deep : {std::string(many, '(') + "x < 1" + std::string(many, ')'), [&] {
                                    std::string text_of_nots;
                                    for (std::size_t k = 0; k < many; ++k) text_of_nots += "not ";
                                    return text_of_nots + "x < 1";
                                  }()}) {
    bad.keep = deep;
    const std::string message = error_of(text, bad);
    EXPECT_THAT(message, HasSubstr("more than 50 levels"));
    EXPECT_LT(message.size(), 300U);
  }
  bad.keep = "Type == 1";
  EXPECT_THAT(error_of(text, bad), AllOf(HasSubstr("line 6"), HasSubstr("Type")));
  ParticleNeeds region = valid;
  region.region = sph::Box{{0.5, -1, -1}, {2, 1, 1}};
  EXPECT_EQ(kept(region), (Ids{2, 3}));
  EXPECT_EQ(parsed(text, region).left_out.by_region, 2U);
  ParticleNeeds once;
  once.skip_duplicates = true;
  const ParticleFile file = parsed("id,x,y,z\n3,0,0,0\n1,1,0,0\n3,2,0,0\n4,1,0,0\n", once);
  EXPECT_EQ(file.state.ids, (Ids{1, 3}));
  EXPECT_EQ(file.left_out.duplicate, 2U);
}

TEST(OddTables, DataInTwoDimensionsAreCalledSo) {
  EXPECT_THAT(error_of("id,x,y\n1,0,0\n"), AllOf(HasSubstr("two dimensions"), HasSubstr("layers")));
}

TEST(OddTables, Utf16) {
  std::string little = "\xFF\xFE", big = "\xFE\xFF";
  for (const char c : std::string("id;x;y;z\r\n7;0,5;2;3\r\n")) {
    little += {c, '\0'};
    big += {'\0', c};
  }
  for (const std::string& text : {little, big}) EXPECT_EQ(parsed(text).state.positions[0], Vec3(0.5, 2, 3));
  const std::string snowman_and_clef = std::string("\xFF\xFE\x03\x26\x34\xD8\x1E\xDD\x00\xD8", 10);
  EXPECT_EQ(utf8_of_utf16(snowman_and_clef), "\xE2\x98\x83\xF0\x9D\x84\x9E\xEF\xBF\xBD");
}

TEST(OddTables, VtkArraysThatNobodyNeeds) {
  const std::string head =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 2 3\nPOINT_DATA 2\n";
  const std::string tail = "SCALARS id vtktypeint64 1\nLOOKUP_TABLE default\n9007199254740993 5\n";
  for (const std::string odd :
       {"FIELD f 1\nnames 1 2 string\na%20b\nc\n", "FIELD f 1\nnames 2 2 string\na\nb\nc\nd\n",
        "SCALARS flag bit 1\nLOOKUP_TABLE default\n0 1\n", "FIELD f 1\nn 1 2 vtktypeuint8\n1 2\n", ""}) {
    SCOPED_TRACE(odd);
    const ParticleFile file = parsed(head + odd + tail);
    EXPECT_EQ(file.state.ids, (std::vector<std::uint64_t>{5, 9007199254740993U}));
  }
  std::string binary = "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 2 float\n" +
                       std::string(24, '\0') + "\nPOINT_DATA 2\nFIELD f 3\nnames 1 2 string\n";
  binary += std::string(
                "\xC2"
                "ab",
                3) +
            std::string("\x80\x01z", 3);
  binary += "\nflag 1 2 bit\n" + std::string(1, '\x40') + "\nid 1 2 vtktypeint64\n" +
            std::string("\0\x20\0\0\0\0\0\1\0\0\0\0\0\0\0\5", 16) + "\n";
  EXPECT_EQ(parsed(binary).state.ids, (std::vector<std::uint64_t>{5, 9007199254740993U}));
}

TEST(OddTables, VtkXmlArraysThatNobodyNeeds) {
  const auto file = [](const std::string& arrays) {
    return "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"2\"><PointData>" + arrays +
           "</PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 2 3"
           "</DataArray></Points></Piece></PolyData></VTKFile>";
  };
  const std::string id =
      "<DataArray Name=\"id\" type=\"UInt64\" format=\"ascii\">18446744073709551615 9007199254740993</DataArray>";
  for (const std::string odd :
       {"<DataArray Name=\"s\" type=\"String\">97 0</DataArray>", "<DataArray Name=\"b\" type=\"Bit\">0 1</DataArray>",
        "<DataArray Name=\"T\" type=\"Float32\" format=\"ascii\">1</DataArray>",
        "<DataArray Name=\"T\" type=\"Float32\" format=\"binary\">!!</DataArray>"}) {
    SCOPED_TRACE(odd);
    EXPECT_EQ(parsed(file(odd + id)).state.ids, (std::vector<std::uint64_t>{9007199254740993U, 18446744073709551615U}));
  }
  EXPECT_THAT(
      error_of(file(
          "<DataArray Name=\"velocity\" NumberOfComponents=\"3\" type=\"Float32\" format=\"ascii\">1</DataArray>")),
      HasSubstr("velocity"));
}

TEST(OddTables, VtkXmlPointsThatAreNotThereTakeNoMemory) {
  EXPECT_THAT(error_of("<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"900000000\"><PointData>"
                       "<DataArray Name=\"T\" type=\"Float32\" format=\"ascii\">1</DataArray></PointData>"
                       "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0</DataArray>"
                       "</Points></Piece></PolyData></VTKFile>"),
              HasSubstr("expected number 4"));
}

TEST(OddTables, PlyPropertiesThatNobodyNeeds) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_EQ(
      parsed(head +
             "property float s\nproperty float s\nproperty uint64 id\nend_header\n1 2 3 4 5 18446744073709551615\n")
          .state.ids[0],
      18446744073709551615U);
  EXPECT_THAT(error_of(head + "property float x\nend_header\n1 2 3 4\n"), HasSubstr("twice"));
}

TEST(OddTables, ObjLinesOfTwoCornersAndLinesThatGoOn) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 \\\n1 0\nv 0 0 1\n";
  EXPECT_EQ(parse_obj(vertices + "f 1 2\nf 1 \\\r\n 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n", "a.obj").triangles.size(), 4U);
}

}  // namespace
}  // namespace flowskin::scenes::odd_tables_test
