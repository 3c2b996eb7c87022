// The time of a run over all processes that work on it.
#pragma once

#include <type_traits>

#include "common/state_archive.h"
#include "common/stopwatch.h"
#include "tools/report/stage_clock.h"

namespace flowskin::tools {

class RunClock {
 public:
  StageClock stages;

  /// Wall time of the run (s), without that of frames that were lost.
  double elapsed() const { return before_ + wall_seconds() - began_; }
  /// Books time that went by before this was made.
  void add_earlier(const char* stage, double seconds) {
    stages.add(stage, seconds);
    before_ += seconds;
  }

  template <class Archive>
  void visit(Archive& archive) {
    double seconds = elapsed();
    archive(seconds, stages);
    if constexpr (std::is_same_v<Archive, StateReader>) before_ += seconds;
  }

 private:
  double began_ = wall_seconds();
  double before_ = 0;  // s
};

}  // namespace flowskin::tools
