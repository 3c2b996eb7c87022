// Plots: ticks at round numbers, the same bytes each time, nothing left out in silence.
#include "tools/report/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/errors.h"
#include "tests/tools/io_fixture.h"
#include "tools/report/plot_axis.h"
#include "tools/textures/image.h"

namespace flowskin::tools::plot_test {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<std::string> labels_of(const Axis& axis) {
  std::vector<std::string> labels;
  for (const Tick& tick : axis.ticks)
    if (!tick.label.empty()) labels.push_back(tick.label);
  return labels;
}

using Labels = std::vector<std::string>;

TEST(PlotAxis, LinearTicksAreRound) {
  EXPECT_EQ(labels_of(make_axis(0, 1, {false, true, 0, 5})), (Labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels_of(make_axis(-3, 4.2, {false, true, 0, 4})), (Labels{"−2", "0", "2", "4"}));
  EXPECT_EQ(labels_of(make_axis(0, 0.13, {false, true, 0, 3})), (Labels{"0.00", "0.05", "0.10"}));
  const Axis small = make_axis(0, 4e-7, {false, true, 0, 4});
  EXPECT_EQ(labels_of(small), (Labels{"0", "1", "2", "3", "4"}));
  EXPECT_EQ(small.factor, "×10⁻⁷");
}

TEST(PlotAxis, LogTicksAreDecadesOrTheirParts) {
  EXPECT_EQ(labels_of(make_axis(1e-4, 10, {true, true, 0, 6})), (Labels{"10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "1", "10¹"}));
  EXPECT_EQ(labels_of(make_axis(1e-3, 10, {true, true, 0, 6})), (Labels{"0.001", "0.01", "0.1", "1", "10"}));
  EXPECT_EQ(labels_of(make_axis(0.1, 1, {true, true, 0, 6})), (Labels{"0.1", "0.2", "0.5", "1"}));
  EXPECT_EQ(labels_of(make_axis(1e-12, 1, {true, true, 0, 4})), (Labels{"10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "1"}));
}

TEST(PlotAxis, TicksAscendWithinTheRangeAndAreNeitherTooFewNorTooMany) {
  for (const bool log : {false, true}) {
    for (double high = 1.3e-9; high < 1e9; high *= 3.7) {
      for (const int most : {2, 4, 9}) {
        const Axis axis = make_axis({0.013 * high, high}, {log, true, 0.04, most});
        const std::size_t labels = labels_of(axis).size();
        EXPECT_GE(labels, 1U) << high;
        EXPECT_LE(labels, std::size_t(most) + 2) << high;
        for (std::size_t i = 0; i < axis.ticks.size(); ++i) {
          EXPECT_GE(axis.share(axis.ticks[i].value), -1e-6);
          EXPECT_LE(axis.share(axis.ticks[i].value), 1 + 1e-6);
          if (i > 0) {
            EXPECT_LT(axis.ticks[i - 1].value, axis.ticks[i].value);
          }
        }
      }
    }
  }
}

TEST(PlotAxis, RangeHoldsTheValuesThatTheAxisCanShow) {
  const std::vector<double> values{-2, 0, 3e-3, 0.2, nan_value, infinity, -infinity};
  const Axis linear = make_axis(values, {});
  EXPECT_LT(linear.low, -2);
  EXPECT_GT(linear.high, 0.2);
  EXPECT_LT(linear.high, 1);
  const Axis log = make_axis(values, {.log = true});
  EXPECT_NEAR(log.low, 2e-3, 1e-12);
  EXPECT_NEAR(log.high, 0.2, 1e-12);
  EXPECT_NEAR(log.share(0.02), 0.5, 1e-12);
  EXPECT_EQ(make_axis({0.1, 1}, {}).low, 0);
  EXPECT_GT(make_axis({0.9, 1}, {}).low, 0.8);
}

TEST(PlotAxis, NoValueOneValueAndEqualValuesHaveARange) {
  for (const bool log : {false, true}) {
    for (const std::vector<double>& values :
         std::vector<std::vector<double>>{{}, {nan_value}, {3}, {3, 3}, {0}, {-5}}) {
      const Axis axis = make_axis(values, {.log = log});
      EXPECT_LT(axis.low, axis.high);
      EXPECT_FALSE(axis.ticks.empty());
      for (const double value : values) {
        if (axis.takes(value)) {
          EXPECT_NEAR(axis.share(value), 0.5, 0.5);
        }
      }
    }
  }
}

using PlotFiles = IoTest;

Plot awkward_plot() {
  Plot plot{"Error <&> title", "time (s)", "error (m)", false, true, {}, {}, nan_value, nan_value, ""};
  plot.series = {{"falls", {0, 1, 2, 3}, {1, 0.1, 0.01, 1e-3}, -1},
                 {"gap", {0, 1, 2, 3}, {0.5, nan_value, 0.5, 0.4}, -1},
                 {"zero and negative", {0, 1, 2, 3}, {0, -1, 0.02, infinity}, -1},
                 {"one point", {1.5}, {0.3}, -1},
                 {"empty", {}, {}, -1}};
  return plot;
}

/// How often a part occurs.
std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

TEST_F(PlotFiles, AreTheSameBytesEachTime) {
  write_plot(awkward_plot(), path("first"));
  write_plot(awkward_plot(), path("second"));
  for (const char* extension : {".svg", ".png"}) {
    const std::string bytes = read_text(path(std::string("first") + extension));
    EXPECT_GT(bytes.size(), 2000U) << extension;
    EXPECT_EQ(bytes, read_text(path(std::string("second") + extension))) << extension;
  }
  EXPECT_EQ(files_in_folder(), 4U);
  EXPECT_EQ(read_text(path("first.png")).substr(1, 3), "PNG");
  EXPECT_EQ(read_image(path("first.png")).width, 2 * (640 + 24));
}

TEST_F(PlotFiles, NamesWithDotsKeepThem) {
  write_plot(awkward_plot(), path("run.1"));
  EXPECT_TRUE(std::filesystem::exists(path("run.1.svg")));
  EXPECT_TRUE(std::filesystem::exists(path("run.1.png")));
}

TEST_F(PlotFiles, SayWhatTheyLeaveOut) {
  // Text becomes glyphs, so the note shows as a difference of the pictures.
  Plot without = awkward_plot();
  without.series[2].y = {nan_value, nan_value, 0.02, nan_value};
  Plot with_note = without;
  with_note.note = "1 value left out: infinite";
  Plot only_infinite = without;
  only_infinite.series[2].y[3] = infinity;
  write_plot(without, path("without"));
  write_plot(with_note, path("note"));
  write_plot(only_infinite, path("infinite"));
  EXPECT_NE(read_text(path("without.svg")), read_text(path("infinite.svg")));
  EXPECT_EQ(read_text(path("note.svg")), read_text(path("infinite.svg")));
}

TEST_F(PlotFiles, AGapBreaksTheLine) {
  Plot whole{"", "", "", false, false, {{"", {0, 1, 2, 3, 4}, {1, 2, 3, 4, 5}, -1}}, {}, nan_value, nan_value, ""};
  Plot broken = whole;
  broken.series[0].y[2] = nan_value;
  write_plot(whole, path("whole"));
  write_plot(broken, path("broken"));
  const auto moves_of_line = [&](const char* name) {
    const std::string svg = read_text(path(name));
    const std::size_t line = svg.find("stroke:rgb(0%,44.7");
    EXPECT_NE(line, std::string::npos);
    const std::size_t data = svg.find(" d=\"", line);
    return count(svg.substr(data, svg.find("\"", data + 4) - data), "M ");
  };
  EXPECT_EQ(moves_of_line("whole.svg"), 1U);
  EXPECT_EQ(moves_of_line("broken.svg"), 2U);
}

TEST_F(PlotFiles, EmptyPlotsBarsAndSheetsAreDrawn) {
  write_plot({}, path("empty"));
  Plot bars{"bars", "", "error", false, false, {}, {"a", "b"}, nan_value, nan_value, ""};
  bars.series = {{"one", {}, {1, 2}, -1}, {"two", {}, {nan_value, -3}, -1}};
  write_plots({"sheet", {bars, awkward_plot(), awkward_plot()}, 2, 300, 200}, path("sheet"));
  const Image sheet = read_image(path("sheet.png"));
  EXPECT_EQ(sheet.width, 2 * (2 * 300 + 18 + 24));
  EXPECT_TRUE(std::filesystem::exists(path("empty.svg")));
}

TEST_F(PlotFiles, WrongInputAndPlacesAreErrors) {
  Plot plot = awkward_plot();
  plot.series[0].y.pop_back();
  EXPECT_EQ(message_of<InputError>([&] { write_plot(plot, path("x")); }),
            "plot \"Error <&> title\": series \"falls\" has 3 values, but 4 are expected");
  EXPECT_THROW(write_plots({}, path("x")), InputError);
  EXPECT_EQ(files_in_folder(), 0U);
  EXPECT_THROW(write_plot(awkward_plot(), path("no/such/folder/x")), RunError);
}

}  // namespace
}  // namespace flowskin::tools::plot_test
