// One mesh for each velocity method through the same simulation, each measured against the same markers.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "tools/frame_data.h"
#include "tools/pipeline/compared_method.h"
#include "tools/pipeline/comparison_pictures.h"
#include "tools/pipeline/ground_truth.h"
#include "tools/pipeline/run_directory.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/compare_csv.h"
#include "tools/report/stage_clock.h"
#include "tools/textures/texture_mapping.h"
#include "tracking/tracker.h"

namespace flowskin::tools {

class Comparison {
 public:
  /// @param methods as methods_to_compare gives them; at least one
  /// All methods are carried with max_slip 0. @param scene_tracker carries the mesh of the scene's own method; where
  /// that is among the methods and its max_slip is 0, it serves for it. Must outlive this. @param start the particles
  /// at the start, which the scene's tracker has seen.
  /// @param clock gets the time that all this takes
  Comparison(const scenes::Scene& scene, const RunDirectory& directory, const std::vector<ComparedMethod>& methods,
             const tracking::Tracker& scene_tracker, const tracking::Particles& start, StageClock& clock);

  /// Small pictures in images/ as well.
  void make_pictures(const Image& texture, const sph::Box& fluid);

  /// Carries all meshes and the markers to these particles. The scene's tracker is there already; it took
  /// `scene_tracker_seconds`.
  void advance(const tracking::Particles& particles, double scene_tracker_seconds);
  /// Measures all meshes, writes compare.csv and the pictures of this frame.
  void record(int frame, const RestFrame& rest, const ParticleFrame& particles);
  /// Plots, compare.md, the contact sheet and the video; `report` gets a line about what was made.
  void finish(const std::function<void(const std::string&)>& report) const;
  /// The ranking as a table, line by line.
  std::vector<std::string> ranking() const;

  /// What is compared with what, in one line.
  std::string description() const;

  template <class Archive>
  void visit(Archive& archive) {
    archive.section("comparison");
    archive.each(entries_);
    archive(truth_, rows_);
  }

 private:
  struct Entry {
    std::string method;                      ///< Name of what is compared.
    std::unique_ptr<tracking::Tracker> own;  ///< null: the scene's tracker
    const tracking::Tracker* tracker;
    CompareRow counts;  ///< What adds up over a frame.

    template <class Archive>
    void visit(Archive& archive) {
      archive(method, counts);
      if (own) visit_tracker(archive, *own);
    }
  };
  std::vector<std::string> names() const;
  void measure_all(int frame);
  void draw(int frame, const RestFrame& rest, const ParticleFrame& particles);

  const scenes::Scene& scene_;
  const RunDirectory& directory_;
  double scene_max_slip_;  // of the scene's own run (m)
  std::vector<Entry> entries_;
  GroundTruth truth_;
  StageClock& clock_;
  std::unique_ptr<ComparisonPictures> pictures_;
  std::vector<CompareRow> rows_;
};

}  // namespace flowskin::tools
