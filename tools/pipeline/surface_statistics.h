// What frames.csv says of a tracked surface.
#pragma once

#include <vector>

#include "common/quantile.h"
#include "tools/report/frames_csv.h"
#include "tracking/mesh/texture_stretch.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// Fills in the columns that are functions of the mesh and the particles beneath it; among them a comparison with a
/// fresh raw extraction of the same field at the same edge length.
void describe_surface(const tracking::SurfaceMesh& mesh, const tracking::Particles& particles,
                      const tracking::TrackerSettings& settings, FrameRow& row);

/// The columns stretch_median and stretch_p99 of frames.csv and of compare.csv.
template <class Row>
void describe_stretch(const tracking::SurfaceMesh& mesh, Row& row) {
  std::vector<double> stretch;
  for (const auto& triangle : tracking::texture_stretch(mesh)) stretch.push_back(triangle.largest);
  row.stretch_median = quantile(stretch, 0.5);
  row.stretch_p99 = quantile(stretch, 0.99);
}

}  // namespace flowskin::tools
