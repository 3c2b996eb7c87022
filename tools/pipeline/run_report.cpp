#include "tools/pipeline/run_report.h"

#include <fmt/format.h>
#include <omp.h>

#include "scenes/settings_in_metres.h"
#include "tools/report/run_log.h"
#include "tools/report/time_table.h"
#include "tools/report/worst_frames.h"

namespace flowskin::tools {

namespace {

std::string surface_line(const tracking::Tracker& tracker) {
  const tracking::TrackerSettings& settings = tracker.settings();
  return fmt::format(
      "surface: {} vertices, velocity {}, {}, effective radius {:.4g} m, threshold {:.4g}, edge {:.4g} m, {} "
      "fairing iterations, texture slips {}",
      tracker.mesh().positions.size(), settings.velocity, name_of(tracking::kIntegratorNames, settings.integrator),
      settings.field.radius, settings.field.threshold, settings.edge_length, settings.fairing_iterations,
      settings.max_slip > 0 ? fmt::format("{:.4g} m at most", settings.max_slip) : "freely");
}

std::vector<std::string> time_lines(const scenes::Scene& scene, const scenes::ParticleSource& source,
                                    const FrameStatistics& statistics, const RunClock& clock) {
  std::vector<StageTime> stages;
  for (const auto& [stage, seconds] : clock.stages.stages()) {
    StageTime& time = stages.emplace_back(StageTime{stage, seconds});
    if (stage == "source") time.parts = source.statistics().seconds;
    if (stage == "tracking") time.parts = statistics.tracking_seconds();
  }
  return time_table(stages, scene.frames / scene.frame_rate, clock.elapsed());
}

}  // namespace

std::vector<std::string> lines_at_start(const scenes::Scene& scene, const scenes::ParticleSource& source,
                                        const TrackedSurface* surface) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("scene {}: {} frames at {} per second, {} particles, {} thread(s)", scene.name,
                              scene.frames, scene.frame_rate, source.state().positions.size(), omp_get_max_threads()));
  if (const auto summary = source.statistics().summary; !summary.empty()) lines.push_back("particles: " + summary);
  if (surface) lines.push_back(surface_line(surface->tracker()));
  return lines;
}

std::vector<std::string> lines_at_end(const scenes::Scene& scene, const scenes::ParticleSource& source,
                                      const TrackedSurface* surface, const FrameTable& table, const RunClock& clock) {
  std::vector<std::string> lines = time_lines(scene, source, table.statistics(), clock);
  lines.push_back(fmt::format("memory: {:.0f} MB at most", peak_memory()));
  if (surface) {
    lines.push_back(fmt::format("the guard extracted the surface anew in {} of {} frames",
                                table.statistics().frames_reextracted(), scene.frames));
    const std::string worst = worst_frames(table.rows(), surface->tracker().settings().edge_length);
    if (!worst.empty()) lines.push_back(worst);
  }
  const FrameRow& last = table.rows().back();
  lines.push_back(fmt::format(
      "particles that left the domain: {}; poured: {}; drained: {}; paths stopped at a wall: {}, at a narrow gap: {}",
      last.left_domain, last.emitted, last.drained, last.wall_crossings, last.kept_out_of_gaps));
  return lines;
}

}  // namespace flowskin::tools
