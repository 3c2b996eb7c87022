// Seconds of wall time per named stage.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/stopwatch.h"

namespace flowskin::tools {

/// Adds up the time of each stage, in the order in which the stages first ran.
class StageClock {
 public:
  /// Runs `work` and books its time under `stage`; returns what it returns.
  template <class Work>
  auto time(const std::string& stage, Work&& work) {
    struct Booking {
      StageClock& clock;
      const std::string& stage;
      double start = wall_seconds();
      ~Booking() { clock.add(stage, wall_seconds() - start); }
    } booking{*this, stage};
    return std::forward<Work>(work)();
  }

  void add(const std::string& stage, double seconds) {
    for (auto& [name, total] : stages_)
      if (name == stage) {
        total += seconds;
        return;
      }
    stages_.emplace_back(stage, seconds);
  }

  /// Seconds so far; 0 for a stage that never ran.
  double seconds(const std::string& stage) const {
    for (const auto& [name, total] : stages_)
      if (name == stage) return total;
    return 0;
  }

  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

  template <class Archive>
  void visit(Archive& archive) {
    archive(stages_);
  }

 private:
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace flowskin::tools
