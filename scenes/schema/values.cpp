#include "scenes/schema/values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "scenes/nearest_name.h"

namespace flowskin::scenes {
namespace {

std::string range_in_words(const Range& range) {
  const bool bounded_above = range.max < 1000;  // Larger limits only catch slips.
  if (!bounded_above) {
    if (range.min <= -max_coordinate) return "number";
    return fmt::format("number {} {}", range.open_min ? ">" : ">=", number_text(range.min));
  }
  return fmt::format("number {} {}{} {}", range.open_min ? "above" : "from", number_text(range.min),
                     range.open_min ? ", at most" : " to", number_text(range.max));
}

/// The number of a node; `place` is set in lists, where the culprit is worth pointing at.
double checked_number(const JsonNode& node, const Range& range, std::size_t place = Mismatch::npos) {
  if (node.type != JsonNode::Type::number) throw Mismatch{describe(node), "", place};
  const double value = node.number;
  const bool inside = (range.open_min ? value > range.min : value >= range.min) && value <= range.max;
  if (!inside) {
    const std::string hint = value > range.max ? "; the largest allowed is " + number_text(range.max) : "";
    throw Mismatch{describe(node), hint, place};
  }
  return value;
}

template <class Triple>
Triple checked_triple(const JsonNode& node, const Range& range) {
  if (node.type != JsonNode::Type::list || node.children.size() != 3) throw Mismatch{describe(node), ""};
  Triple triple{};
  for (int i = 0; i < 3; ++i) {
    const JsonNode& child = node.children[static_cast<std::size_t>(i)];
    triple[i] = checked_number(child, range, child.offset);
  }
  return triple;
}

template <class Triple>
std::string write_triple(const Triple& t) {
  return fmt::format("[{}, {}, {}]", number_text(t[0]), number_text(t[1]), number_text(t[2]));
}

}  // namespace

Kind<double> number(Range range) {
  return {range_in_words(range), [range](const JsonNode& node) { return checked_number(node, range); },
          [](const double& value, int) { return number_text(value); }};
}

Kind<int> integer(int min, int max) {
  const auto read = [min, max](const JsonNode& node) {
    const double value = checked_number(node, at_least(min, max));
    if (value != std::floor(value)) throw Mismatch{describe(node), ""};
    return static_cast<int>(value);
  };
  return {fmt::format("whole number from {} to {}", min, max), read,
          [](const int& value, int) { return fmt::format("{}", value); }};
}

Kind<std::uint64_t> natural() {
  const auto read = [](const JsonNode& node) {
    if (!node.is_natural) throw Mismatch{describe(node), ""};
    return node.natural;
  };
  return {"whole number from 0 to 18446744073709551615", read,
          [](const std::uint64_t& value, int) { return fmt::format("{}", value); }};
}

Kind<bool> boolean() {
  const auto read = [](const JsonNode& node) {
    if (node.type != JsonNode::Type::boolean) throw Mismatch{describe(node), ""};
    return node.boolean;
  };
  return {"true or false", read, [](const bool& value, int) { return std::string(value ? "true" : "false"); }};
}

Kind<std::string> text() {
  const auto read = [](const JsonNode& node) {
    if (node.type != JsonNode::Type::text) throw Mismatch{describe(node), ""};
    // Texts are names and file names, which end at a zero byte in the system's calls.
    if (node.text.find('\0') != std::string::npos) throw Mismatch{"a text with a zero byte", ""};
    return node.text;
  };
  return {"text", read, [](const std::string& value, int) { return quote_json(value); }};
}

Kind<std::string> choice(const std::vector<std::string>& names) {
  const auto read = [names, plain = text().read](const JsonNode& node) {
    const std::string name = plain(node);
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw Mismatch{describe(node), did_you_mean(name, names)};
    }
    return name;
  };
  return {fmt::format("one of: {}", fmt::join(names, ", ")), read, text().write};
}

Kind<Vec3> vector(double limit) {
  return {"3 numbers", [limit](const JsonNode& node) { return checked_triple<Vec3>(node, at_least(-limit, limit)); },
          [](const Vec3& value, int) { return write_triple(value); }};
}

Kind<Vec3> scale() {
  const auto read = [](const JsonNode& node) {
    const Range range = at_least(-max_coordinate, max_coordinate);
    const Vec3 factors = node.type == JsonNode::Type::number ? Vec3(Vec3::Constant(checked_number(node, range)))
                                                             : checked_triple<Vec3>(node, range);
    if ((factors.array() == 0).any()) throw Mismatch{"a factor 0, which flattens the mesh", ""};
    return factors;
  };
  return {"number or 3 numbers, none of them 0", read, [](const Vec3& value, int) { return write_triple(value); }};
}

Kind<std::array<bool, 3>> axes() {
  using Axes = std::array<bool, 3>;
  const auto read = [one = boolean().read](const JsonNode& node) {
    if (node.type != JsonNode::Type::list || node.children.size() != 3) throw Mismatch{describe(node), ""};
    Axes axes{};
    for (std::size_t a = 0; a < 3; ++a) {
      const JsonNode& child = node.children[a];
      if (child.type != JsonNode::Type::boolean) throw Mismatch{describe(child) + " in the list", "", child.offset};
      axes[a] = one(child);
    }
    return axes;
  };
  return {"3 times true or false (x, y, z)", read,
          [](const Axes& axes, int) { return fmt::format("[{}, {}, {}]", axes[0], axes[1], axes[2]); }};
}

Kind<std::array<double, 3>> color() {
  using Color = std::array<double, 3>;
  return {"3 numbers from 0 to 1 (red, green, blue)",
          [](const JsonNode& node) { return checked_triple<Color>(node, at_least(0, 1)); },
          [](const Color& value, int) { return write_triple(value); }};
}

Kind<std::vector<std::string>> texts() {
  const auto read = [one = text().read](const JsonNode& node) {
    std::vector<std::string> list;
    if (node.type == JsonNode::Type::text) return std::vector<std::string>{one(node)};
    if (node.type != JsonNode::Type::list || node.children.empty()) throw Mismatch{describe(node), ""};
    for (const JsonNode& child : node.children) {
      if (child.type != JsonNode::Type::text) throw Mismatch{describe(child) + " in the list", "", child.offset};
      list.push_back(one(child));
    }
    return list;
  };
  const auto write = [](const std::vector<std::string>& list, int indent) {
    if (list.size() == 1) return quote_json(list.front());
    std::string text = "[";
    for (std::size_t i = 0; i < list.size(); ++i) {
      text += fmt::format("{}\n{:{}}{}", i > 0 ? "," : "", "", indent + 2, quote_json(list[i]));
    }
    return text + (list.empty() ? "]" : fmt::format("\n{:{}}]", "", indent));
  };
  return {"text or list of texts", read, write};
}

Kind<std::vector<Vec3>> points(double limit) {
  const auto read = [limit](const JsonNode& node) {
    if (node.type != JsonNode::Type::list) throw Mismatch{describe(node), ""};
    std::vector<Vec3> list;
    for (const JsonNode& child : node.children) {
      if (child.type != JsonNode::Type::list || child.children.size() != 3) {
        throw Mismatch{describe(child) + " among the points", "", child.offset};
      }
      list.push_back(checked_triple<Vec3>(child, at_least(-limit, limit)));
    }
    return list;
  };
  const auto write = [](const std::vector<Vec3>& list, int indent) {
    std::string text = "[";
    for (std::size_t i = 0; i < list.size(); ++i) {
      text += fmt::format("{}\n{:{}}{}", i > 0 ? "," : "", "", indent + 2, write_triple(list[i]));
    }
    return text + (list.empty() ? "]" : fmt::format("\n{:{}}]", "", indent));
  };
  return {"list of points of 3 numbers", read, write};
}

}  // namespace flowskin::scenes
