// What frames.csv says of a tracked surface.
#pragma once

#include <vector>

#include "common/quantile.h"
#include "tools/report/frames_csv.h"
#include "tracking/mesh/texture_stretch.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// Fills in the columns that are functions of the mesh and the particles beneath it.
/// @param field of these particles; null where there are none
/// @param is_checked whether the mesh is compared with a fresh raw extraction of the field at the same edge length, and
/// its texture with the particles' material: as much work as half of a step of the tracker
void describe_surface(const tracking::SurfaceMesh& mesh, const tracking::ImplicitField* field,
                      const tracking::Particles& particles, const tracking::TrackerSettings& settings, bool is_checked,
                      FrameRow& row);

/// The columns stretch_median and stretch_p99 of frames.csv and of compare.csv.
template <class Row>
void describe_stretch(const tracking::SurfaceMesh& mesh, Row& row) {
  std::vector<double> stretch;
  for (const auto& triangle : tracking::texture_stretch(mesh)) stretch.push_back(triangle.largest);
  row.stretch_median = quantile(stretch, 0.5);
  row.stretch_p99 = quantile(stretch, 0.99);
}

}  // namespace flowskin::tools
