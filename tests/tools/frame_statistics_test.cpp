// frames.csv: its columns, and the worst of a run.
#include <fstream>
#include <optional>
#include <sstream>

#include "tests/tools/io_fixture.h"
#include "tools/pipeline/surface_statistics.h"
#include "tools/report/frames_csv.h"
#include "tools/report/worst_frames.h"
#include "tracking/advection/particle_paths.h"
#include "tracking/field/metaballs/metaball_field.h"

namespace flowskin::tools::frame_statistics_test {
namespace {

class FramesCsv : public IoTest {};

// The names in backquotes in the first column of the table under "## frames.csv".
std::vector<std::string> documented_columns() {
  std::ifstream page(FLOWSKIN_SOURCE_DIR "/docs/files.md");
  std::vector<std::string> names;
  bool here = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("## ", 0) == 0) here = line == "## frames.csv";
    if (!here || line.rfind("| `", 0) != 0) continue;
    std::istringstream cell(line.substr(2, line.find(" |", 2) - 2));
    for (std::string text, name; std::getline(cell, text, '`') && std::getline(cell, name, '`');) names.push_back(name);
  }
  return names;
}

TEST_F(FramesCsv, EveryColumnIsDocumentedInItsOrder) {
  write_frames_csv(path("frames.csv"), {FrameRow{}});
  std::istringstream header(read_text(path("frames.csv")));
  std::string line;
  std::getline(header, line);
  std::istringstream columns(line);
  std::vector<std::string> written;
  for (std::string name; std::getline(columns, name, ',');) written.push_back(name);
  EXPECT_GT(written.size(), 30U);
  EXPECT_EQ(written, documented_columns());
}

// Particles of a ball, and meshes around them.
struct BallOfParticles {
  BallOfParticles() {
    settings.spacing = 0.1;
    settings.edge_length = 0.075;
    settings.field = tracking::default_field_settings(settings.spacing);
    for (int i = -6; i <= 6; ++i)
      for (int j = -6; j <= 6; ++j)
        for (int k = -6; k <= 6; ++k)
          if (i * i + j * j + k * k <= 36) particles.positions.emplace_back(0.1 * i, 0.1 * j, 0.1 * k);
    particles.rest_positions = particles.positions;
    for (std::size_t i = 0; i < particles.positions.size(); ++i) particles.ids.push_back(i);
    particles.velocities.assign(particles.positions.size(), Vec3::Zero());
  }
  FrameRow described(const tracking::SurfaceMesh& mesh) const {
    FrameRow row;
    std::optional<tracking::MetaballField> field;
    if (!particles.positions.empty()) field.emplace(tracking::field_of(particles, settings.field));
    describe_surface(mesh, field ? &*field : nullptr, particles, settings, true, row);
    return row;
  }
  tracking::Particles particles;
  tracking::TrackerSettings settings;
};

TEST(SurfaceStatistics, OfTheTrackersFirstMesh) {
  const BallOfParticles ball;
  const tracking::Tracker tracker(ball.settings, ball.particles);
  const FrameRow row = ball.described(tracker.mesh());
  EXPECT_EQ(row.vertices, tracker.mesh().positions.size());
  EXPECT_EQ(row.components, 1);
  EXPECT_EQ(row.expected_components, 1);
  EXPECT_EQ(row.euler, 2);
  EXPECT_EQ(row.expected_euler, 2);
  EXPECT_EQ(row.same_topology, 1);
  EXPECT_EQ(row.self_intersections, 0U);
  EXPECT_DOUBLE_EQ(row.volume, tracker.report().volume);
  EXPECT_DOUBLE_EQ(row.area, tracker.report().area);
  EXPECT_NEAR(row.volume, row.expected_volume, 0.01 * row.expected_volume);
  EXPECT_GT(row.hausdorff, 0);
  EXPECT_LT(row.hausdorff, 0.5 * ball.settings.edge_length);
  EXPECT_GT(row.good_angles, 0.99);
  EXPECT_GT(row.good_edges, 0.95);
}

TEST(SurfaceStatistics, TellWhatIsWrong) {
  const BallOfParticles ball;
  // Two spheres through each other, far too large and far too coarse.
  tracking::SurfaceMesh mesh = sphere_mesh(1);
  const tracking::SurfaceMesh second = sphere_mesh(1, Vec3(0.5, 0, 0));
  const int offset = static_cast<int>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), second.positions.begin(), second.positions.end());
  mesh.rest_positions.insert(mesh.rest_positions.end(), second.rest_positions.begin(), second.rest_positions.end());
  for (const auto& [a, b, c] : second.triangles) mesh.triangles.push_back({a + offset, b + offset, c + offset});
  const FrameRow row = ball.described(mesh);
  EXPECT_EQ(row.components, 2);
  EXPECT_EQ(row.same_topology, 0);
  EXPECT_GT(row.self_intersections, 0U);
  EXPECT_GT(row.hausdorff, 0.5);
  EXPECT_EQ(row.good_edges, 0);
  EXPECT_EQ(row.good_angles, 1);
}

TEST(SurfaceStatistics, WithoutParticlesOrMesh) {
  BallOfParticles ball;
  const FrameRow no_mesh = ball.described({});
  EXPECT_EQ(no_mesh.components, 0);
  EXPECT_EQ(no_mesh.expected_components, 1);
  EXPECT_EQ(no_mesh.same_topology, 0);
  EXPECT_TRUE(std::isinf(no_mesh.hausdorff));
  ball.particles = {};
  EXPECT_EQ(ball.described({}).hausdorff, 0);
  EXPECT_EQ(ball.described({}).same_topology, 1);
}

TEST(WorstFrames, NamesTheWorstAndItsFrame) {
  std::vector<FrameRow> rows(4);
  for (int i = 0; i < 4; ++i) {
    rows[i].frame = i;
    rows[i].vertices = 200;
    rows[i].kept_ids = i == 0 ? 0 : 200;
    rows[i].kept_first_ids = 200 - 10 * i;
    rows[i].volume = rows[i].expected_volume = 1;
    rows[i].good_angles = rows[i].good_edges = 1;
  }
  rows[1].self_intersections = 7;
  rows[2].hausdorff = 0.25;
  rows[3].volume = 0.98;
  rows[2].volume = 1.01;
  rows[1].max_distance = 2e-5;
  rows[2].good_angles = 0.999;
  rows[3].good_edges = 0.5;
  rows[2].vertices = 300;  // half of them are new
  rows[2].kept_ids = 150;
  rows[3].kept_ids = 290;
  rows[3].kept_first_ids = 120;
  rows[3].same_topology = 0;
  EXPECT_EQ(
      worst_frames(rows, 0.5),
      "worst frames: 7 self-intersections (1), Hausdorff 0.50 edge lengths (2), volume -2.00 % (3), |f|/|grad f| "
      "2.0e-05 m (1), good angles 99.90 % (2), good edges 50.00 % (3), 75.0 % of the ids of the frame before kept "
      "(2); 60.0 % of the first frame's ids are there at the end; topology differs in 1 of 4 frames");
}

TEST(WorstFrames, SayNothingWithoutASurface) {
  EXPECT_EQ(worst_frames({}, 1), "");
  EXPECT_EQ(worst_frames({FrameRow{}, FrameRow{}}, 1), "");
}

}  // namespace
}  // namespace flowskin::tools::frame_statistics_test
