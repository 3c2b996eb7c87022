#include "tools/experiments/experiment.h"

#include <algorithm>
#include <utility>

#include "scenes/io/atomic_file.h"
#include "scenes/scene_file.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {
namespace {

// The methods shown as the best ones: set them here.
// For rigid bodies, by preference: the first that is registered.
constexpr const char* kBestMethods[] = {"rigid-global", "curvature"};
// For the stair flow: all that are registered. `affine` sees the field alone, `hybrid` the particles' velocities too.
constexpr const char* kBestInFlow[] = {"affine", "hybrid"};

constexpr int kQuickWidth = 160;  // pixels

}  // namespace

std::string verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::confirmed:
      return "confirmed";
    case Verdict::in_part:
      return "confirmed in part";
    case Verdict::not_confirmed:
      break;
  }
  return "not confirmed";
}

Verdict verdict_of(const std::vector<bool>& holds) {
  const auto count = std::count(holds.begin(), holds.end(), true);
  if (count == 0) return Verdict::not_confirmed;
  return std::size_t(count) == holds.size() ? Verdict::confirmed : Verdict::in_part;
}

scenes::Scene PaperRun::scene(const std::string& name) const {
  scenes::Scene scene = scenes::read_scene(scenes / (name + ".json"));
  if (quick) {
    scene.render.height = scene.render.height * kQuickWidth / scene.render.width;
    scene.render.width = kQuickWidth;
    scene.render.samples = 1;
    scene.tracking.edge_length *= 2;
  }
  return scene;
}

void PaperRun::write_csv(const std::string& name, const ResultTable& table, ExperimentReport& report) const {
  scenes::write_file(out / (name + ".csv"), table.csv());
  report.files.push_back(name + ".csv");
}

Series PaperRun::series(const std::string& method, std::vector<double> x, std::vector<double> y) const {
  const auto place = std::find(methods.begin(), methods.end(), method) - methods.begin();
  return {method, std::move(x), std::move(y), int(place)};
}

void PaperRun::write_plot_sheet(const std::string& name, const std::string& caption, const PlotSheet& sheet,
                                ExperimentReport& report) const {
  write_plots(sheet, out / name);
  report.pictures.emplace_back(caption, name + ".png");
  report.files.push_back(name + ".svg");
}

std::vector<std::string> compared_methods() {
  std::vector<std::string> names;
  for (const auto& method : tracking::velocity_methods())
    if (method.name != "curvature-belyaev") names.push_back(method.name);
  return names;
}

std::string best_method() {
  const std::vector<std::string> names = compared_methods();
  for (const char* name : kBestMethods)
    if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  return names.back();
}

std::vector<std::string> best_methods_in_flow() {
  const std::vector<std::string> names = compared_methods();
  std::vector<std::string> best;
  for (const char* name : kBestInFlow)
    if (std::find(names.begin(), names.end(), name) != names.end()) best.emplace_back(name);
  return best;
}

}  // namespace flowskin::tools
