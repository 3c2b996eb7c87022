// A scene as read from its file, all defaults filled in. SI units; lengths are absolute unless a comment says
// otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sph/solver.h"
#include "tracking/tracker.h"

namespace flowskin::scenes {

using sph::Vec3;

/// Placing of a mesh file: scaled, then rotated (degrees about x, then y, then z), then translated (m).
struct MeshPlacement {
  std::string file;  ///< OBJ; relative to the scene file.
  Vec3 scale{1, 1, 1};
  Vec3 rotate = Vec3::Zero();
  Vec3 translate = Vec3::Zero();
};

struct BodySpec {
  sph::FluidBody body;  ///< With its mesh already read and placed.
  MeshPlacement mesh;   ///< shape mesh only
};

struct BoundarySpec {
  sph::Boundary boundary;  ///< With its mesh already read and placed.
  MeshPlacement mesh;
  bool visible = true;                            ///< Drawn in the pictures.
  std::array<double, 3> color{0.55, 0.53, 0.50};  ///< Linear reflectance, 0 to 1.
};

struct EmitterSpec {
  sph::Emitter emitter;  ///< With its mesh already read and placed.
  MeshPlacement mesh;    ///< shape mesh only
};

struct SinkSpec {
  sph::Sink sink;      ///< With its mesh already read and placed.
  MeshPlacement mesh;  ///< shape mesh only
};

/// Prescribed motion of the particles, by name, with the numbers it needs (docs/scenes.md gives the formulas).
struct MotionSpec {
  std::string type = "rotation";
  Vec3 center = Vec3::Zero();            ///< m: rotation, stretch, necking, hole
  Vec3 axis{1, 0, 0};                    ///< stretch, necking, hole; its length does not matter
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s: rotation
  Vec3 velocity = Vec3::Zero();          ///< m/s: translation (added to every motion)
  double rate = 1;                       ///< 1/s: shear, stretch, necking; m/s amplitude: vortex, deformation
  double length = 1;                     ///< m: necking (length of the neck), hole (its largest radius)
  double period = 3;                     ///< s: hole, deformation; all is back where it was after it
};

struct RecordedSpec {
  /// Files, patterns such as run/particles/frame_*.ply, folders, or one .pvd; relative to the scene file.
  std::vector<std::string> files;
  double frame_interval = 0;    ///< s between files; 0: the times in the files, else 1/30 s
  bool times_in_names = false;  ///< The numbers in the files' names are their times (s).
  enum class Ids { automatic, order, none };
  Ids ids = Ids::automatic;  ///< docs/track.md
  std::string keep;          ///< Expression that the particles must fulfil, such as "Type == 1"; empty: all.
  std::vector<Vec3> region;  ///< Two corners: only particles between them (m); empty: all.
  bool skip_invalid = false, skip_duplicates = false;
};

struct ParticlesSpec {
  enum class Source { simulation, prescribed, recorded };
  Source source = Source::simulation;
  double spacing = 0;           ///< m; must be given
  double jitter = 0;            ///< prescribed: random displacement of the lattice, in spacings
  std::vector<Vec3> positions;  ///< prescribed: explicit particles (m), instead of bodies
  MotionSpec motion;            ///< prescribed
  RecordedSpec recorded;        ///< recorded
};

/// What a scene says for the best velocity method that its particles allow.
inline constexpr const char* automatic_velocity = "auto";

/// What a vertex that fairing slides along the surface does with its material: `kept`, it takes that of its new place;
/// `dragged`, it carries its own along; `automatic`, as suits the velocity method.
enum class FairingMaterial { automatic, kept, dragged };

/// The tracker's own settings and what a scene says about tracking besides. Here the tracker's lengths count in
/// spacings and its volumes in cubes of them, as in the scene file: settings_in_metres() gives what the tracker takes.
struct TrackingSpec : tracking::TrackerSettings {
  TrackingSpec() {
    velocity = automatic_velocity;
    field.radius = 2.5;
    edge_length = 0.75;
    max_slip = -1;  // negative: max_slip_of() chooses
  }
  bool enabled = true;
  FairingMaterial fairing_material = FairingMaterial::automatic;  ///< settings_in_metres() makes fairing_drags of it.
  int steps_per_frame = 2;  ///< Particle states between two frames, one tracker step each.
  bool confidence = false;  ///< Write how well the field determines the velocity.
};

struct TextureSpec {
  std::string image = "checker";    ///< checker, marble, or an image file relative to the scene file
  std::string mapping = "box";      ///< box, planar, spherical
  double tile_size = 0;             ///< Edge of one copy of the image on the fluid (m); 0: from the size of the fluid
  Vec3 axis{0, 1, 0};               ///< planar: direction of projection; spherical: pole
  Vec3 rest_center = Vec3::Zero();  ///< Centre of the fluid at rest (m), which the mapping refers to.
  double rest_size = 0;  ///< Longest edge of its bounding box (m); 0: centre and size from the fluid at the start
  std::string when_stretched = "leave";  ///< leave, fade, solid
  double stretch_limit = 4;              ///< Factor of stretch or squeeze at which that sets in.
};

struct CameraSpec {
  Vec3 position{0, 0, 0};  ///< m; all zero: placed to see the whole scene
  Vec3 look_at{0, 0, 0};   ///< m
  Vec3 up{0, 1, 0};
  double vertical_fov = 35;  ///< degrees
};

struct RenderSpec {
  bool enabled = true;
  CameraSpec camera;
  int width = 960, height = 540;   ///< pixels
  int samples = 4;                 ///< rays per pixel
  std::string style = "textured";  ///< textured, solid (colour of the rest position), normals, confidence
  bool ground = true;              ///< A ground plane that catches shadows.
  double ground_height = 0;        ///< m
  std::array<double, 3> ground_color{0.45, 0.45, 0.45};
  Vec3 light_direction{-0.4, 1.0, 0.5};  ///< Towards the light.
  double light_size = 12;                ///< Angular diameter of the light (degrees): softness of shadows.
  double exposure = 1;
};

/// Which frames are compared with a fresh extraction: all, every tenth, or none.
enum class Checks { every, some, none };

struct OutputSpec {
  bool obj = true, ply = true, vtp = true;  ///< Formats of surface/ ...
  bool particles = true;                    ///< Whether particles/ is written.
  bool video = true;                        ///< surface.mp4 and particles.mp4, where ffmpeg is installed.
  Checks checks = Checks::some;             ///< Of the surface against a fresh extraction, for frames.csv.
  int checkpoint_interval = 10;             ///< Frames from one saved state to the next; 0: none is saved.
};

struct Scene {
  std::string name = "scene";
  std::string description;
  std::string directory;  ///< Folder of the scene file; relative file names start here.
  std::uint64_t seed = 1;
  int frames = 150;        ///< Written after the first one, which is frame 0 at time 0.
  double frame_rate = 30;  ///< 1/s
  ParticlesSpec particles;
  sph::SolverSettings solver;
  sph::Rheology rheology;          ///< Of the one fluid where there are no fluids.
  std::vector<sph::Fluid> fluids;  ///< Several fluids, instead of solver.viscosity and rheology.
  std::vector<BodySpec> bodies;
  std::vector<EmitterSpec> emitters;
  std::vector<SinkSpec> sinks;
  std::vector<BoundarySpec> boundaries;
  TrackingSpec tracking;
  TextureSpec texture;
  RenderSpec render;
  OutputSpec output;
};

}  // namespace flowskin::scenes
