// Ctrl-C and SIGTERM: asked for between frames, so that what is written stays whole.
#pragma once

namespace flowskin::tools {

/// From now on SIGINT and SIGTERM only set a mark; a second one ends the program at once.
void catch_interruptions();
bool interrupted();

}  // namespace flowskin::tools
