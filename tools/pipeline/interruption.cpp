#include "tools/pipeline/interruption.h"

#include <csignal>

#include "scenes/io/atomic_file.h"

namespace flowskin::tools {

namespace {

volatile std::sig_atomic_t interruption_signal = 0;

void on_signal(int signal) {
  if (interruption_signal == 0) {
    interruption_signal = signal;
    return;
  }
  scenes::remove_drafts();
  std::signal(signal, SIG_DFL);
  std::raise(signal);  // comes when this handler returns
}

void catch_signal(int signal) {
  struct sigaction before {};
  if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void catch_interruptions() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) catch_signal(signal);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return interruption_signal != 0; }

std::string interruption_name() {
  switch (interruption_signal) {
    case 0:
      return "";
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    default:
      return "SIGHUP";
  }
}

int InterruptedError::exit_status() { return 128 + int(interruption_signal); }

}  // namespace flowskin::tools
