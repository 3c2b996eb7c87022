#include "scenes/schema/objects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <unordered_set>

#include "common/errors.h"
#include "scenes/nearest_name.h"

namespace flowskin::scenes {
namespace {

bool starts_with(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

std::string last_part(const std::string& path) { return path.substr(path.rfind('.') + 1); }

/// Names that are valid inside a section.
std::vector<std::string> names_in_section(const std::vector<std::string>& paths, const std::string& section) {
  std::vector<std::string> names;
  for (const std::string& path : paths) {
    if (!starts_with(path, section)) continue;
    const std::string rest = path.substr(section.size());
    const std::string name = rest.substr(0, rest.find('.'));
    if (names.empty() || names.back() != name) names.push_back(name);
  }
  return names;
}

/// The nearest valid name of the section; failing that, a key of the same name in another section; failing that, all.
std::string suggestion(const std::string& name, const std::string& section, const std::vector<std::string>& paths) {
  const std::vector<std::string> names = names_in_section(paths, section);
  std::string near = did_you_mean(name, names);
  if (!near.empty()) return near;
  for (const std::string& path : paths) {
    if (edit_distance(last_part(path), name) <= (name.size() > 5 ? 1 : 0)) return "; did you mean \"" + path + "\"?";
  }
  return fmt::format("; valid here: {}", fmt::join(names, ", "));
}

/// A line of an object as it is written.
struct WrittenKey {
  std::string path, value;
};

/// Reports the members of `node` that are none of `paths` nor sections of them, and those that stand there twice;
/// `section` is "" or ends with a dot.
void report_unknown_keys(const JsonNode& node, const std::vector<std::string>& paths, const std::string& section,
                         const std::string& object_path, Problems& problems) {
  std::unordered_set<std::string_view> seen;
  for (const JsonNode& child : node.children) {
    const std::string path = section + child.key;
    const std::string shown = join_path(object_path, section + shortened(child.key));
    if (!seen.insert(child.key).second) {
      problems.add(child.offset, shown + " stands here a second time; keep one of them");
      continue;
    }
    if (std::find(paths.begin(), paths.end(), path) != paths.end()) continue;
    const std::string inner = path + ".";
    const bool is_section =
        std::any_of(paths.begin(), paths.end(), [&](const std::string& p) { return starts_with(p, inner); });
    if (!is_section) {
      // Nobody reads more of them, and near names take time to find.
      const std::string near = problems.are_many() ? "" : suggestion(child.key, section, paths);
      problems.add(child.offset, shown + ": there is no such key" + near);
    } else if (child.type != JsonNode::Type::object) {
      problems.add(child.offset, fmt::format("{} is {}; expected an object in braces", shown, describe(child)));
    } else {
      report_unknown_keys(child, paths, inner, object_path, problems);
    }
  }
}

/// Such as "a number > 0 (m)".
std::string type_and_unit(const std::string& type, const std::string& unit) {
  return unit.empty() ? type : fmt::format("{} ({})", type, unit);
}

/// Text of a value that was not as expected.
std::string mismatch_message(const std::string& path, const Mismatch& mismatch, const std::string& type,
                             const std::string& unit) {
  return fmt::format("{} is {}; expected {}{}", path, mismatch.found, type_and_unit(type, unit), mismatch.hint);
}

/// Keys with dotted paths as a JSON object with its sections, whose closing brace stands at `indent`.
std::string write_sections(const std::vector<WrittenKey>& keys, int indent) {
  std::string text = "{";
  for (std::size_t i = 0; i < keys.size();) {
    text += fmt::format("{}\n{:{}}", i > 0 ? "," : "", "", indent + 2);
    const std::size_t dot = keys[i].path.find('.');
    if (dot == std::string::npos) {
      text += quote_json(keys[i].path) + ": " + keys[i].value;
      ++i;
      continue;
    }
    const std::string section = keys[i].path.substr(0, dot + 1);
    std::vector<WrittenKey> inner;
    for (; i < keys.size() && starts_with(keys[i].path, section); ++i) {
      inner.push_back({keys[i].path.substr(section.size()), keys[i].value});
    }
    text += quote_json(section.substr(0, dot)) + ": " + write_sections(inner, indent + 2);
  }
  return text + (keys.empty() ? "}" : fmt::format("\n{:{}}}}", "", indent));
}

/// What is no JSON is a text.
JsonNode bare_value(const std::string& value) {
  try {
    return parse_json(value, "value");
  } catch (const InputError&) {
    JsonNode node;
    node.type = JsonNode::Type::text;
    node.text = value;
    return node;
  }
}

void read_key(const Key& key, const JsonNode& value, const std::string& path, Problems& problems) {
  try {
    key.value->read(value, path, problems);
  } catch (const Mismatch& mismatch) {
    const std::size_t place = mismatch.offset == Mismatch::npos ? value.offset : mismatch.offset;
    problems.add(place, mismatch_message(path, mismatch, key.value->type(), key.unit));
  }
}

}  // namespace

void Problems::throw_if_any() const {
  if (list_.empty()) return;
  auto sorted = list_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string message;
  for (std::size_t i = 0; i < std::min(sorted.size(), most_shown); ++i) {
    const TextPlace place = place_in_text(text_, sorted[i].first);
    message += fmt::format("{}{}:{}:{}: {}", i > 0 ? "\n" : "", file_, place.line, place.column, sorted[i].second);
  }
  if (sorted.size() > most_shown) message += fmt::format("\n... and {} more", sorted.size() - most_shown);
  throw InputError(message);
}

const JsonNode* find_path(const JsonNode& node, const std::string& path) {
  const JsonNode* found = &node;
  for (std::size_t start = 0; found && start <= path.size();) {
    const std::size_t end = std::min(path.find('.', start), path.size());
    found = found->find(path.substr(start, end - start));
    start = end + 1;
  }
  return found;
}

void read_object(const JsonNode& node, const KeyTable& table, const std::string& path, Problems& problems) {
  if (node.type != JsonNode::Type::object) {
    const std::string name = path.empty() ? "the scene" : path;
    problems.add(node.offset, fmt::format("{} is {}; expected an object in braces", name, describe(node)));
    return;
  }
  std::vector<std::string> paths;
  for (const Key& key : table.keys()) paths.push_back(key.path);
  report_unknown_keys(node, paths, "", path, problems);

  bool selection_known = true;  // Where a selecting key is wrong, it is unknown which others apply.
  for (const Key& key : table.keys()) {
    if (!selection_known && !key.condition.empty()) continue;
    const JsonNode* value = find_path(node, key.path);
    const std::string key_path = join_path(path, key.path);
    if (!key.applies()) {
      if (value) problems.add(value->offset, fmt::format("{} belongs to {} only", key_path, key.condition));
    } else if (value) {
      const std::size_t count = problems.count();
      read_key(key, *value, key_path, problems);
      if (key.selects && problems.count() > count) selection_known = false;
    } else if (key.required) {
      problems.add(node.offset, fmt::format("{} is missing; expected {}: {}", key_path,
                                            type_and_unit(key.value->type(), key.unit), key.meaning));
    }
  }
}

void set_key(const KeyTable& table, const std::string& path, const std::string& value) {
  std::vector<std::string> paths;
  for (const Key& key : table.keys()) {
    paths.push_back(key.path);
    if (key.path != path) continue;
    Problems problems(path, value);
    try {
      key.value->read(bare_value(value), path, problems);
    } catch (const Mismatch& mismatch) {
      throw InputError(mismatch_message(path, mismatch, key.value->type(), key.unit));
    }
    problems.throw_if_any();
    return;
  }
  const std::string section = path.substr(0, path.rfind('.') + 1);
  throw InputError(path + ": there is no such key" + suggestion(last_part(path), section, paths));
}

std::string write_object(const KeyTable& table, int indent) {
  std::vector<WrittenKey> written;
  for (const Key& key : table.keys()) {
    const int depth = 1 + static_cast<int>(std::count(key.path.begin(), key.path.end(), '.'));
    if (key.applies()) written.push_back({key.path, key.value->write(indent + 2 * depth)});
  }
  return write_sections(written, indent);
}

}  // namespace flowskin::scenes
