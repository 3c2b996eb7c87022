#include "tools/pipeline/interruption.h"

#include <csignal>

namespace flowskin::tools {

namespace {

volatile std::sig_atomic_t interruption_signal = 0;

void on_signal(int signal) {
  interruption_signal = signal;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interruptions() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() { return interruption_signal != 0; }

}  // namespace flowskin::tools
