#include "tools/pipeline/interruption.h"

#include <csignal>

#include "scenes/io/atomic_file.h"
#include "tools/render/child_process.h"

namespace flowskin::tools {

namespace {

volatile std::sig_atomic_t interruption_signal = 0, hangup = 0;
bool stops_on_hangup = false;

void on_hangup(int) { hangup = 1; }

void on_interruption(int signal) {
  kill_child();  // it would be waited for
  if (interruption_signal == 0) {
    interruption_signal = signal;
    return;
  }
  scenes::remove_drafts();
  std::signal(signal, SIG_DFL);
  std::raise(signal);  // comes when this handler returns
}

void catch_signal(int signal, void (*handler)(int)) {
  struct sigaction before {};
  if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void catch_interruptions() {
  for (const int signal : {SIGINT, SIGTERM}) catch_signal(signal, on_interruption);
  catch_signal(SIGHUP, stops_on_hangup ? on_interruption : on_hangup);
  std::signal(SIGXFSZ, SIG_IGN);
}

void catch_hangups(bool stop) {
  stops_on_hangup = stop;
  if (!stop) catch_signal(SIGHUP, on_hangup);
}

bool hung_up() { return hangup != 0; }
void note_hangup() { hangup = 0; }
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
