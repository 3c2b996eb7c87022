// Signals: the run stops at the next safe point, so that what is written stays whole and nothing is lost.
#pragma once

#include <string>

#include "common/errors.h"

namespace flowskin::tools {

/// From now on SIGINT and SIGTERM only set a mark, and end the child that is waited for, if there is one; a second one
/// ends the program at once, without leaving half files. Signals that were ignored (nohup) stay so. A file that grows
/// past the limit of the session is an error like a full disk, not a signal that kills.
void catch_interruptions();
/// From now on SIGHUP, which comes when a terminal is closed, sets a mark of its own: work goes on. Where it is to
/// stop, it is a signal like the others, from catch_interruptions() on.
void catch_hangups(bool stop);

bool interrupted();
/// Whether a SIGHUP has come that was not taken note of.
bool hung_up();
void note_hangup();
/// The signal that set the mark, such as "SIGINT"; empty where there was none.
std::string interruption_name();

/// The run was asked to stop, and did. Exit status: 128 + the signal, as shells have it.
struct InterruptedError : RunError {
  using RunError::RunError;
  /// 130 for Ctrl-C, 143 for SIGTERM, 129 for SIGHUP.
  static int exit_status();
};

}  // namespace flowskin::tools
