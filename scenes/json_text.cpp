#include "scenes/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/errors.h"

namespace flowskin::scenes {
namespace {

constexpr std::size_t max_depth = 64;
/// Each takes some 150 bytes of memory; five million explicit particles are within it.
constexpr std::size_t most_nodes = 20000000;

bool is_number_character(char c) {
  return (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.' || c == 'e' || c == 'E';
}

/// Start of the string literal whose closing quote stands before `end`.
std::size_t string_start(const std::string& text, std::size_t end) {
  if (end < 2) return 0;
  for (std::size_t i = end - 1; i-- > 0;) {
    if (text[i] != '"') continue;
    std::size_t backslashes = 0;
    while (backslashes < i && text[i - 1 - backslashes] == '\\') ++backslashes;
    if (backslashes % 2 == 0) return i;
  }
  return 0;
}

/// Start of the number that ends at `end` or, where the lexer has looked one character ahead, just before it.
std::size_t number_start(const std::string& text, std::size_t end) {
  std::size_t i = std::min(end, text.size());
  if (i > 0 && !is_number_character(text[i - 1])) --i;
  while (i > 0 && is_number_character(text[i - 1])) --i;
  return i;
}

/// nlohmann's message without its prefix, in plain words, with a hint at the usual slips.
std::string plain_syntax_message(const std::string& what) {
  static const std::string marker = "syntax error ";
  const std::size_t start = what.find(marker);
  std::string message = start == std::string::npos ? what : what.substr(start + marker.size());
  const auto contains = [&](const char* part) { return message.find(part) != std::string::npos; };
  std::string hint;
  if (contains("unexpected '}'") || contains("unexpected ']'")) {
    hint = " (is there a comma too many before it?)";
  } else if (contains("unexpected string literal") && (contains("expected '}'") || contains("expected ']'"))) {
    hint = " (is a comma missing before it?)";
  } else if (contains("unexpected end of input")) {
    hint = " (is a closing brace or bracket missing?)";
  } else if (contains("invalid literal")) {
    hint = " (texts and keys stand in double quotes)";
  }
  return message + hint;
}

/// Builds the tree from the events of nlohmann's parser; the place of an event follows from how much the parser has
/// read of the stream by then.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(const std::string& text, const std::string& name, std::istringstream& stream)
      : text_(text), name_(name), stream_(stream) {}

  JsonNode root;
  std::string error;

  bool null() override { return add(JsonNode::Type::null, literal_start(4)) != nullptr; }
  bool boolean(bool value) override {
    add(JsonNode::Type::boolean, literal_start(value ? 4 : 5))->boolean = value;
    return true;
  }
  bool number_integer(number_integer_t value) override {
    JsonNode* node = add(JsonNode::Type::number, number_start(text_, position()));
    node->number = static_cast<double>(value);
    node->text = fmt::format("{}", value);
    return true;
  }
  bool number_unsigned(number_unsigned_t value) override {
    JsonNode* node = add(JsonNode::Type::number, number_start(text_, position()));
    node->number = static_cast<double>(value);
    node->is_natural = true;
    node->natural = value;
    node->text = fmt::format("{}", value);
    return true;
  }
  bool number_float(number_float_t value, const string_t& spelling) override {
    JsonNode* node = add(JsonNode::Type::number, number_start(text_, position()));
    node->number = value;
    node->text = spelling;
    return true;
  }
  bool string(string_t& value) override {
    add(JsonNode::Type::text, string_start(text_, position()))->text = value;
    return true;
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(JsonNode::Type::object); }
  bool start_array(std::size_t) override { return open(JsonNode::Type::list); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& value) override {
    key_ = value;
    key_offset_ = string_start(text_, position());
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& problem) override {
    const std::string what = problem.what();
    if (problem.id == 406) {
      fail(number_start(text_, position), fmt::format("the number {} is too large to be represented", token));
      return false;
    }
    std::size_t offset = position > 0 ? position - 1 : 0;
    if (what.find("unexpected string literal") != std::string::npos) offset = string_start(text_, position);
    if (what.find("unexpected number literal") != std::string::npos) offset = number_start(text_, position);
    fail(offset, "this is not valid JSON: " + plain_syntax_message(what));
    return false;
  }

 private:
  std::size_t position() const {
    const auto place = stream_.rdbuf()->pubseekoff(0, std::ios_base::cur, std::ios_base::in);
    return place < 0 ? text_.size() : std::min(text_.size(), static_cast<std::size_t>(place));
  }
  std::size_t literal_start(std::size_t length) const {
    const std::size_t end = position();
    return end > length ? end - length : 0;
  }
  void fail(std::size_t offset, const std::string& message) {
    const TextPlace place = place_in_text(text_, offset);
    constexpr std::size_t longest = 500;  // the parser repeats whole texts
    error = fmt::format("{}:{}:{}: {}{}", name_, place.line, place.column, message.substr(0, longest),
                        message.size() > longest ? "..." : "");
  }

  JsonNode* add(JsonNode::Type type, std::size_t offset) {
    if (++nodes_ > most_nodes)
      throw InputError(fmt::format("{}: there are more than {} values; this is no scene", name_, most_nodes));
    JsonNode* node = &root;
    if (!open_.empty()) node = &open_.back()->children.emplace_back();
    node->type = type;
    node->offset = offset;
    if (!open_.empty() && open_.back()->type == JsonNode::Type::object) {
      node->key = key_;
      node->offset = key_offset_;
    }
    return node;
  }
  bool open(JsonNode::Type type) {
    const std::size_t offset = literal_start(1);
    if (open_.size() >= max_depth) {
      fail(offset, fmt::format("lists and objects are nested more than {} levels deep", max_depth));
      return false;
    }
    // Pointers into `children` stay valid: a list grows only after its last child has been closed.
    open_.push_back(add(type, offset));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  const std::string& text_;
  const std::string& name_;
  std::istringstream& stream_;
  std::vector<JsonNode*> open_;
  std::string key_;
  std::size_t key_offset_ = 0, nodes_ = 0;
};

}  // namespace

const JsonNode* JsonNode::find(const std::string& name) const {
  const auto found = std::find_if(children.begin(), children.end(), [&](const JsonNode& c) { return c.key == name; });
  return type == Type::object && found != children.end() ? &*found : nullptr;
}

TextPlace place_in_text(const std::string& text, std::size_t offset) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size()));
  const auto line_start = std::find(std::make_reverse_iterator(end), text.rend(), '\n').base();
  return {1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n')),
          1 + static_cast<std::size_t>(end - line_start)};
}

JsonNode parse_json(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  TreeBuilder builder(text, name, stream);
  const bool strict = true, ignore_comments = true;
  const bool ok =
      nlohmann::json::sax_parse(stream, &builder, nlohmann::json::input_format_t::json, strict, ignore_comments);
  if (!ok) throw InputError(builder.error.empty() ? name + ": this is not valid JSON" : builder.error);
  return std::move(builder.root);
}

std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 120;
  return text.size() > longest ? text.substr(0, longest) + "..." : text;
}

std::string describe(const JsonNode& node) {
  switch (node.type) {
    case JsonNode::Type::null:
      return "null";
    case JsonNode::Type::boolean:
      return node.boolean ? "true" : "false";
    case JsonNode::Type::number:
      return "the number " + shortened(node.text);
    case JsonNode::Type::text:
      return "the text " + quote_json(shortened(node.text));
    case JsonNode::Type::list:
      return fmt::format("a list of {}", node.children.size());
    case JsonNode::Type::object:
      return "an object";
  }
  return "";
}

std::string quote_json(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace flowskin::scenes
