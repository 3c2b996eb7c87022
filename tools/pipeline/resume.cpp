#include "tools/pipeline/resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "common/errors.h"
#include "scenes/json_text.h"

namespace flowskin::tools {

namespace {

namespace fs = std::filesystem;
using scenes::JsonNode;

/// What a run may be resumed with changed. A name ending with a dot stands for all keys in this section.
constexpr std::array kFree{"name", "description", "frames", "render.", "output."};
constexpr std::array kNumerical{"simulation.max_speed",   "simulation.speed_of_sound", "simulation.acoustic_cfl",
                                "simulation.viscous_cfl", "simulation.force_cfl",      "simulation.max_time_step"};

bool is_free(const std::string& key) {
  for (const std::string_view free : kFree)
    if (key == free || (free.back() == '.' && key.starts_with(free))) return true;
  // What walls look like; and file names, since what is in the files counts.
  const bool is_wall = key.starts_with("boundaries[");
  return (is_wall && (key.ends_with(".visible") || key.ends_with(".color"))) || key.ends_with(".file") ||
         key == "particles.recorded.files" || key == "texture.image";
}

std::string value_text(const JsonNode& node) {
  switch (node.type) {
    case JsonNode::Type::null:
      return "null";
    case JsonNode::Type::boolean:
      return node.boolean ? "true" : "false";
    case JsonNode::Type::number:
    case JsonNode::Type::text:
      return node.text;
    case JsonNode::Type::list:
    case JsonNode::Type::object:
      break;
  }
  std::string text = "[";
  for (const JsonNode& child : node.children) text += (text.size() > 1 ? ", " : "") + value_text(child);
  return text + "]";
}

/// All values with their keys, such as "bodies[0].radius", in the order of the file.
void collect_values(const JsonNode& node, const std::string& path,
                    std::vector<std::pair<std::string, std::string>>& values) {
  const bool of_objects = node.type == JsonNode::Type::list && !node.children.empty() &&
                          node.children.front().type == JsonNode::Type::object;
  if (node.type != JsonNode::Type::object && !of_objects) {
    values.emplace_back(path, value_text(node));
    return;
  }
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const JsonNode& child = node.children[i];
    const std::string key = of_objects ? fmt::format("{}[{}]", path, i) : (path.empty() ? "" : path + ".") + child.key;
    collect_values(child, key, values);
  }
}

std::vector<std::pair<std::string, std::string>> values_of(const std::string& scene) {
  std::vector<std::pair<std::string, std::string>> values;
  collect_values(scenes::parse_json(scene, "the scene of the checkpoint"), "", values);
  return values;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

std::unique_ptr<Checkpoint> open_checkpoint(const RunDirectory& directory) {
  const std::string root = directory.root().string();
  std::error_code error;
  if (!fs::exists(directory.root(), error))
    throw InputError(fmt::format("there is nothing to resume: {} does not exist; leave out --resume to start", root));
  const auto newest = CheckpointFolder(directory.checkpoint_folder()).newest();
  if (!newest)
    throw InputError(
        fmt::format("there is nothing to resume: {} has no checkpoint. One is saved every output.checkpoint_interval "
                    "frames (0: never) and when the run is interrupted; leave out --resume to start anew",
                    root));
  return std::make_unique<Checkpoint>(*newest);
}

SceneChanges scene_changes(const std::string& then, const std::string& now) {
  SceneChanges changes;
  const auto old_values = values_of(then), new_values = values_of(now);
  std::map<std::string, std::string> left(old_values.begin(), old_values.end());
  for (const auto& [key, value] : new_values) {
    const auto old_value = left.find(key);
    const bool same = old_value != left.end() && old_value->second == value;
    if (!same && !is_free(key)) {
      if (old_value != left.end() && std::find(kNumerical.begin(), kNumerical.end(), key) != kNumerical.end())
        changes.numerical.push_back(fmt::format("{}: {}, now {}", key, old_value->second, value));
      else
        changes.forbidden.push_back(key);
    }
    if (old_value != left.end()) left.erase(old_value);
  }
  for (const auto& [key, value] : left)
    if (!is_free(key)) changes.forbidden.push_back(key);
  return changes;
}

std::vector<std::string> check_resumable(const Checkpoint& checkpoint, const CheckpointHeader& now, int frames) {
  const CheckpointHeader& then = checkpoint.header();
  SceneChanges changes;
  try {
    changes = scene_changes(then.scene, now.scene);
  } catch (const InputError& error) {
    checkpoint.refuse(std::string("contradicts itself: ") + error.what() + "; run the scene anew");
  }
  for (const FileContent& content : now.files) {
    const auto same_key = [&](const FileContent& other) { return other.key == content.key; };
    const auto old = std::find_if(then.files.begin(), then.files.end(), same_key);
    if (old != then.files.end() && old->checksum != content.checksum)
      changes.forbidden.push_back(fmt::format("{} (what is in the file {})", content.key, content.file));
  }
  if (!changes.forbidden.empty())
    checkpoint.refuse(
        fmt::format("is of a run of another scene; these keys differ: {}. Change them back, or run the scene anew "
                    "without --resume. (frames, render and output may change, and {}.)",
                    joined(changes.forbidden), joined({kNumerical.begin(), kNumerical.end()})));
  if (then.compare != now.compare)
    checkpoint.refuse(fmt::format("is of a run with {}; resume with that, or run the scene anew",
                                  then.compare.empty() ? "no --compare" : "--compare " + then.compare));
  if (frames < then.frame)
    checkpoint.refuse(
        fmt::format("is after frame {}, but the run is to have {} frames only; ask for more, or run the scene anew",
                    then.frame, frames));
  return changes.numerical;
}

}  // namespace flowskin::tools
