#include "tools/experiments/ride_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tools/experiments/mesh_pictures.h"
#include "tools/render/video.h"

namespace flowskin::tools {
namespace {

constexpr int kSheetPictureWidth = 380;  // pixels

void add_checkpoint(ResultTable& table, const scenes::Scene& scene, const Ride& ride, const RideCheckpoint& at,
                    bool without_spin) {
  const RideErrors& errors = without_spin ? at.unspinning : at.errors;
  table.add({scene.name, without_spin ? std::string("without spin") : std::string("motion"), ride.settings.velocity,
             integrator_name(ride.settings.integrator), ride.settings.steps_per_period,
             ride.settings.fairing_iterations, std::string(ride.settings.variable_springs ? "variable" : "constant"),
             int(at.positions.size()), at.period, errors.back.mean, errors.back.max, errors.path, errors.end.mean,
             errors.end.max, errors.velocity_error, at.strain, at.failed});
}

}  // namespace

ResultTable ride_table() {
  ResultTable table;
  table.columns = {"scene",
                   "truth",
                   "method",
                   "integrator",
                   "steps_a_period",
                   "fairing_iterations",
                   "springs",
                   "vertices",
                   "periods",
                   "return_error_mean",
                   "return_error_max",
                   "path_error",
                   "end_error_mean",
                   "end_error_max",
                   "velocity_error",
                   "edge_strain",
                   "off_surface"};
  return table;
}

void add_ride(ResultTable& table, const scenes::Scene& scene, const Ride& ride, bool without_spin) {
  for (const RideCheckpoint& checkpoint : ride.checkpoints)
    add_checkpoint(table, scene, ride, checkpoint, without_spin);
}

void add_ride_end(ResultTable& table, const scenes::Scene& scene, const Ride& ride, bool without_spin) {
  add_checkpoint(table, scene, ride, ride.last(), without_spin);
}

const Ride& ride_of(const std::vector<Ride>& rides, const std::string& method) {
  for (const Ride& ride : rides)
    if (ride.settings.velocity == method) return ride;
  throw std::logic_error("no ride with " + method);
}

Image ride_sheet(const scenes::Scene& scene, const tracking::SurfaceMesh& start, const std::vector<Ride>& rides,
                 double largest) {
  const MaterialMotion motion(scene);
  const double unit = motion.field_settings().radius;
  std::vector<std::vector<Image>> rows(2);
  std::vector<std::string> labels{"start"};
  const MeshPainter painter(scene, start);
  rows[0].push_back(painter.textured(start));
  rows[1].push_back(painter.colored(start, std::vector<double>(start.positions.size(), 0.0), largest));
  for (const Ride& ride : rides) {
    const RideCheckpoint& end = ride.last();
    tracking::SurfaceMesh mesh = start;
    mesh.positions = end.positions;
    std::vector<double> errors;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      errors.push_back((mesh.positions[v] - motion.position(start.positions[v], end.period * motion.period())).norm() /
                       unit);
    rows[0].push_back(painter.textured(mesh));
    rows[1].push_back(painter.colored(mesh, errors, largest));
    labels.push_back(ride.settings.velocity);
  }
  return contact_sheet(rows, {"texture", fmt::format("error 0 to {:g} sigma", largest)}, labels,
                       std::min(kSheetPictureWidth, scene.render.width));
}

}  // namespace flowskin::tools
