// Files must not depend on the locale: in German, 1.5 is written 1,5 and 1000000 is written 1.000.000.
#include <clocale>
#include <locale>

#include "scenes/io/frame_files.h"
#include "scenes/io/obj_reader.h"
#include "scenes/io/ply_reader.h"
#include "tests/scenes/io_fixture.h"

namespace flowskin::scenes::io_locale_test {
namespace {

struct GermanNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

class LocaleTest : public IoTest {
 protected:
  void TearDown() override {
    std::locale::global(std::locale::classic());
    std::setlocale(LC_ALL, "C");
    IoTest::TearDown();
  }
  void write_all(const std::string& prefix) const {
    const SurfaceFrame frame = sphere_frame(4);
    write_surface_obj(path(prefix + ".obj"), frame, "a.mtl");
    write_surface_ply(path(prefix + ".ply"), frame);
    write_surface_vtp(path(prefix + ".vtp"), frame);
    write_particles_ply(path(prefix + "p.ply"), particle_frame(1200));
    write_particles_vtp(path(prefix + "p.vtp"), particle_frame(1200));
    write_pvd(path(prefix + ".pvd"), {{0.5, "a.vtp"}});
  }
};

TEST_F(LocaleTest, SameBytesInAnyLocale) {
  write_all("c");
  std::locale::global(std::locale(std::locale::classic(), new GermanNumbers));
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // where it is installed; the C++ locale above always takes effect
  std::ostringstream sample;
  sample << 1234.5;
  ASSERT_EQ(sample.str(), "1.234,5") << "the locale of this test does nothing";
  write_all("g");
  for (const char* name : {".obj", ".ply", ".vtp", "p.ply", "p.vtp", ".pvd"})
    EXPECT_TRUE(read_text(path("c" + std::string(name))) == read_text(path("g" + std::string(name)))) << name;
}

TEST_F(LocaleTest, ReadersUnderstandPointsInAnyLocale) {
  const std::string obj = write_text("a.obj", "v 0.5 1.25 -3e-1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string ply = write_text("a.ply",
                                     "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                                     "property float z\nend_header\n0.5 1.25 -3e-1\n");
  std::locale::global(std::locale(std::locale::classic(), new GermanNumbers));
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  EXPECT_TRUE(read_obj(obj).positions[0].isApprox(Vec3(0.5, 1.25, -0.3), 1e-6));
  EXPECT_EQ(particles_from_ply(ply).positions[0], Vec3(0.5, 1.25, -0.3));
}

}  // namespace
}  // namespace flowskin::scenes::io_locale_test
