// log.txt of a run: version, command, machine, settings, what happened, time per stage.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace flowskin::tools {

/// Appends lines with the time of day to a file, flushing each; important ones go to the terminal as well.
class RunLog {
 public:
  /// @throws RunError where the file cannot be opened. `quiet`: only warnings reach the terminal. `append`: goes on
  /// with a log that is there.
  RunLog(const std::filesystem::path& file, bool quiet, bool append = false);
  ~RunLog();

  void info(const std::string& message);     ///< To the file and the terminal.
  void detail(const std::string& message);   ///< To the file only.
  void warning(const std::string& message);  ///< To the file and, even if quiet, the terminal.

  /// Why lines did not reach the file (a full disk), which does not end the run; empty where all did.
  const std::string& failure() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// "flowskin 0.1.0"
std::string version_text();
/// Processor, cores, memory and operating system, on one line.
std::string machine_text();
/// The most memory that the program has had at a time until now (MB).
double peak_memory();

}  // namespace flowskin::tools
