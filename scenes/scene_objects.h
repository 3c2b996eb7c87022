// Reads and writes an object of the scene file by the table of its keys.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "scenes/nearest_name.h"
#include "scenes/scene_table.h"

namespace flowskin::scenes {

/// What is wrong with a scene file, in the order of the places.
class Problems {
 public:
  Problems(std::string file, const std::string& text) : file_(std::move(file)), text_(text) {}
  void add(std::size_t offset, const std::string& message) { list_.emplace_back(offset, message); }
  std::size_t count() const { return list_.size(); }
  /// @throws InputError with one line a problem, where there is any.
  void throw_if_any() const;

 private:
  std::string file_;
  const std::string& text_;
  std::vector<std::pair<std::size_t, std::string>> list_;
};

/// Node at a dotted path below `node`, or nullptr.
const JsonNode* find_path(const JsonNode& node, const std::string& path);

/// Reports the members of `node` that are none of `paths` nor sections of them, and those that stand there twice;
/// `section` is "" or ends with a dot.
void report_unknown_keys(const JsonNode& node, const std::vector<std::string>& paths, const std::string& section,
                         const std::string& object_path, Problems& problems);

/// Such as "a number > 0 (m)".
std::string type_and_unit(const std::string& type, const std::string& unit);

/// Text of a value that was not as expected.
std::string mismatch_message(const std::string& path, const Mismatch& mismatch, const std::string& type,
                             const std::string& unit);

/// A line of an object as it is written.
struct WrittenKey {
  std::string path, value;
};
/// Keys with dotted paths as a JSON object with its sections, whose closing brace stands at `indent`.
std::string write_sections(const std::vector<WrittenKey>& keys, int indent);

/// A path for messages: where the object is the root, the key's own.
inline std::string join_path(const std::string& object, const std::string& key) {
  return object.empty() ? key : object + "." + key;
}

template <class T>
void read_key(const Key<T>& key, const JsonNode& value, const std::string& path, T& object, Problems& problems) {
  try {
    key.read(value, object, path, problems);
  } catch (const Mismatch& mismatch) {
    const std::size_t place = mismatch.offset == Mismatch::npos ? value.offset : mismatch.offset;
    problems.add(place, mismatch_message(path, mismatch, key.type, key.unit));
  }
}

/// Reads the object `node`, which stands at `path`, into `object`; keys that are not there keep their values.
template <class T>
void read_object(const JsonNode& node, const Table<T>& table, const std::string& path, T& object, Problems& problems) {
  if (node.type != JsonNode::Type::object) {
    const std::string name = path.empty() ? "the scene" : path;
    problems.add(node.offset, fmt::format("{} is {}; expected an object in braces", name, describe(node)));
    return;
  }
  std::vector<std::string> paths;
  for (const Key<T>& key : table) paths.push_back(key.path);
  report_unknown_keys(node, paths, "", path, problems);

  bool selection_known = true;  // Where a selecting key is wrong, nobody knows which others apply.
  for (const Key<T>& key : table) {
    if (!selection_known && !key.condition.empty()) continue;
    const JsonNode* value = find_path(node, key.path);
    const std::string key_path = join_path(path, key.path);
    if (!key.applies_to(object)) {
      if (value) problems.add(value->offset, fmt::format("{} belongs to {} only", key_path, key.condition));
    } else if (value) {
      const std::size_t count = problems.count();
      read_key(key, *value, key_path, object, problems);
      if (key.selects && problems.count() > count) selection_known = false;
    } else if (key.required) {
      problems.add(node.offset, fmt::format("{} is missing; expected {}: {}", key_path,
                                            type_and_unit(key.type, key.unit), key.meaning));
    }
  }
}

/// The keys that apply to `object` as a JSON object.
template <class T>
std::string write_object(const T& object, const Table<T>& table, int indent) {
  std::vector<WrittenKey> written;
  for (const Key<T>& key : table) {
    const int depth = 1 + static_cast<int>(std::count(key.path.begin(), key.path.end(), '.'));
    if (key.applies_to(object)) written.push_back({key.path, key.write(object, indent + 2 * depth)});
  }
  return write_sections(written, indent);
}

/// The documentation of a table; defaults are those of a T that nobody has touched.
template <class T>
std::vector<SceneKey> document(const Table<T>& table) {
  std::vector<SceneKey> keys;
  for (const Key<T>& key : table) {
    const std::string meaning = key.condition.empty() ? key.meaning : key.meaning + " Only for " + key.condition + ".";
    keys.push_back({key.path, key.type, key.unit, key.required ? "required" : key.write(T{}, 0), meaning});
    keys.insert(keys.end(), key.inner.begin(), key.inner.end());
  }
  return keys;
}

}  // namespace flowskin::scenes
