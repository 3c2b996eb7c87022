// The table of all velocity methods on the test flows, as Markdown.
#pragma once

#include <string>

namespace flowskin::tools {

/// Two tables of relative RMS (and median) velocity error, for effective radii of 2 and 3 spacings, with the path error
/// after unit shear. Takes seconds.
std::string flow_table();

}  // namespace flowskin::tools
