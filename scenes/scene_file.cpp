#include "scenes/scene_file.h"

#include <algorithm>
#include <cstdint>

#include "common/errors.h"
#include "scenes/io/read_bytes.h"
#include "scenes/nearest_name.h"
#include "scenes/scene_checks.h"
#include "scenes/schema/schema.h"

namespace flowskin::scenes {
namespace {

/// Far beyond any scene: a million explicit particles take 60 MB.
constexpr std::uintmax_t most_bytes = 512000000;

std::string read_text(const std::filesystem::path& file) {
  std::error_code error;
  const auto type = std::filesystem::status(file, error).type();
  if (type == std::filesystem::file_type::not_found) throw InputError(file.string() + ": there is no such scene file");
  if (type == std::filesystem::file_type::directory)
    throw InputError(file.string() + ": is not a regular file: this is a folder; expected a scene file (JSON)");
  return read_bytes(file, most_bytes);
}

std::string absolute_folder(const std::filesystem::path& folder) {
  const std::filesystem::path from = folder.is_absolute() ? "" : current_folder();
  return (from / (folder.empty() ? "." : folder)).lexically_normal().string();
}

/// File names absolute, so that the written scene means the same wherever it stands.
void make_names_absolute(Scene& scene) {
  for (BodySpec& body : scene.bodies) body.mesh.file = absolute_name(scene.directory, body.mesh.file);
  for (EmitterSpec& emitter : scene.emitters) emitter.mesh.file = absolute_name(scene.directory, emitter.mesh.file);
  for (SinkSpec& sink : scene.sinks) sink.mesh.file = absolute_name(scene.directory, sink.mesh.file);
  for (BoundarySpec& boundary : scene.boundaries) {
    boundary.mesh.file = absolute_name(scene.directory, boundary.mesh.file);
  }
  std::string& image = scene.texture.image;
  if (image != "checker" && image != "marble") image = absolute_name(scene.directory, image);
  for (std::string& file : scene.particles.recorded.files) file = absolute_name(scene.directory, file);
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& directory) {
  const JsonNode root = parse_json(text, name);
  Problems problems(name, text);
  Scene scene;
  scene.directory = absolute_folder(directory);
  KeyTable keys;
  add_scene_keys(keys, scene);
  read_object(root, keys, "", problems);
  problems.throw_if_any();
  scene.solver.spacing = scene.particles.spacing;
  check_consistency(scene, root, problems);
  problems.throw_if_any();
  load_files(scene, root, problems);
  problems.throw_if_any();
  return scene;
}

Scene read_scene(const std::filesystem::path& file) {
  return parse_scene(read_text(file), file.string(), file.parent_path());
}

std::string write_scene(const Scene& scene) {
  Scene absolute = scene;
  make_names_absolute(absolute);
  KeyTable keys;
  add_scene_keys(keys, absolute);
  return write_object(keys, 0) + "\n";
}

void set_tracking_key(TrackingSpec& tracking, const std::string& key, const std::string& value) {
  KeyTable keys;
  add_tracking_keys(keys, tracking);
  set_key(keys, "tracking." + key, value);
}

bool is_like_scene(const std::string& text) {
  JsonNode root;
  try {
    root = parse_json(text, "");
  } catch (const InputError&) {
    return true;
  }
  std::vector<std::string> known;
  for (const SceneKey& key : scene_keys()) known.push_back(key.path.substr(0, key.path.find_first_of(".[")));
  return std::any_of(root.children.begin(), root.children.end(), [&](const JsonNode& child) {
    return std::find(known.begin(), known.end(), child.key) != known.end() || !did_you_mean(child.key, known).empty();
  });
}

std::vector<SceneKey> scene_keys() {
  Scene untouched;
  KeyTable keys;
  add_scene_keys(keys, untouched);
  return document(keys);
}

}  // namespace flowskin::scenes
