// Where the particles come from: prescribed motion and recorded files.
#include <fmt/format.h>

#include "scenes/schema/schema.h"
#include "scenes/sources/motion.h"

namespace flowskin::scenes {

namespace {

using Source = ParticlesSpec::Source;

Condition source_is(const Scene& scene, Source source, const char* name) {
  return {fmt::format("particles.source \"{}\"", name), [&scene, source] { return scene.particles.source == source; }};
}

/// The names as `"a", "b" or "c"`.
std::string listed(const std::vector<std::string>& names) {
  std::string words;
  for (std::size_t k = 0; k < names.size(); ++k) {
    words += (k == 0 ? "" : k + 1 < names.size() ? ", " : " or ") + quote_json(names[k]);
  }
  return words;
}

void add_motion_keys(KeyTable& table, Scene& scene) {
  MotionSpec& motion = scene.particles.motion;
  const Condition prescribed = source_is(scene, Source::prescribed, "prescribed");
  const auto motion_is = [&](const std::vector<std::string>& types) {
    return Condition{"particles.motion.type " + listed(types), [&motion, types, prescribed] {
                       return prescribed.holds() && std::find(types.begin(), types.end(), motion.type) != types.end();
                     }};
  };
  table.name("particles.motion.type", motion.type, motion_names(), "Kind of motion.").selecting().only_for(prescribed);
  table.vector("particles.motion.center", motion.center, "m", "Centre of the motion.")
      .only_for(motion_is({"rotation", "stretch", "necking", "hole"}));
  table
      .vector("particles.motion.axis", motion.axis, "",
              "Direction of the stretch, of the thread or of the hole; its length does not matter.")
      .only_for(motion_is({"stretch", "necking", "hole"}));
  table.vector("particles.motion.angular_velocity", motion.angular_velocity, "rad/s", "Axis times angular speed.", 1e4)
      .only_for(motion_is({"rotation"}));
  table
      .number("particles.motion.rate", motion.rate, at_least(-1e4, 1e4), "1/s; vortex, deformation: m/s",
              "Rate of the shear, stretch or necking; speed of the vortex or deformation.")
      .only_for(motion_is({"shear", "stretch", "necking", "vortex", "deformation"}));
  table
      .number("particles.motion.length", motion.length, above(0, 1e5), "m",
              "Length of the neck; largest radius of the hole.")
      .only_for(motion_is({"necking", "hole"}));
  table
      .number("particles.motion.period", motion.period, above(0, 1e5), "s",
              "Time after which everything is back where it was.")
      .only_for(motion_is({"hole", "deformation"}));
  table
      .vector("particles.motion.velocity", motion.velocity, "m/s", "Translation, which carries the whole motion along.",
              1e4)
      .only_for(prescribed);
}

void add_recorded_keys(KeyTable& table, Scene& scene) {
  using Ids = RecordedSpec::Ids;
  RecordedSpec& files = scene.particles.recorded;
  const Condition recorded = source_is(scene, Source::recorded, "recorded");
  table
      .texts("particles.recorded.files", files.files,
             "Particle files (CSV, PLY, VTK, VTP): a pattern with *, ? or %04d, a folder, a .pvd, or a list of them, "
             "relative to the scene file.")
      .is_required()
      .only_for(recorded);
  table
      .number("particles.recorded.frame_interval", files.frame_interval, at_least(0, 1e5), "s",
              "Time between files; 0: the times in the files, else 1/30 s.")
      .only_for(recorded);
  table
      .boolean("particles.recorded.times_in_names", files.times_in_names,
               "The numbers in the files' names are their times (s); frame_interval counts before them.")
      .only_for(recorded);
  table
      .choice<Ids>("particles.recorded.ids", files.ids,
                   {{"automatic", Ids::automatic}, {"order", Ids::order}, {"none", Ids::none}},
                   "Which particle is which from file to file: automatic takes the ids in the files or, where there "
                   "are none, their order if it seems to last.")
      .only_for(recorded);
  table
      .text("particles.recorded.keep", files.keep,
            "Only particles whose columns fulfil this, such as \"Type == 1 and z > 0.5\"; empty: all.")
      .only_for(recorded);
  table
      .points("particles.recorded.region", files.region, "m", "Only particles between these two corners; empty: all.",
              1e9)
      .only_for(recorded);
  table
      .boolean("particles.recorded.skip_invalid", files.skip_invalid,
               "Leave out particles with values that are missing or not finite, instead of an error.")
      .only_for(recorded);
  table
      .boolean("particles.recorded.skip_duplicates", files.skip_duplicates,
               "Leave out particles whose id or place an earlier one of the same file has, instead of an error.")
      .only_for(recorded);
}

}  // namespace

void add_particle_keys(KeyTable& table, Scene& scene) {
  ParticlesSpec& particles = scene.particles;
  const Condition prescribed = source_is(scene, Source::prescribed, "prescribed");
  table
      .choice<Source>(
          "particles.source", particles.source,
          {{"simulation", Source::simulation}, {"prescribed", Source::prescribed}, {"recorded", Source::recorded}},
          "Where the particles come from.")
      .selecting();
  table.number("particles.spacing", particles.spacing, above(0, 1000), "m", "Distance of neighbouring particles.")
      .is_required();
  table
      .number("particles.jitter", particles.jitter, at_least(0, 0.5), "spacings",
              "Random displacement of the lattice of the bodies along each axis.")
      .only_for(prescribed);
  table.points("particles.positions", particles.positions, "m", "Explicit particles, instead of bodies.")
      .only_for(prescribed);
  add_motion_keys(table, scene);
  add_recorded_keys(table, scene);
}

}  // namespace flowskin::scenes
