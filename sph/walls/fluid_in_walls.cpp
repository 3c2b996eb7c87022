#include "sph/walls/fluid_in_walls.h"

#include <map>
#include <memory>

#include "sph/geometry/closed_parts.h"
#include "sph/setup/errors.h"

namespace flowskin::sph {

namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

// The closed walls that are not hollow, at one time.
class SolidWalls {
 public:
  SolidWalls(const std::vector<Boundary>& walls, const PeriodicBox& periodic) : walls_(walls), periodic_(periodic) {}

  // The first wall that a point is inside at a time; none.
  std::size_t around(const Vec3& p, double time) {
    if (!placed_ || time != time_) place(time);
    for (const auto& [number, parts] : parts_)
      if (contains_an_image(parts, p)) return number;
    return none;
  }

  std::string name(std::size_t number) const {
    const std::string& file = walls_[number].name;
    return "boundary " + std::to_string(number + 1) + (file.empty() ? "" : " (" + file + ")");
  }

 private:
  // Whether p or one of its periodic images lies inside.
  bool contains_an_image(const ClosedParts& parts, const Vec3& p) const {
    const Vec3& period = periodic_.period();
    const auto steps = [&](int axis) { return periodic_.along(axis) ? 1 : 0; };
    for (int i = -steps(0); i <= steps(0); ++i)
      for (int j = -steps(1); j <= steps(1); ++j)
        for (int k = -steps(2); k <= steps(2); ++k)
          if (parts.contains(p + Vec3(i * period.x(), j * period.y(), k * period.z()))) return true;
    return false;
  }

  void place(double time) {
    std::map<std::size_t, ClosedParts> parts;
    for (std::size_t w = 0; w < walls_.size(); ++w) {
      const Boundary& wall = walls_[w];
      if (wall.hollow) continue;
      const auto old = parts_.find(w);
      if (placed_ && !wall.motion.moves()) {
        if (old != parts_.end()) parts.insert(parts_.extract(old));
        continue;
      }
      ClosedParts made(placed(wall.mesh, wall.motion, time));
      if (!made.empty()) parts.emplace(w, std::move(made));
    }
    parts_ = std::move(parts);
    placed_ = true;
    time_ = time;
  }

  const std::vector<Boundary>& walls_;
  const PeriodicBox& periodic_;
  std::map<std::size_t, ClosedParts> parts_;
  bool placed_ = false;
  double time_ = 0;
};

// How many particles of something are inside, and inside which wall the first of them is.
struct Count {
  std::size_t inside = 0, all = 0, wall = none;

  bool add(std::size_t around) {
    ++all;
    if (around == none) return false;
    if (inside++ == 0) wall = around;
    return true;
  }
};

std::string sentence(const std::string& whose, const char* what, const Count& count, const SolidWalls& walls) {
  return whose + ": " + std::to_string(count.inside) + " of " + std::to_string(count.all) + what +
         " would begin inside a closed wall, " + walls.name(count.wall);
}

constexpr const char* remedy =
    "; if it is a container that is meant to hold fluid, set \"hollow\": true there, otherwise move the one or the "
    "other";

}  // namespace

std::vector<std::string> leave_out_fluid_in_walls(const std::vector<Boundary>& walls, std::size_t bodies,
                                                  const PeriodicBox& periodic, std::vector<FluidPoint>& points,
                                                  std::vector<JetEmitter>& emitters) {
  SolidWalls solid(walls, periodic);
  std::vector<std::string> found;
  const auto tell = [&](const std::string& whose, const char* what, const Count& count) {
    if (count.inside > 0) found.push_back(sentence(whose, what, count, solid));
  };
  std::vector<Count> counts(bodies);
  std::erase_if(points, [&](const FluidPoint& p) { return counts[p.body].add(solid.around(p.position, 0)); });
  for (std::size_t b = 0; b < bodies; ++b) tell("fluid body " + std::to_string(b + 1), " particles", counts[b]);
  bool some_left = !points.empty();
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    Count count;
    emitters[e].leave_out([&](const Vec3& p) { return count.add(solid.around(p, emitters[e].start())); });
    tell("emitter " + std::to_string(e + 1), " particles of each layer", count);
    some_left = some_left || count.inside < count.all;
  }
  if (!some_left && !found.empty()) throw SettingsError("no fluid is left: " + found.front() + remedy);
  for (std::string& line : found) line += ", and are left out" + std::string(remedy);
  return found;
}

}  // namespace flowskin::sph
