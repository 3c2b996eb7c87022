#include "tools/render/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "common/errors.h"

namespace flowskin::tools {

namespace {

std::atomic<pid_t> running_child{0};

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t got = ::read(descriptor, buffer.data(), buffer.size());
    if (got > 0) text.append(buffer.data(), static_cast<std::size_t>(got));
    if (got == 0 || (got < 0 && errno != EINTR)) return text;
  }
}

/// What the new process does between fork and exec, where only system calls are allowed. It has a process group of its
/// own: what a terminal sends when it is closed does not reach it. It ends with this program, however that ends.
/// @param failure gets the error number where the program cannot be run
[[noreturn]] void become(char* const* argv, int errors, int failure, pid_t parent, const sigset_t& signals) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it ended before the line above
  const int nothing = ::open("/dev/null", O_RDWR);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(errors, STDERR_FILENO);
  std::signal(SIGPIPE, SIG_DFL);
  ::sigprocmask(SIG_SETMASK, &signals, nullptr);
  ::execvp(argv[0], argv);
  const int error = errno;
  [[maybe_unused]] const ssize_t told = ::write(failure, &error, sizeof error);
  ::_exit(127);
}

/// Starts it with its standard error into this descriptor; signals come once kill_child() knows of it.
/// @return the error number; 0: it runs
int start(const std::vector<char*>& argv, int errors) {
  int failure[2];
  if (::pipe2(failure, O_CLOEXEC) != 0) return errno;
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t parent = ::getpid(), child = ::fork();
  if (child == 0) become(argv.data(), errors, failure[1], parent, before);
  int error = child < 0 ? errno : 0;
  if (child > 0) running_child = child;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  ::close(failure[1]);
  // exec closes the other end.
  const std::string told = read_all(failure[0]);
  ::close(failure[0]);
  if (told.size() == sizeof error) std::memcpy(&error, told.data(), sizeof error);
  return error;
}

/// Its exit status.
int wait_for_child() {
  const pid_t child = running_child;
  // Collected only after kill_child() has forgotten it: then its number may belong to another process.
  siginfo_t ended{};
  while (::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  running_child = 0;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

ChildOutcome run_child(const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw RunError(fmt::format("no pipe to {}: {}", arguments[0], std::strerror(errno)));
  const int error = start(argv, ends[1]);
  ::close(ends[1]);
  ChildOutcome outcome;
  if (error == 0) outcome.errors = read_all(ends[0]);
  if (running_child > 0) outcome.status = wait_for_child();
  if (error != 0) outcome = {-1, std::strerror(error)};
  ::close(ends[0]);
  return outcome;
}

void kill_child() noexcept {
  const pid_t child = running_child;
  if (child > 0) ::kill(child, SIGKILL);
}

}  // namespace flowskin::tools
