// The numbers of compare.csv: how well a velocity method does in one frame.
#pragma once

#include "tools/pipeline/ground_truth.h"
#include "tools/report/compare_csv.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

/// Measures meshes against the truth at its present time.
class MethodMeasures {
 public:
  /// @param reach how far from a marker its closest point may be (m)
  MethodMeasures(const GroundTruth& truth, double reach);

  /// Fills in all columns but the frame, the method, and what adds up over the steps of a frame.
  /// @param tracker of the method, at the truth's time
  void add_to(CompareRow& row, const tracking::Tracker& tracker) const;

 private:
  const GroundTruth& truth_;
  double reach_;
  tracking::MetaballField field_;
  tracking::Flow flow_;
  CompareRow of_markers_;  // what is the same for all methods
};

}  // namespace flowskin::tools
