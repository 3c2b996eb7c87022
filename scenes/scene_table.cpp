#include "scenes/scene_table.h"

#include "scenes/scene_objects.h"
#include "scenes/sources/motion.h"

namespace flowskin::scenes {
namespace {

/// Access to a member through one to three pointers to members: at(&Scene::render, &RenderSpec::width).
template <class T, class V>
auto at(V T::*a) {
  return [a](auto& object) -> auto& { return object.*a; };
}
template <class T, class U, class V>
auto at(U T::*a, V U::*b) {
  return [ a, b ](auto& object) -> auto& { return object.*a.*b; };
}
template <class T, class U, class W, class V>
auto at(U T::*a, W U::*b, V W::*c) {
  return [ a, b, c ](auto& object) -> auto& { return object.*a.*b.*c; };
}

template <class T, class Access, class V>
Key<T> key(std::string path, Access access, Kind<V> kind, std::string unit, std::string meaning) {
  Key<T> key;
  key.path = std::move(path);
  key.type = kind.type;
  key.unit = std::move(unit);
  key.meaning = std::move(meaning);
  key.read = [access, read = kind.read](const JsonNode& node, T& object, const std::string&, Problems&) {
    access(object) = read(node);
  };
  key.write = [access, write = kind.write](const T& object, int indent) { return write(access(object), indent); };
  return key;
}

/// A list of objects with a table of their own; access(T&) is the vector of them.
template <class T, class Access, class Item>
Key<T> list(const std::string& path, Access access, const Table<Item>& table, std::string meaning) {
  Key<T> key;
  key.path = path;
  key.type = "list of objects";
  key.meaning = std::move(meaning);
  key.read = [access, table](const JsonNode& node, T& object, const std::string& own_path, Problems& problems) {
    if (node.type != JsonNode::Type::list) throw Mismatch{describe(node), ""};
    std::vector<Item>& items = access(object);
    items.clear();
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      items.emplace_back();
      read_object(node.children[i], table, fmt::format("{}[{}]", own_path, i), items.back(), problems);
    }
  };
  key.write = [access, table](const T& object, int indent) {
    const std::vector<Item>& items = access(object);
    std::string text = "[";
    for (const Item& item : items) {
      text += fmt::format("{}\n{:{}}{}", &item == &items.front() ? "" : ",", "", indent + 2,
                          write_object(item, table, indent + 2));
    }
    return text + (items.empty() ? "]" : fmt::format("\n{:{}}]", "", indent));
  };
  for (SceneKey inner : document(table)) {
    inner.path = path + "[]." + inner.path;
    key.inner.push_back(std::move(inner));
  }
  return key;
}

/// The keys that place a mesh file, for bodies and boundaries alike.
template <class T>
Table<T> placement_keys(MeshPlacement T::*mesh) {
  return {
      key<T>("file", at(mesh, &MeshPlacement::file), text(), "", "Mesh (OBJ), relative to the scene file.")
          .is_required(),
      key<T>("scale", at(mesh, &MeshPlacement::scale), scale(), "", "Factors along x, y and z, applied first."),
      key<T>("rotate", at(mesh, &MeshPlacement::rotate), vector(), "degrees",
             "Rotation about x, then y, then z, applied after the scale."),
      key<T>("translate", at(mesh, &MeshPlacement::translate), vector(), "m", "Translation, applied last."),
  };
}

/// The keys of a viscosity that depends on the shear rate; rheology(T&) is where they go.
template <class T, class Access>
Table<T> rheology_keys(const std::string& prefix, Access rheology) {
  using R = sph::Rheology;
  const auto member = [rheology](double R::*value) {
    return [ rheology, value ](auto& object) -> auto& { return rheology(object).*value; };
  };
  return {
      key<T>(prefix + "consistency", member(&R::consistency), number(at_least(0, 1e9)), "Pa s^n",
             "Consistency K of Herschel and Bulkley's law; 0: density times viscosity, with flow_index 1."),
      key<T>(prefix + "flow_index", member(&R::flow_index), number(above(0, 5)), "",
             "Flow index n: below 1 the fluid is thinner, above 1 thicker when sheared. Counts with consistency."),
      key<T>(prefix + "yield_stress", member(&R::yield_stress), number(at_least(0, 1e9)), "Pa",
             "Stress below which the fluid hardly flows."),
      key<T>(prefix + "regularization", member(&R::regularization), number(above(0, 1e9)), "s",
             "Papanastasiou's m: the fluid yields above shear rates of about 1/m."),
      key<T>(prefix + "max_viscosity", member(&R::max_viscosity), number(above(0, 1e4)), "m^2/s",
             "Greatest kinematic viscosity, that of fluid which does not yield."),
  };
}

template <class T>
void append(Table<T>& table, Table<T> more) {
  for (Key<T>& key : more) table.push_back(std::move(key));
}

Table<Scene> general_keys() {
  using S = Scene;
  return {
      key<S>("name", at(&S::name), text(), "", "Name of the scene, for messages and titles."),
      key<S>("description", at(&S::description), text(), "", "What the scene shows."),
      key<S>("seed", at(&S::seed), natural(), "", "Seed of all random numbers."),
      key<S>("frames", at(&S::frames), integer(1, 1000000), "",
             "Frames after the first one, which is frame 0 at time 0."),
      key<S>("frame_rate", at(&S::frame_rate), number(above(0, 1e5)), "1/s", "Frames a second."),
  };
}

Table<Scene> particle_keys() {
  using S = Scene;
  using P = ParticlesSpec;
  const auto particles = &S::particles;
  const auto prescribed = [](const S& s) { return s.particles.source == P::Source::prescribed; };
  const auto recorded = [](const S& s) { return s.particles.source == P::Source::recorded; };
  const auto moves_by = [prescribed](std::vector<std::string> types) {
    return [prescribed, types](const S& s) {
      return prescribed(s) && std::find(types.begin(), types.end(), s.particles.motion.type) != types.end();
    };
  };
  const std::string for_prescribed = "particles.source \"prescribed\"";
  const std::string for_recorded = "particles.source \"recorded\"";
  const auto source = choice_of<P::Source>({{"simulation", P::Source::simulation},
                                            {"prescribed", P::Source::prescribed},
                                            {"recorded", P::Source::recorded}});
  return {
      key<S>("particles.source", at(particles, &P::source), source, "", "Where the particles come from.").selecting(),
      key<S>("particles.spacing", at(particles, &P::spacing), number(above(0, 1000)), "m",
             "Distance of neighbouring particles.")
          .is_required(),
      key<S>("particles.jitter", at(particles, &P::jitter), number(at_least(0, 0.5)), "spacings",
             "Random displacement of the lattice of the bodies along each axis.")
          .only_for(for_prescribed, prescribed),
      key<S>("particles.positions", at(particles, &P::positions), points(), "m",
             "Explicit particles, instead of bodies.")
          .only_for(for_prescribed, prescribed),
      key<S>("particles.motion.type", at(particles, &P::motion, &MotionSpec::type), choice(motion_names()), "",
             "Kind of motion.")
          .selecting()
          .only_for(for_prescribed, prescribed),
      key<S>("particles.motion.center", at(particles, &P::motion, &MotionSpec::center), vector(), "m",
             "Centre of the motion.")
          .only_for("particles.motion.type \"rotation\", \"stretch\", \"necking\" or \"hole\"",
                    moves_by({"rotation", "stretch", "necking", "hole"})),
      key<S>("particles.motion.axis", at(particles, &P::motion, &MotionSpec::axis), vector(), "",
             "Direction of the stretch, of the thread or of the hole; its length does not matter.")
          .only_for("particles.motion.type \"stretch\", \"necking\" or \"hole\"",
                    moves_by({"stretch", "necking", "hole"})),
      key<S>("particles.motion.angular_velocity", at(particles, &P::motion, &MotionSpec::angular_velocity), vector(1e4),
             "rad/s", "Axis times angular speed.")
          .only_for("particles.motion.type \"rotation\"", moves_by({"rotation"})),
      key<S>("particles.motion.rate", at(particles, &P::motion, &MotionSpec::rate), number(at_least(-1e4, 1e4)),
             "1/s; vortex, deformation: m/s",
             "Rate of the shear, stretch or necking; speed of the vortex or deformation.")
          .only_for("particles.motion.type \"shear\", \"stretch\", \"necking\", \"vortex\" or \"deformation\"",
                    moves_by({"shear", "stretch", "necking", "vortex", "deformation"})),
      key<S>("particles.motion.length", at(particles, &P::motion, &MotionSpec::length), number(above(0, 1e5)), "m",
             "Length of the neck; largest radius of the hole.")
          .only_for("particles.motion.type \"necking\" or \"hole\"", moves_by({"necking", "hole"})),
      key<S>("particles.motion.period", at(particles, &P::motion, &MotionSpec::period), number(above(0, 1e5)), "s",
             "Time after which everything is back where it was.")
          .only_for("particles.motion.type \"hole\" or \"deformation\"", moves_by({"hole", "deformation"})),
      key<S>("particles.motion.velocity", at(particles, &P::motion, &MotionSpec::velocity), vector(1e4), "m/s",
             "Translation, which carries the whole motion along.")
          .only_for(for_prescribed, prescribed),
      key<S>("particles.recorded.files", at(particles, &P::recorded, &RecordedSpec::files), texts(), "",
             "Particle files (CSV, PLY, VTK, VTP): a pattern with *, ? or %04d, a folder, a .pvd, or a list of them, "
             "relative to the scene file.")
          .is_required()
          .only_for(for_recorded, recorded),
      key<S>("particles.recorded.frame_interval", at(particles, &P::recorded, &RecordedSpec::frame_interval),
             number(at_least(0, 1e5)), "s", "Time between files; 0: the times in the files, else 1/30 s.")
          .only_for(for_recorded, recorded),
      key<S>("particles.recorded.ids", at(particles, &P::recorded, &RecordedSpec::ids),
             choice({"automatic", "order", "none"}), "",
             "Who is who from file to file: automatic takes the ids in the files or, where there are none, their order "
             "if it seems to last.")
          .only_for(for_recorded, recorded),
  };
}

Table<Scene> solver_keys() {
  using S = Scene;
  using Settings = sph::SolverSettings;
  const auto solver = &S::solver;
  const auto kernel = choice_of<sph::KernelType>(
      {{"wendland_c2", sph::KernelType::wendland_c2}, {"cubic_spline", sph::KernelType::cubic_spline}});
  const auto density = choice_of<sph::DensityMethod>(
      {{"summation", sph::DensityMethod::summation}, {"continuity", sph::DensityMethod::continuity}});
  const auto viscosity = choice_of<sph::ViscosityForm>(
      {{"monaghan", sph::ViscosityForm::monaghan}, {"morris", sph::ViscosityForm::morris}});
  const auto viscosity_solver = choice_of<sph::ViscositySolver>({{"auto", sph::ViscositySolver::automatic},
                                                                 {"explicit", sph::ViscositySolver::explicit_steps},
                                                                 {"implicit", sph::ViscositySolver::implicit}});
  const auto not_explicit = [](const S& s) {
    return s.solver.viscosity_solver != sph::ViscositySolver::explicit_steps;
  };
  const auto one_fluid = [](const S& s) { return s.fluids.empty(); };
  Table<S> table = {
      list<S>("fluids", at(&S::fluids), fluid_table(),
              "Fluids of different viscosity in one scene, instead of fluid.viscosity and fluid.rheology.")
          .selecting(),
      key<S>("fluid.density", at(solver, &Settings::rest_density), number(above(0, 1e5)), "kg/m^3", "Density at rest."),
      key<S>("fluid.viscosity", at(solver, &Settings::viscosity), number(at_least(0, 1e4)), "m^2/s",
             "Kinematic viscosity: water 1e-6, honey 5e-3.")
          .only_for("scenes without fluids", one_fluid),
      key<S>("fluid.surface_tension", at(solver, &Settings::surface_tension), number(at_least(0, 1e4)), "N/m",
             "Surface tension: water 0.072, honey 0.06; 0: none."),
      key<S>("simulation.gravity", at(solver, &Settings::gravity), vector(1e4), "m/s^2", "Acceleration of gravity."),
      key<S>("simulation.kernel", at(solver, &Settings::kernel), kernel, "", "Smoothing kernel."),
      key<S>("simulation.support_radius", at(solver, &Settings::support_radius), number(at_least(1.2, 4)), "spacings",
             "Support radius of the kernel; 2 gives about 30 neighbours."),
      key<S>("simulation.max_speed", at(solver, &Settings::max_speed), number(at_least(0, 1e5)), "m/s",
             "Fastest flow expected; 0: from heights, gravity and initial velocities."),
      key<S>("simulation.speed_of_sound", at(solver, &Settings::speed_of_sound), number(at_least(0, 1e5)), "m/s",
             "Speed of sound; 0: ten times the fastest flow expected."),
      key<S>(
          "simulation.background_pressure", at(solver, &Settings::background_pressure), number(at_least(0, 1e12)), "Pa",
          "Added to the pressure everywhere, for fluid that fills its space: periodic boxes, pipes. 0: there are free "
          "surfaces; they do not pull."),
      key<S>("simulation.xsph", at(solver, &Settings::xsph), number(at_least(0, 1)), "",
             "Share of XSPH smoothing in the velocity that moves particles."),
      key<S>("simulation.viscosity_form", at(solver, &Settings::viscosity_form), viscosity, "",
             "Discrete form of the viscous force; monaghan keeps angular momentum."),
      key<S>("simulation.viscosity_solver", at(solver, &Settings::viscosity_solver), viscosity_solver, "",
             "explicit: viscosity limits the time step; implicit: a linear system every step instead; auto: implicit "
             "where the viscous limit is below a quarter of the acoustic one.")
          .selecting(),
      key<S>("simulation.viscosity_tolerance", at(solver, &Settings::viscosity_tolerance), number(at_least(1e-6, 0.1)),
             "", "Implicit viscosity: error of the velocities over their change in the step.")
          .only_for("simulation.viscosity_solver \"auto\" or \"implicit\"", not_explicit),
      key<S>("simulation.viscosity_max_iterations", at(solver, &Settings::viscosity_max_iterations),
             integer(1, 1000000), "", "Implicit viscosity: iterations after which the run stops with a message.")
          .only_for("simulation.viscosity_solver \"auto\" or \"implicit\"", not_explicit),
      key<S>("simulation.density_method", at(solver, &Settings::density_method), density, "",
             "Density by summation over the neighbours (cannot drift) or from the continuity equation.")
          .selecting(),
      key<S>("simulation.density_diffusion", at(solver, &Settings::density_diffusion), number(at_least(0, 1)), "",
             "Coefficient of the density diffusion; 0: none.")
          .only_for("simulation.density_method \"continuity\"",
                    [](const S& s) { return s.solver.density_method == sph::DensityMethod::continuity; }),
      key<S>("simulation.particle_shifting", at(solver, &Settings::particle_shifting), number(at_least(0, 2)), "",
             "Moves particles to even distances, for a constant amount of fluid that fills its space, with suction "
             "and without background pressure; 1 is a good value, 0: none.")
          .only_for("simulation.density_method \"continuity\"",
                    [](const S& s) { return s.solver.density_method == sph::DensityMethod::continuity; }),
      key<S>(
          "simulation.wall_drag", at(solver, &Settings::wall_drag), number(at_least(0, 1)), "",
          "Share of the skin friction of boundary layers thinner than a particle, for fast thin fluid that runs over "
          "dry walls: 1 as boundary-layer theory says, 0 none."),
      key<S>("simulation.acoustic_cfl", at(solver, &Settings::acoustic_cfl), number(above(0, 2)), "",
             "Time step at most this times h / (c + v): h smoothing length, c speed of sound, v speed."),
      key<S>("simulation.viscous_cfl", at(solver, &Settings::viscous_cfl), number(above(0, 1)), "",
             "Time step at most this times h^2 / viscosity."),
      key<S>("simulation.force_cfl", at(solver, &Settings::force_cfl), number(above(0, 2)), "",
             "Time step at most this times sqrt(h / a), a the largest acceleration."),
      key<S>("simulation.capillary_cfl", at(solver, &Settings::capillary_cfl), number(above(0, 2)), "",
             "Time step at most this times sqrt(density h^3 / (2 pi surface tension)).")
          .only_for("fluid.surface_tension > 0", [](const S& s) { return s.solver.surface_tension > 0; }),
      key<S>("simulation.max_time_step", at(solver, &Settings::max_time_step), number(above(0, 1e9)), "s",
             "Largest time step."),
      key<S>("simulation.skin", at(solver, &Settings::skin), number(at_least(0, 2)), "spacings",
             "Skin of the neighbour lists; 0: the recommended one."),
      key<S>("simulation.domain.min", at(solver, &Settings::domain, &sph::Box::min), vector(), "m",
             "Lower corner of the domain: particles that leave it are removed. No limit along axes where both corners "
             "are the same."),
      key<S>("simulation.domain.max", at(solver, &Settings::domain, &sph::Box::max), vector(), "m",
             "Upper corner of the domain."),
      key<S>("simulation.periodic", at(solver, &Settings::periodic), axes(), "",
             "Axes along which the domain is periodic: what leaves it comes back through the opposite face. Needs "
             "tracking.enabled false."),
  };
  Table<S> rheology = rheology_keys<S>("fluid.rheology.", at(&S::rheology));
  for (std::size_t k = 0; k < rheology.size(); ++k) {
    table.insert(table.begin() + 3 + static_cast<std::ptrdiff_t>(k),
                 std::move(rheology[k]).only_for("scenes without fluids", one_fluid));
  }
  for (Key<S>& key : table) {
    if (key.condition.empty()) key.condition = "particles.source \"simulation\"";
    key.applies = [own = key.applies](const S& s) {
      return s.particles.source == ParticlesSpec::Source::simulation && (!own || own(s));
    };
  }
  return table;
}

Table<Scene> object_keys() {
  using S = Scene;
  using Source = ParticlesSpec::Source;
  const auto simulated = [](const S& s) { return s.particles.source == Source::simulation; };
  return {
      list<S>("bodies", at(&S::bodies), body_table(), "Shapes filled with particles at the start.")
          .only_for("particles.source \"simulation\" or \"prescribed\"",
                    [](const S& s) { return s.particles.source != Source::recorded; }),
      list<S>("emitters", at(&S::emitters), emitter_table(), "Outlets that pour fluid.")
          .only_for("particles.source \"simulation\"", simulated),
      list<S>("sinks", at(&S::sinks), sink_table(), "Regions that remove the fluid which comes into them.")
          .only_for("particles.source \"simulation\"", simulated),
      list<S>("boundaries", at(&S::boundaries), boundary_table(), "Walls: open or closed surfaces."),
  };
}

Table<Scene> tracking_keys(const SceneVocabulary& vocabulary) {
  using S = Scene;
  using T = TrackingSpec;
  const auto tracking = &S::tracking;
  return {
      key<S>("tracking.enabled", at(tracking, &T::enabled), boolean(), "", "Whether a surface is tracked at all."),
      key<S>(
          "tracking.velocity", at(tracking, &T::velocity),
          choice(vocabulary.velocity_methods, "auto, or the name of a velocity method (flowskin methods lists them)"),
          "",
          "Method that gives the velocity of the surface; auto: hybrid for particles with velocities, affine for those "
          "without."),
      key<S>("tracking.integrator", at(tracking, &T::integrator), choice({"euler", "rk2", "rk4"}), "",
             "Time integration of the vertices."),
      key<S>("tracking.steps_per_frame", at(tracking, &T::steps_per_frame), integer(1, 10000), "",
             "Particle states a frame, one step of the tracker each."),
      key<S>("tracking.max_motion", at(tracking, &T::max_motion), number(above(0, 10)), "effective radii",
             "Farthest that a particle moves in a substep of the tracker."),
      key<S>("tracking.radius", at(tracking, &T::radius), number(at_least(0.5, 10)), "spacings",
             "Effective radius of a particle."),
      key<S>("tracking.threshold", at(tracking, &T::threshold), number(at_least(0, 1000)), "",
             "Threshold T of the field; 0: the one that puts a flat surface half a spacing outside the particles."),
      key<S>("tracking.wall_share", at(tracking, &T::wall_share), number(at_least(0, 0.5)), "thresholds",
             "Field on a bare wall: with it thin films on walls have a surface; 0: the field knows particles alone, as "
             "in the paper."),
      key<S>("tracking.edge_length", at(tracking, &T::edge_length), number(at_least(0.05, 20)), "spacings",
             "Edge length of an extracted mesh."),
      key<S>(
          "tracking.curvature_edges", at(tracking, &T::curvature_edges), number(at_least(0, 100)), "radii of curvature",
          "Edges are at most so long where the surface is sharply curved, down to half of edge_length; 0: all alike."),
      key<S>("tracking.smallest_part", at(tracking, &T::smallest_part), number(at_least(0, 1e9)), "cubic spacings",
             "Parts of fluid, and enclosed air, of a smaller volume are small; 0: none is."),
      key<S>("tracking.small_parts", at(tracking, &T::small_parts), choice({"keep", "drop", "balls"}), "",
             "What becomes of small parts: they stay as they are, are left out, or become balls of the same volume."),
      key<S>("tracking.fairing_iterations", at(tracking, &T::fairing_iterations), integer(0, 10000), "",
             "Iterations of fairing a step."),
      key<S>("tracking.fairing_stiffness", at(tracking, &T::fairing_stiffness), number(at_least(0, 1)), "",
             "Share of the way to the equilibrium of the springs that an iteration goes."),
      key<S>("tracking.fairing_springs", at(tracking, &T::fairing_springs), choice({"constant", "variable"}), "",
             "constant: as in the paper; variable: soft where the field determines the velocity well."),
      key<S>("tracking.confidence", at(tracking, &T::confidence), boolean(), "",
             "Write with each vertex how well the field alone determines its velocity (0 to 1)."),
      key<S>("tracking.remeshing", at(tracking, &T::remeshing), boolean(), "",
             "Split, collapse and flip edges of a stretching surface; false: a mesh of constant triangles, as in the "
             "paper."),
      key<S>("tracking.max_slip", at(tracking, &T::max_slip), number(at_least(-1, 1000)), "spacings",
             "How far the texture may slip off the particles' material; 0: any distance; negative: 1 where an emitter "
             "pours or the motion is prescribed, else any distance, as particles of a simulation mix and would make "
             "noise of the texture."),
      key<S>("tracking.topology", at(tracking, &T::topology), boolean(), "",
             "Let the surface merge, split, open and close with the fluid: regions that no longer fit are replaced."),
      key<S>("tracking.guard", at(tracking, &T::guard), boolean(), "",
             "As a last resort, where regions cannot be replaced, replace the whole surface by a fresh one."),
  };
}

Table<Scene> texture_keys() {
  using S = Scene;
  using T = TextureSpec;
  const auto texture = &S::texture;
  return {
      key<S>("texture.image", at(texture, &T::image), text(), "",
             "checker, marble, or an image file relative to the scene file."),
      key<S>("texture.mapping", at(texture, &T::mapping), choice({"box", "planar", "spherical"}), "",
             "How texture coordinates follow from rest positions."),
      key<S>("texture.tile_size", at(texture, &T::tile_size), number(at_least(0, 1e5)), "m",
             "Edge of one copy of the image on the fluid; 0: from the size of the fluid."),
      key<S>("texture.axis", at(texture, &T::axis), vector(), "",
             "Direction of projection (planar), pole (spherical)."),
      key<S>("texture.rest_center", at(texture, &T::rest_center), vector(), "m",
             "Centre of the fluid at rest, which the mapping refers to; used where rest_size is not 0."),
      key<S>("texture.rest_size", at(texture, &T::rest_size), number(at_least(0, 1e5)), "m",
             "Longest edge of the box around the fluid at rest; 0: centre and size from the particles at the start."),
      key<S>("texture.when_stretched", at(texture, &T::when_stretched), choice({"leave", "fade", "solid"}), "",
             "Where the texture is stretched past the limit: leave it, fade to a newer texture, or to the solid one."),
      key<S>("texture.stretch_limit", at(texture, &T::stretch_limit), number(above(1, 1000)), "",
             "Factor of stretch or squeeze at which that sets in; at one and a half times that it is complete."),
  };
}

Table<Scene> render_keys() {
  using S = Scene;
  using R = RenderSpec;
  using C = CameraSpec;
  const auto render = &S::render;
  const auto camera = &R::camera;
  return {
      key<S>("render.enabled", at(render, &R::enabled), boolean(), "", "Whether pictures are made."),
      key<S>("render.camera.position", at(render, camera, &C::position), vector(), "m",
             "Place of the camera; position and look_at both zero: placed to see the whole scene."),
      key<S>("render.camera.look_at", at(render, camera, &C::look_at), vector(), "m",
             "Point in the middle of the picture."),
      key<S>("render.camera.up", at(render, camera, &C::up), vector(), "", "Direction that is up in the picture."),
      key<S>("render.camera.vertical_fov", at(render, camera, &C::vertical_fov), number(at_least(1, 170)), "degrees",
             "Vertical field of view."),
      key<S>("render.width", at(render, &R::width), integer(16, 16384), "pixels", "Width of the pictures."),
      key<S>("render.height", at(render, &R::height), integer(16, 16384), "pixels", "Height of the pictures."),
      key<S>("render.samples", at(render, &R::samples), integer(1, 4096), "", "Rays a pixel."),
      key<S>("render.style", at(render, &R::style), choice({"textured", "solid", "normals", "confidence"}), "",
             "textured, solid (colour of the rest position) or normals."),
      key<S>("render.ground", at(render, &R::ground), boolean(), "", "Whether a ground plane catches shadows."),
      key<S>("render.ground_height", at(render, &R::ground_height), number(at_least(-max_coordinate, max_coordinate)),
             "m", "Height of the ground plane."),
      key<S>("render.ground_color", at(render, &R::ground_color), color(), "", "Reflectance of the ground."),
      key<S>("render.light_direction", at(render, &R::light_direction), vector(), "", "Direction towards the light."),
      key<S>("render.light_size", at(render, &R::light_size), number(at_least(0, 180)), "degrees",
             "Angular diameter of the light: softness of shadows."),
      key<S>("render.exposure", at(render, &R::exposure), number(above(0, 1000)), "", "Brightness of the pictures."),
  };
}

Table<Scene> output_keys() {
  using S = Scene;
  using O = OutputSpec;
  const auto output = &S::output;
  return {
      key<S>("output.obj", at(output, &O::obj), boolean(), "", "Write the surface as OBJ."),
      key<S>("output.ply", at(output, &O::ply), boolean(), "", "Write the surface as PLY."),
      key<S>("output.vtp", at(output, &O::vtp), boolean(), "", "Write the surface as VTP."),
      key<S>("output.particles", at(output, &O::particles), boolean(), "", "Write the particles."),
      key<S>("output.video", at(output, &O::video), boolean(), "", "Make videos, where ffmpeg is installed."),
      key<S>("output.checkpoint_interval", at(output, &O::checkpoint_interval), integer(0, 1000000), "frames",
             "The state is saved so often, and when the run is interrupted, to go on with --resume; 0: never."),
  };
}

Table<sph::Box> box_table() {
  using B = sph::Box;
  return {
      key<B>("min", at(&B::min), vector(), "m", "Lower corner.").is_required(),
      key<B>("max", at(&B::max), vector(), "m", "Upper corner.").is_required(),
  };
}

}  // namespace

Table<sph::Fluid> fluid_table() {
  using F = sph::Fluid;
  Table<F> table = {
      key<F>("name", at(&F::name), text(), "", "By which bodies and emitters refer to it.").is_required(),
      key<F>("viscosity", at(&F::viscosity), number(at_least(0, 1e4)), "m^2/s",
             "Kinematic viscosity: water 1e-6, honey 5e-3."),
  };
  append<F>(table, rheology_keys<F>("rheology.", at(&F::rheology)));
  return table;
}

Table<BodySpec> body_table() {
  using B = BodySpec;
  using F = sph::FluidBody;
  using Shape = F::Shape;
  const auto body = &B::body;
  const auto is = [](Shape shape) { return [shape](const B& b) { return b.body.shape == shape; }; };
  const auto shape = choice_of<Shape>({{"block", Shape::block}, {"ball", Shape::ball}, {"mesh", Shape::mesh}});
  const auto block = is(Shape::block), ball = is(Shape::ball), mesh = is(Shape::mesh);
  Table<B> table = {
      key<B>("shape", at(body, &F::shape), shape, "", "Shape of the body.").is_required().selecting(),
      key<B>("min", at(body, &F::block, &sph::Box::min), vector(), "m", "Lower corner.")
          .is_required()
          .only_for("shape \"block\"", block),
      key<B>("max", at(body, &F::block, &sph::Box::max), vector(), "m", "Upper corner.")
          .is_required()
          .only_for("shape \"block\"", block),
      key<B>("center", at(body, &F::center), vector(), "m", "Centre.").is_required().only_for("shape \"ball\"", ball),
      key<B>("radius", at(body, &F::radius), number(above(0, 1e5)), "m", "Radius.")
          .is_required()
          .only_for("shape \"ball\"", ball),
  };
  for (Key<B>& key : placement_keys(&B::mesh)) {
    table.push_back(std::move(key).only_for("shape \"mesh\"", mesh));
  }
  append<B>(table, {
                       list<B>("cuts", at(body, &F::cuts), box_table(), "Boxes that stay empty: slots, hollows."),
                       key<B>("velocity", at(body, &F::velocity), vector(1e4), "m/s", "Initial velocity."),
                       key<B>("angular_velocity", at(body, &F::angular_velocity), vector(1e4), "rad/s",
                              "Initial spin about the body's centroid."),
                       key<B>("fluid", at(body, &F::fluid), text(), "", "Name of its fluid; empty: the first one."),
                   });
  return table;
}

Table<EmitterSpec> emitter_table() {
  using E = EmitterSpec;
  using J = sph::Emitter;
  using Shape = J::Shape;
  const auto emitter = &E::emitter;
  const auto shape = choice_of<Shape>({{"disc", Shape::disc}, {"rectangle", Shape::rectangle}, {"mesh", Shape::mesh}});
  const auto is = [](Shape wanted) { return [wanted](const E& e) { return e.emitter.shape == wanted; }; };
  const auto plain = [](const E& e) { return e.emitter.shape != Shape::mesh; };
  const auto rectangle = is(Shape::rectangle);
  Table<E> table = {
      key<E>("shape", at(emitter, &J::shape), shape, "", "Shape of the outlet.").selecting(),
      key<E>("center", at(emitter, &J::center), vector(), "m", "Centre of the outlet.")
          .is_required()
          .only_for("shape \"disc\" or \"rectangle\"", plain),
      key<E>("direction", at(emitter, &J::direction), vector(), "",
             "Direction of the jet; its length does not matter."),
      key<E>("radius", at(emitter, &J::radius), number(above(0, 1e5)), "m", "Radius of the disc.")
          .is_required()
          .only_for("shape \"disc\"", is(Shape::disc)),
      key<E>("width", at(emitter, &J::width), number(above(0, 1e5)), "m", "Edge across up.")
          .is_required()
          .only_for("shape \"rectangle\"", rectangle),
      key<E>("height", at(emitter, &J::height), number(above(0, 1e5)), "m", "Edge along up.")
          .is_required()
          .only_for("shape \"rectangle\"", rectangle),
      key<E>("up", at(emitter, &J::up), vector(), "",
             "Direction of the edge height, made perpendicular to the jet; zero: z for jets along y, else y.")
          .only_for("shape \"rectangle\"", rectangle),
  };
  for (Key<E>& key : placement_keys(&E::mesh)) {
    table.push_back(std::move(key).only_for("shape \"mesh\"", is(Shape::mesh)));
  }
  append<E>(
      table,
      {
          key<E>("speed", at(emitter, &J::speed), number(above(0, 1e4)), "m/s", "Speed of the jet.").is_required(),
          key<E>("start", at(emitter, &J::start), number(at_least(0, 1e30)), "s", "Time at which it begins to pour."),
          key<E>("stop", at(emitter, &J::stop), number(at_least(0, 1e30)), "s", "Time at which it stops."),
          key<E>("max_particles", at(emitter, &J::max_particles), natural(), "",
                 "Most particles that it pours, in whole layers; 0: any number."),
          key<E>("fluid", at(emitter, &J::fluid), text(), "", "Name of its fluid; empty: the first one."),
      });
  return table;
}

Table<SinkSpec> sink_table() {
  using K = SinkSpec;
  using S = sph::Sink;
  using Shape = S::Shape;
  const auto sink = &K::sink;
  const auto shape = choice_of<Shape>({{"box", Shape::box}, {"ball", Shape::ball}, {"mesh", Shape::mesh}});
  const auto is = [](Shape wanted) { return [wanted](const K& k) { return k.sink.shape == wanted; }; };
  Table<K> table = {
      key<K>("shape", at(sink, &S::shape), shape, "", "Shape of the region.").is_required().selecting(),
      key<K>("min", at(sink, &S::box, &sph::Box::min), vector(), "m", "Lower corner.")
          .is_required()
          .only_for("shape \"box\"", is(Shape::box)),
      key<K>("max", at(sink, &S::box, &sph::Box::max), vector(), "m", "Upper corner.")
          .is_required()
          .only_for("shape \"box\"", is(Shape::box)),
      key<K>("center", at(sink, &S::center), vector(), "m", "Centre.")
          .is_required()
          .only_for("shape \"ball\"", is(Shape::ball)),
      key<K>("radius", at(sink, &S::radius), number(above(0, 1e5)), "m", "Radius.")
          .is_required()
          .only_for("shape \"ball\"", is(Shape::ball)),
  };
  for (Key<K>& key : placement_keys(&K::mesh)) {
    table.push_back(std::move(key).only_for("shape \"mesh\"", is(Shape::mesh)));
  }
  append<K>(table, {
                       key<K>("start", at(sink, &S::start), number(at_least(0, 1e30)), "s", "Time at which it opens."),
                       key<K>("stop", at(sink, &S::stop), number(at_least(0, 1e30)), "s", "Time at which it closes."),
                   });
  return table;
}

namespace {

Table<sph::Keyframe> keyframe_table() {
  using K = sph::Keyframe;
  return {
      key<K>("time", at(&K::time), number(at_least(-1e6, 1e6)), "s", "Later than that of the keyframe before.")
          .is_required(),
      key<K>("translate", at(&K::translate), vector(), "m", "Translation, applied last."),
      key<K>("rotate", at(&K::rotate), vector(), "degrees",
             "Rotation about x, then y, then z, about the pivot; a single angle may grow over many turns."),
  };
}

}  // namespace

Table<BoundarySpec> boundary_table() {
  using B = BoundarySpec;
  using WallMotion = sph::BoundaryMotion;
  const auto interpolation = choice_of<WallMotion::Interpolation>(
      {{"linear", WallMotion::Interpolation::linear}, {"smooth", WallMotion::Interpolation::smooth}});
  Table<B> table = placement_keys(&B::mesh);
  append<B>(
      table,
      {
          key<B>("slip", at(&B::boundary, &sph::Boundary::slip), number(at_least(0, 1)), "",
                 "0: no slip, 1: free slip; between: the share of wall friction taken away."),
          key<B>("adhesion", at(&B::boundary, &sph::Boundary::adhesion), number(at_least(0, 2)), "",
                 "Attraction of the fluid, with surface tension: contact angle 180 degrees at 0, 90 at 0.5, 0 at 1."),
          key<B>("surface_velocity", at(&B::boundary, &sph::Boundary::surface_velocity), vector(1e4), "m/s",
                 "Velocity of the surface along the wall, as of a conveyor belt."),
          list<B>("keyframes", at(&B::boundary, &sph::Boundary::motion, &WallMotion::keyframes), keyframe_table(),
                  "Motion of the wall; empty: it rests."),
          key<B>("interpolation", at(&B::boundary, &sph::Boundary::motion, &WallMotion::interpolation), interpolation,
                 "", "Between keyframes: linear, at constant speed, or smooth, from rest to rest."),
          key<B>("pivot", at(&B::boundary, &sph::Boundary::motion, &WallMotion::pivot), vector(), "m",
                 "Point that the keyframes rotate about, in the place of the mesh without them."),
          key<B>("visible", at(&B::visible), boolean(), "", "Whether it is drawn in the pictures."),
          key<B>("color", at(&B::color), color(), "", "Reflectance in the pictures."),
      });
  return table;
}

Table<Scene> scene_table(const SceneVocabulary& vocabulary) {
  Table<Scene> table = general_keys();
  append(table, particle_keys());
  append(table, solver_keys());
  append(table, object_keys());
  append(table, tracking_keys(vocabulary));
  append(table, texture_keys());
  append(table, render_keys());
  append(table, output_keys());
  return table;
}

}  // namespace flowskin::scenes
