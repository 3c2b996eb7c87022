// The worst of a run in one line of the log.
#pragma once

#include <string>
#include <vector>

#include "tools/report/frames_csv.h"

namespace flowskin::tools {

/// The worst value over the rows of each measure of the surface, and the frame that has it; empty where no row has a
/// surface. Ids are counted twice: of those of the frame before, from the second row on, the worst; and how many of the
/// first frame's are there at the end.
/// @param edge_length of the tracked mesh (m)
std::string worst_frames(const std::vector<FrameRow>& rows, double edge_length);

}  // namespace flowskin::tools
