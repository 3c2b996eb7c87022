// Videos and contact sheets from finished pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/textures/image.h"

namespace flowskin::tools {

/// True where an `ffmpeg` program is on the path.
bool have_ffmpeg();

/// Encodes images (pattern such as images/frame_%04d.png) to H.264 (yuv420p, opens everywhere), aside, then renames.
/// @throws RunError with the last lines of ffmpeg where it fails.
void encode_video(const std::filesystem::path& pattern, double frame_rate, const std::filesystem::path& file);

/// Rows of equally large pictures with a thin gap, each row labelled at the left and each column with its time.
Image contact_sheet(const std::vector<std::vector<Image>>& rows, const std::vector<std::string>& row_labels,
                    const std::vector<std::string>& column_labels, int picture_width);

}  // namespace flowskin::tools
