// Comparison of velocity methods: which methods, the ground truth, the table, the ranking, the tiles.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "common/errors.h"
#include "scenes/sources/make_source.h"
#include "tests/tools/io_fixture.h"
#include "tools/pipeline/compared_method.h"
#include "tools/pipeline/comparison.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/compare_report.h"

namespace flowskin::tools::compare_test {
namespace {

using Names = std::vector<std::string>;

Names names_of(const std::string& list) {
  Names names;
  for (const ComparedMethod& method : methods_to_compare(list)) names.push_back(method.name);
  return names;
}

TEST(CompareMethods, AreThoseNamedOnceEach) {
  EXPECT_EQ(names_of(""), Names{});
  EXPECT_EQ(names_of("total"), Names{"total"});
  EXPECT_EQ(names_of("total,normal,total"), (Names{"total", "normal"}));
  const Names all = names_of("all");
  EXPECT_EQ(all.size(), tracking::velocity_methods().size() - 1);
  EXPECT_EQ(std::count(all.begin(), all.end(), "curvature-belyaev"), 0);
  EXPECT_EQ(names_of("curvature-belyaev,all").size(), all.size() + 1);
}

TEST(CompareMethods, TakeSettingsOfTheirOwn) {
  const auto methods = methods_to_compare("hybrid,hybrid:fairing=0,affine:integrator=rk4:edge_length=0.8");
  ASSERT_EQ(methods.size(), 3u);
  scenes::Scene scene;
  scene.particles.spacing = 0.1;
  const tracking::TrackerSettings usual = settings_for(scene, methods[0]), unfaired = settings_for(scene, methods[1]),
                                  finer = settings_for(scene, methods[2]);
  EXPECT_EQ(methods[1].name, "hybrid:fairing=0");
  EXPECT_EQ(usual.velocity, "hybrid");
  EXPECT_EQ(unfaired.velocity, "hybrid");
  EXPECT_GT(usual.fairing_iterations, 0);
  EXPECT_EQ(unfaired.fairing_iterations, 0);
  EXPECT_EQ(finer.velocity, "affine");
  EXPECT_EQ(finer.integrator, tracking::Integrator::rk4);
  EXPECT_DOUBLE_EQ(finer.edge_length, 0.08);
}

TEST(CompareMethods, WrongSettingsAreAnswered) {
  const auto says = [](const std::string& list, const std::string& words) {
    const std::string message = message_of<InputError>([&] { methods_to_compare(list); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_NE(message.find("--compare"), std::string::npos) << message;
  };
  says("hybrid:fairing", "KEY=VALUE");
  says("hybrid:", "KEY=VALUE");
  says("hybrid:=3", "KEY=VALUE");
  says("hybrid:fairing=-1", "expected");
  says("hybrid:integrator=rk5", "rk4");
  says("hybrid:integratr=rk4", "integrator");
  says("hybrid:max_slip=1", "same for all");
  says("hybrid:threshold=1", "same for all");
}

TEST(CompareMethods, UnknownNamesAreAnswered) {
  for (const char* wrong : {"fly", "normal,fly", "normal,", ",normal", "normal, total"}) {
    const std::string message = message_of<InputError>([&] { methods_to_compare(wrong); });
    EXPECT_NE(message.find("curvature"), std::string::npos) << message;
    EXPECT_NE(message.find("--compare"), std::string::npos) << message;
  }
}

CompareRow row(int frame, const std::string& method, double texture, double velocity, double speed) {
  CompareRow result;
  result.frame = frame;
  result.time = 0.1 * frame;
  result.method = method;
  result.texture_median = texture;
  result.path_median = 2 * texture;
  result.velocity_error = result.tangential_error = velocity;
  result.flow_speed = result.tangential_speed = speed;
  result.markers = 90;
  result.markers_left = 10;
  result.reextractions = frame;
  result.seconds = 0.5;
  result.stretch_p99 = 1 + frame;
  return result;
}

std::vector<CompareRow> some_rows() {
  return {row(0, "bad", 0, 0.5, 1),     row(0, "good", 0, 0, 1),       row(1, "bad", 0.1, 0.5, 1),
          row(1, "good", 0.01, 0.1, 1), row(2, "bad", 0.3, 0.5, 0.01), row(2, "good", 0.03, 10, 0.01)};
}

TEST(CompareRanking, IsByTextureErrorAndWeighsVelocityErrorsBySpeed) {
  const std::vector<MethodScore> ranking = rank_methods(some_rows(), 0.1);
  ASSERT_EQ(ranking.size(), 2U);
  EXPECT_EQ(ranking[0].method, "good");
  EXPECT_NEAR(ranking[0].texture, 0.2, 1e-12);
  EXPECT_NEAR(ranking[0].texture_at_end, 0.3, 1e-12);
  EXPECT_NEAR(ranking[0].path, 0.4, 1e-12);
  EXPECT_NEAR(ranking[1].texture, 2, 1e-12);
  EXPECT_NEAR(ranking[1].velocity, 0.5, 1e-12);
  // The large relative error of the last frame is one of a fluid that hardly moves.
  EXPECT_NEAR(ranking[0].velocity, std::sqrt((0.01 + 0.01) / 2.0001), 1e-12);
  EXPECT_EQ(ranking[0].reextractions, 3);
  EXPECT_EQ(ranking[0].stretch_p99, 3);
  EXPECT_NEAR(ranking[0].seconds, 1.5, 1e-12);
  const Names lines = ranking_lines(ranking);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_LT(lines[1].find("good"), lines[1].size());
  EXPECT_LT(lines[2].find("bad"), lines[2].size());
  for (const std::string& line : lines) EXPECT_EQ(line.size(), lines[0].size());
  EXPECT_TRUE(rank_methods({}, 0.1).empty());
}

TEST(ComparePlots, HaveALineAMethodWithAPointAFrame) {
  const PlotSheet sheet = compare_plots("scene", some_rows(), 0.1);
  EXPECT_GE(sheet.plots.size(), 6U);
  for (const Plot& plot : sheet.plots) {
    ASSERT_EQ(plot.series.size(), 2U);
    EXPECT_EQ(plot.series[0].name, "bad");
    EXPECT_EQ(plot.series[0].x, (std::vector<double>{0, 0.1, 0.2}));
  }
  EXPECT_NEAR(sheet.plots[0].series[0].y[2], 3, 1e-12);
  EXPECT_NE(sheet.plots[0].note.find("10 of 100 markers"), std::string::npos);
  EXPECT_NE(sheet.title.find("max_slip 0"), std::string::npos);
}

using CompareFiles = IoTest;

TEST_F(CompareFiles, CsvHasAHeaderAndARowForEach) {
  write_compare_csv(path("compare.csv"), some_rows());
  std::istringstream lines(read_text(path("compare.csv")));
  std::string header, line;
  std::getline(lines, header);
  EXPECT_EQ(header.substr(0, 18), "frame,time,method,");
  int rows = 0;
  while (std::getline(lines, line)) {
    ++rows;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), std::count(header.begin(), header.end(), ','));
  }
  EXPECT_EQ(rows, 6);
}

TEST_F(CompareFiles, MarkdownNamesTheBestFirst) {
  write_compare_markdown(path("compare.md"), {"my scene", 0.1, "the truth", 0.02, true, false}, some_rows());
  const std::string text = read_text(path("compare.md"));
  EXPECT_LT(text.find("| 1 | good |"), text.find("| 2 | bad |"));
  EXPECT_NE(text.find("10 of 100 markers"), std::string::npos);
  EXPECT_NE(text.find("compare_sheet.png"), std::string::npos);
  EXPECT_EQ(text.find("compare.mp4"), std::string::npos);
  EXPECT_NE(text.find("max_slip is 0"), std::string::npos);
  EXPECT_NE(text.find("max_slip = 0.02 m"), std::string::npos);
}

TEST(CompareTiles, StandBelowTheirLabelsInAnEvenGrid) {
  for (const int count : {1, 2, 3, 4, 5, 9}) {
    std::vector<Image> tiles;
    for (int i = 0; i < count; ++i)
      tiles.push_back({51, 31, std::vector<Color>(51 * 31, Color{std::uint8_t(10 * i), 200, 0})});
    const Image sheet = label_tiles(tiles, Names(std::size_t(count), "name"));
    EXPECT_EQ(sheet.width % 2, 0);
    EXPECT_EQ(sheet.height % 2, 0);
    std::vector<int> pixels(std::size_t(count), 0);
    for (const Color& color : sheet.pixels)
      if (color[1] == 200 && color[2] == 0) ++pixels[color[0] / 10];
    for (const int found : pixels) EXPECT_EQ(found, 51 * 31) << count;
  }
  EXPECT_EQ(label_tiles({}, {}).width, 0);
}

scenes::Scene turning_ball() {
  scenes::Scene scene;
  scene.particles.source = scenes::ParticlesSpec::Source::prescribed;
  scene.particles.spacing = 0.1;
  scene.particles.motion.type = "rotation";
  scene.particles.motion.angular_velocity = {0, 2, 0.5};
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      for (int k = -3; k <= 3; ++k)
        if (i * i + j * j + k * k < 10) scene.particles.positions.emplace_back(0.1 * i, 0.1 * j, 0.1 * k);
  return scene;
}

/// The markers at time 0.5 when the truth knows the motion, or only the particles.
tracking::Markers markers_of_ball(bool exact) {
  scenes::Scene scene = turning_ball();
  const auto source = scenes::make_source(scene);
  const tracking::Particles start = to_particles(source->state());
  const tracking::Tracker tracker(scenes::settings_in_metres(scene), start);
  if (!exact) scene.particles.source = scenes::ParticlesSpec::Source::simulation;
  GroundTruth truth(scene, tracker.settings(), start);
  truth.start_markers(tracker.mesh());
  for (int step = 1; step <= 10; ++step) {
    source->advance_to(0.05 * step);
    truth.advance(to_particles(source->state()));
  }
  EXPECT_EQ(truth.description().find("prescribed") != std::string::npos, exact);
  return truth.markers();
}

TEST(GroundTruth, ExactMotionAndParticlesAgreeOnARotation) {
  const tracking::Markers exact = markers_of_ball(true), by_particles = markers_of_ball(false);
  ASSERT_GT(exact.ids.size(), 100U);
  ASSERT_EQ(exact.ids, by_particles.ids);
  EXPECT_EQ(exact.on_surface(), int(exact.ids.size()));
  const Vec3 spin(0, 2, 0.5);
  const Eigen::AngleAxisd turn(0.5 * spin.norm(), spin.normalized());
  for (std::size_t i = 0; i < exact.ids.size(); ++i) {
    EXPECT_LT((exact.positions[i] - turn * exact.rest_positions[i]).norm(), 1e-9);
    EXPECT_LT((exact.positions[i] - by_particles.positions[i]).norm(), 1e-5);
  }
}

TEST_F(CompareFiles, NoMethodIsHelpedByMaxSlip) {
  const auto table_with = [&](double max_slip) {
    scenes::Scene scene = turning_ball();
    scene.tracking.velocity = "normal";  // does not follow the rotation, so that its texture is held back at once
    scene.tracking.max_slip = max_slip;
    const RunDirectory directory(path(std::to_string(max_slip)));
    std::filesystem::create_directories(directory.root());
    const auto source = scenes::make_source(scene);
    const tracking::Particles start = to_particles(source->state());
    tracking::Tracker own(scenes::settings_in_metres(scene), start);
    StageClock clock;
    Comparison comparison(scene, directory, methods_to_compare("normal,affine"), own, start, clock);
    for (int frame = 1; frame <= 3; ++frame) {
      source->advance_to(0.1 * frame);
      const tracking::Particles particles = to_particles(source->state());
      own.advance(particles);
      comparison.advance(particles, 0);
      comparison.record(frame, {}, {});
    }
    EXPECT_EQ(own.report().held_back > 0, max_slip > 0);
    std::string table;
    std::istringstream lines(read_text(directory.compare_csv()));
    for (std::string line; std::getline(lines, line);) table += line.substr(0, line.rfind(',')) + '\n';  // no seconds
    return table;
  };
  EXPECT_EQ(table_with(0.05), table_with(0));
}

}  // namespace
}  // namespace flowskin::tools::compare_test
