#include "tools/pipeline/frame_table.h"

namespace flowskin::tools {

namespace {

constexpr int kSomeChecks = 10;  // frames from one check to the next

}

bool FrameTable::is_checked(int frame) const {
  return checks_ == scenes::Checks::every || (checks_ == scenes::Checks::some && frame % kSomeChecks == 0);
}

double FrameTable::since_last_row(const char* stage) {
  const double total = clock_.seconds(stage);
  return total - std::exchange(booked_[stage], total);
}

const FrameRow& FrameTable::add_frame(int frame, const scenes::ParticleSource& source, std::size_t particles,
                                      const TrackedSurface* surface, const SurfaceFrame* shown) {
  FrameRow row = clock_.time("statistics", [&] {
    FrameRow measured =
        statistics_.finish_frame(frame, source, surface ? &surface->tracker() : nullptr, shown, is_checked(frame));
    if (shown) measured.volume_outside_walls = walls_.volume_outside(shown->mesh, measured.time);
    return measured;
  });
  row.overstretched = surface ? surface->textures().overstretched() : 0;
  row.particles = particles;  // of blended states those that are written
  row.seconds_source = since_last_row("source");
  row.seconds_tracking = since_last_row("tracking");
  row.seconds_writing = since_last_row("writing");
  row.seconds_pictures = since_last_row("pictures");
  row.seconds_statistics = since_last_row("statistics");
  rows_.push_back(row);
  try {
    write_frames_csv(file_, rows_);
  } catch (...) {
    drop_frame();
    throw;
  }
  return rows_.back();
}

}  // namespace flowskin::tools
