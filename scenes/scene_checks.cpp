#include "scenes/scene_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

#include "common/errors.h"
#include "scenes/io/obj_reader.h"
#include "scenes/io/read_bytes.h"
#include "scenes/nearest_name.h"

namespace flowskin::scenes {
namespace {

using ParticleOrigin = ParticlesSpec::Source;

/// More particles than this are a slip of the spacing: they would need tens of gigabytes.
constexpr double max_particles = 1e8;

/// Reports problems at the place of a key, or of the object around it where the key is not there.
class Checker {
 public:
  Checker(const JsonNode& root, Problems& problems) : root_(root), problems_(problems) {}

  void require(bool condition, const std::string& path, const std::string& message) {
    if (!condition) problems_.add(offset(root_, path), path + " " + message);
  }
  /// For a key of an entry of a list.
  void require(bool condition, const std::string& list, std::size_t index, const std::string& key,
               const std::string& message) {
    if (condition) return;
    const std::string path = join_path(fmt::format("{}[{}]", list, index), key);
    const JsonNode* entries = root_.find(list);
    const bool there = entries && index < entries->children.size();
    problems_.add(there ? offset(entries->children[index], key) : root_.offset, path + " " + message);
  }

 private:
  static std::size_t offset(const JsonNode& node, std::string path) {
    while (!path.empty()) {
      if (const JsonNode* found = find_path(node, path)) return found->offset;
      path = path.substr(0, path.rfind('.') == std::string::npos ? 0 : path.rfind('.'));
    }
    return node.offset;
  }

  const JsonNode& root_;
  Problems& problems_;
};

bool is_ordered(const sph::Box& box) { return (box.min.array() < box.max.array()).all(); }

void check_body(const Scene& scene, std::size_t i, Checker& checker) {
  const sph::FluidBody& body = scene.bodies[i].body;
  const double cell = std::pow(scene.particles.spacing, 3);
  const std::string smaller = "must be smaller than max along every axis";
  const std::string too_many =
      fmt::format("makes the body more than {:.0g} particles at particles.spacing {} m; make that larger",
                  max_particles, number_text(scene.particles.spacing));
  if (body.shape == sph::FluidBody::Shape::block) {
    checker.require(is_ordered(body.block), "bodies", i, "min", smaller);
    checker.require((body.block.max - body.block.min).prod() / cell <= max_particles, "bodies", i, "max", too_many);
  } else if (body.shape == sph::FluidBody::Shape::ball) {
    checker.require(4.2 * std::pow(body.radius, 3) / cell <= max_particles, "bodies", i, "radius", too_many);
  }
  for (std::size_t k = 0; k < body.cuts.size(); ++k) {
    checker.require(is_ordered(body.cuts[k]), "bodies", i, "cuts",
                    fmt::format("has an entry {} whose min is not smaller than its max along every axis", k));
  }
  if (scene.particles.source == ParticleOrigin::prescribed) {
    const std::string message =
        "has no meaning with particles.source \"prescribed\": particles.motion gives the velocity";
    checker.require(body.velocity.isZero(0), "bodies", i, "velocity", message);
    checker.require(body.angular_velocity.isZero(0), "bodies", i, "angular_velocity", message);
  }
}

void check_particles(const Scene& scene, Checker& checker) {
  const bool has_bodies = !scene.bodies.empty(), has_positions = !scene.particles.positions.empty();
  if (scene.particles.source == ParticleOrigin::simulation) {
    checker.require(has_bodies || !scene.emitters.empty(), "bodies",
                    "is empty and there are no emitters: nothing to simulate; give at least one body or emitter");
  } else if (scene.particles.source == ParticleOrigin::prescribed) {
    checker.require(has_bodies || has_positions, "bodies",
                    "is empty and there are no particles.positions: nothing moves; give one of the two");
    checker.require(!(has_bodies && has_positions), "particles.positions",
                    "and bodies are both given; give one of the two");
    checker.require(!scene.particles.motion.axis.isZero(0), "particles.motion.axis", "is zero; expected a direction");
    checker.require(!(has_positions && scene.particles.jitter > 0), "particles.jitter",
                    "displaces the lattice of bodies; it has no meaning with particles.positions");
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) check_body(scene, i, checker);
}

void check_periods(const Scene& scene, Checker& checker) {
  const sph::SolverSettings& solver = scene.solver;
  const double shortest = 2 * solver.support_radius * scene.particles.spacing;
  bool any = false;
  for (int a = 0; a < 3; ++a) {
    any = any || solver.periodic[a];
    const double period = solver.domain.max[a] - solver.domain.min[a];
    checker.require(!solver.periodic[a] || period >= shortest * (1 - 1e-9), "simulation.periodic",
                    fmt::format("is true for {}, where simulation.domain is {} m long; expected at least twice the "
                                "support radius, {} m",
                                "xyz"[a], number_text(period), number_text(shortest)));
  }
  checker.require(!any || !scene.tracking.enabled, "simulation.periodic",
                  "leaves the surface open where the fluid leaves the domain, and surfaces are not tracked across "
                  "it; set tracking.enabled to false");
}

void check_fluids(const Scene& scene, Checker& checker) {
  checker.require(scene.fluids.size() <= 255, "fluids", "has more than 255 entries");
  if (scene.fluids.size() > 255) return;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.fluids.size(); ++i) {
    const std::string& name = scene.fluids[i].name;
    checker.require(!name.empty(), "fluids", i, "name", "is empty");
    checker.require(std::find(names.begin(), names.end(), name) == names.end(), "fluids", i, "name",
                    fmt::format("\"{}\" is that of an earlier fluid; give each one its own", name));
    names.push_back(name);
  }
  const auto known = [&](const std::string& list, std::size_t i, const std::string& name) {
    const std::string there =
        names.empty() ? "there are no fluids" : "fluids has " + fmt::format("{}", fmt::join(names, ", "));
    checker.require(name.empty() || std::find(names.begin(), names.end(), name) != names.end(), list, i, "fluid",
                    fmt::format("names \"{}\", but {}{}", name, there, did_you_mean(name, names)));
  };
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) known("bodies", i, scene.bodies[i].body.fluid);
  for (std::size_t i = 0; i < scene.emitters.size(); ++i) known("emitters", i, scene.emitters[i].emitter.fluid);
  bool mixture = scene.fluids.size() > 1 || !scene.rheology.is_newtonian();
  for (const sph::Fluid& fluid : scene.fluids) mixture = mixture || !fluid.rheology.is_newtonian();
  checker.require(!mixture || scene.solver.viscosity_form == sph::ViscosityForm::monaghan, "simulation.viscosity_form",
                  "must be \"monaghan\" with several fluids or a viscosity that depends on the shear rate");
}

void check_solver(const Scene& scene, Checker& checker) {
  const sph::SolverSettings& solver = scene.solver;
  checker.require((solver.domain.min.array() <= solver.domain.max.array()).all(), "simulation.domain.min",
                  "must not be greater than simulation.domain.max along any axis");
  check_periods(scene, checker);
  checker.require(solver.speed_of_sound == 0 || solver.speed_of_sound > solver.max_speed, "simulation.speed_of_sound",
                  "must be larger than simulation.max_speed (ten times as large keeps the density within 1 %)");
  for (std::size_t i = 0; i < scene.emitters.size(); ++i) {
    const sph::Emitter& emitter = scene.emitters[i].emitter;
    checker.require(!emitter.direction.isZero(0), "emitters", i, "direction", "is zero; expected a direction");
    checker.require(emitter.start < emitter.stop, "emitters", i, "stop", "must be later than start");
    checker.require(
        emitter.shape != sph::Emitter::Shape::rectangle || emitter.up.isZero(0) ||
            emitter.up.cross(emitter.direction).norm() > 1e-6 * emitter.up.norm() * emitter.direction.norm(),
        "emitters", i, "up", "is along direction; expected a direction across it");
  }
  for (std::size_t i = 0; i < scene.sinks.size(); ++i) {
    const sph::Sink& sink = scene.sinks[i].sink;
    checker.require(sink.start < sink.stop, "sinks", i, "stop", "must be later than start");
    checker.require(sink.shape != sph::Sink::Shape::box || is_ordered(sink.box), "sinks", i, "min",
                    "must be smaller than max along every axis");
  }
  for (std::size_t i = 0; i < scene.boundaries.size(); ++i) {
    checker.require(scene.boundaries[i].boundary.adhesion == 0 || solver.surface_tension > 0, "boundaries", i,
                    "adhesion", "is a share of fluid.surface_tension, which is 0; give that too");
  }
}

void check_boundaries(const Scene& scene, Checker& checker) {
  for (std::size_t i = 0; i < scene.boundaries.size(); ++i) {
    const std::vector<sph::Keyframe>& keys = scene.boundaries[i].boundary.motion.keyframes;
    for (std::size_t k = 1; k < keys.size(); ++k) {
      checker.require(keys[k].time > keys[k - 1].time, "boundaries", i, "keyframes",
                      fmt::format("has an entry {} whose time is not later than that of the one before it", k));
    }
  }
}

void check_pictures(const Scene& scene, Checker& checker) {
  const CameraSpec& camera = scene.render.camera;
  checker.require(!scene.texture.axis.isZero(0), "texture.axis", "is zero; expected a direction");
  checker.require(!scene.render.light_direction.isZero(0), "render.light_direction", "is zero; expected a direction");
  checker.require(!camera.up.isZero(0), "render.camera.up", "is zero; expected a direction");
  const Vec3 view = camera.look_at - camera.position;
  const bool automatic = camera.position.isZero(0) && camera.look_at.isZero(0);
  checker.require(automatic || !view.isZero(0), "render.camera.look_at", "is the same point as render.camera.position");
  const double sine = view.cross(camera.up).norm();
  checker.require(view.isZero(0) || camera.up.isZero(0) || sine > 1e-6 * view.norm() * camera.up.norm(),
                  "render.camera.up", "is the direction in which the camera looks; expected one across it");
}

/// `; did you mean "stairs.obj"?` from the files beside a missing one.
std::string near_file(const std::filesystem::path& file) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator it(file.parent_path(), error), end; !error && it != end;
       it.increment(error)) {
    if (names.size() < 1000) names.push_back(it->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return did_you_mean(file.filename().string(), names);
}

void load_mesh(const Scene& scene, const MeshPlacement& placement, const std::string& list, std::size_t i,
               sph::TriangleMesh& mesh, Checker& checker) {
  const std::filesystem::path file = absolute_name(scene.directory, placement.file);
  std::error_code error;
  if (std::filesystem::status(file, error).type() == std::filesystem::file_type::not_found) {
    checker.require(false, list, i, "file",
                    fmt::format("names {}, which does not exist{}", file.string(), near_file(file)));
    return;
  }
  try {
    mesh = place(read_obj(file), placement);
  } catch (const InputError& problem) {
    checker.require(false, list, i, "file", std::string("cannot be read: ") + problem.what());
    return;
  }
  for (const Vec3& p : mesh.positions) {
    if (p.cwiseAbs().maxCoeff() <= max_recorded_coordinate) continue;
    checker.require(false, list, i, "file",
                    fmt::format("places a vertex of {} at ({:.4g}, {:.4g}, {:.4g}) m, farther out than {:g} m; does it "
                                "stray?",
                                file.string(), p.x(), p.y(), p.z(), max_recorded_coordinate));
    return;
  }
}

}  // namespace

std::string current_folder() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::current_path(error);
  if (error) throw InputError("the current folder cannot be found (was it removed?): " + error.message());
  return folder.string();
}

std::string absolute_name(const std::string& directory, const std::string& file) {
  if (file.empty()) return file;
  const std::filesystem::path path(file);
  if (path.is_absolute()) return path.lexically_normal().string();
  const std::filesystem::path relative = std::filesystem::path(directory) / path;
  std::error_code no_current_folder;  // then the name stays relative, and opening it says what is wrong
  const std::filesystem::path absolute = std::filesystem::absolute(relative, no_current_folder);
  return (no_current_folder ? relative : absolute).lexically_normal().string();
}

void check_consistency(const Scene& scene, const JsonNode& root, Problems& problems) {
  Checker checker(root, problems);
  check_particles(scene, checker);
  check_solver(scene, checker);
  check_boundaries(scene, checker);
  check_fluids(scene, checker);
  check_pictures(scene, checker);
}

void load_files(Scene& scene, const JsonNode& root, Problems& problems) {
  Checker checker(root, problems);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    BodySpec& body = scene.bodies[i];
    if (body.body.shape != sph::FluidBody::Shape::mesh) continue;
    load_mesh(scene, body.mesh, "bodies", i, body.body.mesh, checker);
  }
  for (std::size_t i = 0; i < scene.emitters.size(); ++i) {
    EmitterSpec& emitter = scene.emitters[i];
    if (emitter.emitter.shape != sph::Emitter::Shape::mesh) continue;
    load_mesh(scene, emitter.mesh, "emitters", i, emitter.emitter.mesh, checker);
  }
  for (std::size_t i = 0; i < scene.sinks.size(); ++i) {
    SinkSpec& sink = scene.sinks[i];
    if (sink.sink.shape != sph::Sink::Shape::mesh) continue;
    load_mesh(scene, sink.mesh, "sinks", i, sink.sink.mesh, checker);
  }
  for (std::size_t i = 0; i < scene.boundaries.size(); ++i) {
    BoundarySpec& boundary = scene.boundaries[i];
    load_mesh(scene, boundary.mesh, "boundaries", i, boundary.boundary.mesh, checker);
  }
  const std::string& image = scene.texture.image;
  if (image != "checker" && image != "marble") {
    const std::string file = absolute_name(scene.directory, image);
    try {
      require_regular_file(file);
    } catch (const InputError& problem) {
      std::string near = did_you_mean(image, {"checker", "marble"});
      if (near.empty()) near = near_file(file);
      checker.require(false, "texture.image",
                      fmt::format("is neither checker nor marble nor an image file: {}{}", problem.what(), near));
    }
  }
}

}  // namespace flowskin::scenes
