// The worst of a run in one line of the log.
#pragma once

#include <string>
#include <vector>

#include "tools/report/frames_csv.h"

namespace flowskin::tools {

/// The worst value over the rows of each measure of the surface, and the frame that has it; empty where no row has a
/// surface. Ids are counted from the second row on.
/// @param edge_length of the tracked mesh (m)
std::string worst_frames(const std::vector<FrameRow>& rows, double edge_length);

}  // namespace flowskin::tools
