// Reads and writes an object of the scene file by the table of its keys.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenes/schema/key_table.h"

namespace flowskin::scenes {

/// What is wrong with a scene file, in the order of the places.
class Problems {
 public:
  Problems(std::string file, const std::string& text) : file_(std::move(file)), text_(text) {}
  void add(std::size_t offset, const std::string& message) { list_.emplace_back(offset, message); }
  std::size_t count() const { return list_.size(); }
  /// More than are shown.
  bool are_many() const { return list_.size() >= most_shown; }
  /// @throws InputError with one line a problem, where there is any.
  void throw_if_any() const;

 private:
  static constexpr std::size_t most_shown = 20;

  std::string file_;
  const std::string& text_;
  std::vector<std::pair<std::size_t, std::string>> list_;
};

/// Node at a dotted path below `node`, or nullptr.
const JsonNode* find_path(const JsonNode& node, const std::string& path);

/// A path for messages: where the object is the root, the key's own.
inline std::string join_path(const std::string& object, const std::string& key) {
  return object.empty() ? key : object + "." + key;
}

/// Reads the object `node`, which stands at `path`, into what the table is bound to; keys that are not there keep their
/// values.
void read_object(const JsonNode& node, const KeyTable& table, const std::string& path, Problems& problems);

/// Sets the key `path` to a value as it would stand in a file; quotes may be left out. @throws InputError
void set_key(const KeyTable& table, const std::string& path, const std::string& value);

/// The keys that apply as a JSON object.
std::string write_object(const KeyTable& table, int indent);

}  // namespace flowskin::scenes
