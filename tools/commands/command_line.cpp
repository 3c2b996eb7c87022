// The command line of the program; the only file that includes CLI11, which is slow to compile.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <memory>
#include <new>

#include "common/errors.h"
#include "scenes/scene_file.h"
#include "tools/commands/commands.h"
#include "tools/pipeline/interruption.h"
#include "tools/pipeline/scene_run.h"
#include "tools/pipeline/tracker_bridge.h"
#include "tools/report/run_log.h"
#include "tracking/velocity/velocity_method.h"

namespace flowskin::tools {

namespace {

constexpr int kDone = 0, kRunFailed = 1, kInputWrong = 2;
constexpr int kMaxThreads = 1024;

std::vector<std::string> method_names() {
  std::vector<std::string> names{kAutomaticVelocity};
  for (const auto& method : tracking::velocity_methods()) names.push_back(method.name);
  return names;
}

/// What the user chose, as a call that is made once the whole command line is known to be right.
struct Choice {
  RunOptions run;
  TrackOptions track;
  RenderOptions render;
  PaperOptions paper;
  ValidateOptions validate;
  bool no_pictures = false, no_video = false;
  std::vector<std::filesystem::path> info_files;
  bool scene_defaults = false, scene_keys = false, methods_table = false;
};

CLI::App* add_run(CLI::App& app, Choice& choice) {
  CLI::App* run =
      app.add_subcommand("run", "Run a scene: simulate, track the surface, write meshes, pictures and videos");
  run->add_option("scene", choice.run.scene_file, "Scene file (JSON); see docs/scenes.md")->required();
  run->add_option("--out", choice.run.out, "Run directory (default: output/<name of the scene file>)");
  run->add_option("--frames", choice.run.frames, "Number of frames after the first (default: the scene's)")
      ->check(CLI::Range(0, 1000000));
  run->add_option("--velocity", choice.run.velocity, "Velocity method (default: the scene's); see `flowskin methods`")
      ->check(CLI::IsMember(method_names()));
  run->add_option(
      "--compare", choice.run.compare,
      "Carry one mesh for each of these velocity methods (comma separated, or all) and measure their errors; "
      "see docs/compare.md");
  run->add_option("--threads", choice.run.threads, "Threads (default: all); results do not depend on it")
      ->check(CLI::Range(1, kMaxThreads));
  run->add_flag(
      "--resume", choice.run.resume,
      "Go on from the last checkpoint in the run directory, as if the run had never stopped; see docs/restart.md");
  run->add_flag("--no-pictures", choice.no_pictures, "Neither pictures nor videos");
  run->add_flag("--no-video", choice.no_video, "Pictures but no videos");
  run->add_flag("--quiet", choice.run.quiet, "No progress; warnings and errors only");
  return run;
}

CLI::App* add_track(CLI::App& app, Choice& choice) {
  TrackOptions& options = choice.track;
  CLI::App* track = app.add_subcommand(
      "track", "Track a textured surface on recorded particles of any program: CSV, PLY, VTK, VTP (docs/track.md)");
  const auto length = CLI::Range(1e-9, 1e6);
  track
      ->add_option("particles", options.particles,
                   "Files, a pattern in quotes such as 'run/p_*.vtp' or p_%04d.ply, a folder, or one .pvd; columns x, "
                   "y, z and, where there are any, velocity, id, radius")
      ->required();
  track->add_option("--out", options.run.out, "Run directory (default: output/track_<name of the files>)");
  track
      ->add_option("--spacing", options.spacing,
                   "Distance of neighbouring particles (m; default: from the radius in the files, else estimated)")
      ->check(length);
  track
      ->add_option("--radius", options.radius,
                   "Effective radius of a particle (m; default: 2.5 spacings); smaller shows more detail")
      ->check(length);
  track->add_option("--edge-length", options.edge_length, "Target edge of the mesh (m; default: 0.75 spacings)")
      ->check(length);
  auto* rate =
      track->add_option("--frame-rate", options.frame_rate, "Files a second (default: the times in the files, else 30)")
          ->check(CLI::Range(1e-5, 1e5));
  track->add_option("--time-step", options.time_step, "The same as seconds between files")
      ->check(CLI::Range(1e-5, 1e5))
      ->excludes(rate);
  track->add_option("--frames", options.run.frames, "Number of frames after the first (default: all)")
      ->check(CLI::Range(1, 1000000));
  track->add_option("--velocity", options.run.velocity, "Velocity method (default: auto); see `flowskin methods`")
      ->check(CLI::IsMember(method_names()));
  track->add_flag("--no-ids", options.no_ids, "Do not match particles from file to file, neither by id nor by order");
  track->add_option("--texture", options.texture, "checker, marble or an image file (default: checker)");
  track->add_option("--mapping", options.mapping, "How the texture is put on: box, planar or spherical (default: box)")
      ->check(CLI::IsMember({"box", "planar", "spherical"}));
  track
      ->add_option("--tile-size", options.tile_size,
                   "Edge of one copy of the texture (m; default: by the fluid's size)")
      ->check(length);
  track->add_option("--up", options.up, "Axis that points up in the pictures")
      ->check(CLI::IsMember({"y", "z"}))
      ->capture_default_str();
  track->add_option("--threads", options.run.threads, "Threads (default: all); results do not depend on it")
      ->check(CLI::Range(1, kMaxThreads));
  track->add_flag("--resume", options.run.resume,
                  "Go on from the last checkpoint in the run directory; more files may have come; see docs/restart.md");
  track->add_flag("--no-pictures", choice.no_pictures, "Neither pictures nor videos");
  track->add_flag("--no-video", choice.no_video, "Pictures but no videos");
  track->add_flag("--quiet", options.run.quiet, "No progress; warnings and errors only");
  return track;
}

CLI::App* add_render(CLI::App& app, Choice& choice) {
  RenderOptions& options = choice.render;
  CLI::App* render = app.add_subcommand("render", "Make the pictures and videos of a run again");
  render->add_option("directory", options.directory, "Run directory")->required();
  render->add_option("--width", options.width, "Pixels (default: the scene's)")->check(CLI::Range(16, 16384));
  render->add_option("--height", options.height, "Pixels (default: the scene's)")->check(CLI::Range(16, 16384));
  render->add_option("--samples", options.samples, "Rays a pixel (default: the scene's)")->check(CLI::Range(1, 4096));
  render->add_option("--camera", options.camera, "Camera position x y z (m)")->expected(3);
  render->add_option("--look-at", options.look_at, "Point the camera looks at, x y z (m)")->expected(3);
  render->add_option("--fov", options.vertical_fov, "Vertical field of view (degrees)")->check(CLI::Range(1.0, 170.0));
  render->add_option("--style", options.style, "textured, solid, normals or confidence (default: the scene's)")
      ->check(CLI::IsMember({"textured", "solid", "normals", "confidence"}));
  render->add_option("--what", options.what, "surface, particles or both")
      ->check(CLI::IsMember({"surface", "particles", "both"}))
      ->capture_default_str();
  render->add_option("--threads", options.threads, "Threads (default: all)")->check(CLI::Range(1, kMaxThreads));
  render->add_flag("--no-video", choice.no_video, "Pictures but no videos");
  render->add_flag("--quiet", options.quiet, "No progress; warnings and errors only");
  return render;
}

CLI::App* add_paper(CLI::App& app, Choice& choice) {
  PaperOptions& options = choice.paper;
  CLI::App* paper = app.add_subcommand("paper", "Repeat the paper's experiments: tables, plots, pictures, verdicts");
  paper->add_option("--out", options.out, "Folder of the results")->capture_default_str();
  paper->add_option("--scenes", options.scenes, "Folder of the experiments' scenes (default: scenes/paper)");
  paper->add_flag("--quick", options.quick, "A reduced version of some seconds");
  paper->add_option("--threads", options.threads, "Threads (default: all); results but times do not depend on it")
      ->check(CLI::Range(1, kMaxThreads));
  paper->add_flag("--quiet", options.quiet, "Warnings and errors only");
  return paper;
}

CLI::App* add_validate(CLI::App& app, Choice& choice) {
  ValidateOptions& options = choice.validate;
  CLI::App* validate = app.add_subcommand(
      "validate", "Check the solver against theory and experiment: table, plots, verdicts (docs/validation.md)");
  validate->add_option("names", options.names, "Cases (default: all); see --list");
  validate->add_option("--out", options.out, "Folder of the results")->capture_default_str();
  validate
      ->add_option("--resolution", options.resolution,
                   "Factor on the particles along each length; the tolerances are meant for 1")
      ->check(CLI::Range(0.25, 8.0))
      ->capture_default_str();
  validate->add_option("--threads", options.threads, "Threads (default: all); results do not depend on it")
      ->check(CLI::Range(1, kMaxThreads));
  validate->add_flag("--quick", options.quick, "Without the long cases");
  validate->add_flag("--list", options.list, "Only say which cases there are");
  validate->add_flag("--quiet", options.quiet, "The table only");
  return validate;
}

/// As one would type it.
std::string shell_word(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,/:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

int run_choice(int argc, const char* const* argv) {
  CLI::App app{
      "A viscous SPH fluid simulator whose surface is a tracked mesh: textures flow with the fluid.\n"
      "Start with: flowskin run scenes/stairs.json"};
  app.name("flowskin");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done; 1 the run failed; 2 the input or the command line is wrong; 130, 143 or 129 interrupted by "
      "Ctrl-C, SIGTERM or SIGHUP (--resume goes on).\n"
      "`flowskin COMMAND --help` lists a command's options.");
  Choice choice;
  for (int i = 0; i < argc; ++i) choice.run.command_line += (i ? " " : "") + shell_word(argv[i]);
  choice.track.run.command_line = choice.run.command_line;
  choice.paper.command_line = choice.run.command_line;
  CLI::App* run = add_run(app, choice);
  CLI::App* track = add_track(app, choice);
  CLI::App* render = add_render(app, choice);
  CLI::App* paper = add_paper(app, choice);
  CLI::App* validate = add_validate(app, choice);
  CLI::App* info = app.add_subcommand("info", "Say what is in a mesh, particle or scene file, and whether it is sound");
  info->add_option("files", choice.info_files, "OBJ, PLY, particle (CSV, VTK, VTP) or scene files")->required();
  CLI::App* methods = app.add_subcommand("methods", "List the velocity methods and when to use which");
  methods->add_flag("--table", choice.methods_table, "Their errors on flows that are known everywhere (Markdown)");
  CLI::App* scene = app.add_subcommand("scene", "Describe the scene file");
  auto* about = scene->add_option_group("about");
  about->add_flag("--defaults", choice.scene_defaults, "A scene with every key at its default, as JSON");
  about->add_flag("--keys", choice.scene_keys, "A table of all keys with unit, default and meaning (Markdown)");
  about->require_option(1);

  // CLI11 would only say that a subcommand is missing.
  const auto known = app.get_subcommands(nullptr);
  const auto named = [&](const CLI::App* command) { return command->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && std::none_of(known.begin(), known.end(), named))
    throw InputError(fmt::format("there is no subcommand \"{}\"; `flowskin --help` lists them", argv[1]));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kInputWrong;
  }
  if (*run) {
    choice.run.pictures = !choice.no_pictures;
    choice.run.video = !choice.no_video;
    run_scene(choice.run);
    return kDone;
  }
  if (*track) {
    choice.track.run.pictures = !choice.no_pictures;
    choice.track.run.video = !choice.no_video;
    return track_command(choice.track);
  }
  if (*render) {
    choice.render.video = !choice.no_video;
    return render_command(choice.render);
  }
  if (*paper) return paper_command(choice.paper);
  if (*validate) return validate_command(choice.validate);
  if (*info) return info_command(choice.info_files);
  if (*methods) return methods_command(choice.methods_table);
  return scene_command(choice.scene_defaults ? "defaults" : "keys");
}

int complain(const char* message, int status) {
  fmt::print(stderr, "flowskin: {}\n", message);
  return status;
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  try {
    return run_choice(argc, argv);
  } catch (const InterruptedError& error) {
    return complain(error.what(), InterruptedError::exit_status());
  } catch (const InputError& error) {
    return complain(error.what(), kInputWrong);
  } catch (const sph::SettingsError& error) {
    return complain(error.what(), kInputWrong);
  } catch (const std::bad_alloc&) {
    return complain("out of memory: use fewer particles (a larger spacing) or a larger edge_length", kRunFailed);
  } catch (const std::exception& error) {
    return complain(error.what(), kRunFailed);
  }
}

}  // namespace flowskin::tools
