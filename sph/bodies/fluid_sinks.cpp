#include "sph/bodies/fluid_sinks.h"

#include "sph/geometry/mesh_inside.h"
#include "sph/setup/errors.h"

namespace flowskin::sph {

bool in_open_sink(const std::vector<Sink>& sinks, const Vec3& p, double time) {
  const auto in_box = [&](const Box& box) {
    return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
  };
  for (const Sink& sink : sinks) {
    if (time < sink.start || time >= sink.stop) continue;
    if (sink.shape == Sink::Shape::ball) {
      if ((p - sink.center).squaredNorm() <= sink.radius * sink.radius) return true;
    } else if (in_box(sink.box)) {  // shape mesh: its bounding box
      if (sink.shape == Sink::Shape::box || is_inside(sink.mesh, p)) return true;
    }
  }
  return false;
}

void check_sink(const Sink& sink, const std::string& name) {
  if (!(sink.start >= 0 && sink.stop > sink.start)) {
    throw SettingsError(name + ": it must start at 0 s or later and stop after its start");
  }
  if (sink.shape == Sink::Shape::ball && !(sink.radius > 0 && sink.center.allFinite())) {
    throw SettingsError(name + ": its radius must be greater than 0");
  }
  if (sink.shape == Sink::Shape::box && !(sink.box.min.array() < sink.box.max.array()).all()) {
    throw SettingsError(name + ": the lower corner of its box must be smaller than the upper one along every axis");
  }
  if (sink.shape == Sink::Shape::mesh && !is_closed(sink.mesh)) {
    throw SettingsError(name + ": its mesh is not closed, so it has no inside; close its holes");
  }
}

}  // namespace flowskin::sph
