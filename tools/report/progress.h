// Progress of a run: one line that rewrites itself on a terminal, plain lines now and then elsewhere.
#pragma once

#include <string>

namespace flowskin::tools {

class Progress {
 public:
  enum class Mode { automatic, quiet };

  /// `total` steps are to come, `before` of which are done already; `unit` is what is counted, such as "frame".
  Progress(std::string unit, int total, Mode mode, int before = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows that `done` of all steps are done; `details` is free text such as "t 1.20 s, 20000 particles".
  void update(int done, const std::string& details);
  /// Ends the line; called by the destructor as well.
  void finish();

 private:
  std::string unit_;
  int total_, before_;
  bool quiet_;
  bool terminal_;
  double start_;
  double last_shown_ = -1e9;
  std::size_t last_length_ = 0;
};

/// "45 s", "3 min 10 s", "2 h 5 min"
std::string format_duration(double seconds);

}  // namespace flowskin::tools
