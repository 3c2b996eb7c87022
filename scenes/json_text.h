// JSON text with comments as a tree that remembers where everything stands, so that messages can point at it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace flowskin::scenes {

/// One value of a JSON text.
struct JsonNode {
  enum class Type { null, boolean, number, text, list, object };
  Type type = Type::null;
  std::string key;         ///< Name in the object around it; empty in lists and at the root.
  std::size_t offset = 0;  ///< Where the key, or where there is none the value, begins in the text (bytes).
  bool boolean = false;
  double number = 0;
  bool is_natural = false;    ///< Written as a whole number >= 0 that fits `natural`.
  std::uint64_t natural = 0;  ///< Its exact value.
  std::string text;           ///< Of a text its value; of a number its spelling.
  std::vector<JsonNode> children;

  /// The member of this name or nullptr; the first one, where a name stands twice.
  const JsonNode* find(const std::string& name) const;
};

/// Line and column (both from 1; columns in bytes) of a place in a text.
struct TextPlace {
  std::size_t line = 1, column = 1;
};
TextPlace place_in_text(const std::string& text, std::size_t offset);

/// @throws InputError "name:line:column: ..." where the text is no JSON, holds a number too large for a double, or is
/// nested more than 64 levels deep.
JsonNode parse_json(const std::string& text, const std::string& name);

/// What a value is, in words for messages: `the text "abc"`, `the number -1`, `a list of 2`.
std::string describe(const JsonNode& node);

/// A key or value for messages: the start of one that is long.
std::string shortened(const std::string& text);

/// A text as JSON, quotes included; bytes that are no UTF-8 are replaced.
std::string quote_json(const std::string& text);

}  // namespace flowskin::scenes
