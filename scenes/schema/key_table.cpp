#include "scenes/schema/key_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "scenes/schema/objects.h"

namespace flowskin::scenes {
namespace {

template <class V>
class BoundMember final : public BoundValue {
 public:
  BoundMember(V& member, Kind<V> kind, std::string_view documented = "")
      : member_(member), kind_(std::move(kind)), documented_(documented.empty() ? kind_.type : documented) {}
  std::string type() const override { return kind_.type; }
  std::string documented_type() const override { return documented_; }
  void read(const JsonNode& node, const std::string&, Problems&) override { member_ = kind_.read(node); }
  std::string write(int indent) const override { return kind_.write(member_, indent); }

 private:
  V& member_;
  Kind<V> kind_;
  std::string documented_;
};

template <class V>
std::unique_ptr<BoundValue> bind(V& member, Kind<V> kind, std::string_view documented = "") {
  return std::make_unique<BoundMember<V>>(member, std::move(kind), documented);
}

}  // namespace

Key& Key::is_required() {
  required = true;
  return *this;
}

Key& Key::selecting() {
  selects = true;
  return *this;
}

Key& Key::only_for(const Condition& when) {
  if (condition.empty()) condition = when.words;
  tests.push_back(when.holds);
  return *this;
}

std::string BoundEnumeration::type() const { return fmt::format("one of: {}", fmt::join(names_, ", ")); }

void BoundEnumeration::read(const JsonNode& node, const std::string&, Problems&) {
  const std::string name = scenes::choice(names_).read(node);
  choose(static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin()));
}

std::string BoundEnumeration::write(int) const {
  const std::size_t name = chosen();
  if (name == names_.size()) throw std::logic_error(fmt::format("a setting is none of {}", fmt::join(names_, ", ")));
  return quote_json(names_[name]);
}

void BoundList::read(const JsonNode& node, const std::string& path, Problems& problems) {
  if (node.type != JsonNode::Type::list) throw Mismatch{describe(node), ""};
  clear();
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    KeyTable keys;
    append(keys);
    read_object(node.children[i], keys, fmt::format("{}[{}]", path, i), problems);
  }
}

std::string BoundList::write(int indent) const {
  std::string text = "[";
  for (std::size_t i = 0; i < size(); ++i) {
    KeyTable keys;
    item(i, keys);
    text += fmt::format("{}\n{:{}}{}", i == 0 ? "" : ",", "", indent + 2, write_object(keys, indent + 2));
  }
  return text + (size() == 0 ? "]" : fmt::format("\n{:{}}]", "", indent));
}

void KeyTable::restrict_from(std::size_t first, const Condition& when) {
  for (std::size_t k = first; k < keys_.size(); ++k) keys_[k].only_for(when);
}

Key& KeyTable::add(std::string_view path, std::unique_ptr<BoundValue> value, std::string_view unit,
                   std::string_view meaning) {
  Key& key = keys_.emplace_back();
  key.path = path;
  key.unit = unit;
  key.meaning = meaning;
  key.value = std::move(value);
  return key;
}

Key& KeyTable::number(std::string_view path, double& member, Range range, std::string_view unit,
                      std::string_view meaning) {
  return add(path, bind(member, scenes::number(range)), unit, meaning);
}

Key& KeyTable::integer(std::string_view path, int& member, int min, int max, std::string_view unit,
                       std::string_view meaning) {
  return add(path, bind(member, scenes::integer(min, max)), unit, meaning);
}

Key& KeyTable::natural(std::string_view path, std::uint64_t& member, std::string_view meaning) {
  return add(path, bind(member, scenes::natural()), "", meaning);
}

Key& KeyTable::boolean(std::string_view path, bool& member, std::string_view meaning) {
  return add(path, bind(member, scenes::boolean()), "", meaning);
}

Key& KeyTable::text(std::string_view path, std::string& member, std::string_view meaning) {
  return add(path, bind(member, scenes::text()), "", meaning);
}

Key& KeyTable::texts(std::string_view path, std::vector<std::string>& member, std::string_view meaning) {
  return add(path, bind(member, scenes::texts()), "", meaning);
}

Key& KeyTable::vector(std::string_view path, Vec3& member, std::string_view unit, std::string_view meaning,
                      double limit) {
  return add(path, bind(member, scenes::vector(limit)), unit, meaning);
}

Key& KeyTable::scale(std::string_view path, Vec3& member, std::string_view meaning) {
  return add(path, bind(member, scenes::scale()), "", meaning);
}

Key& KeyTable::axes(std::string_view path, std::array<bool, 3>& member, std::string_view meaning) {
  return add(path, bind(member, scenes::axes()), "", meaning);
}

Key& KeyTable::color(std::string_view path, std::array<double, 3>& member, std::string_view meaning) {
  return add(path, bind(member, scenes::color()), "", meaning);
}

Key& KeyTable::points(std::string_view path, std::vector<Vec3>& member, std::string_view unit, std::string_view meaning,
                      double limit) {
  return add(path, bind(member, scenes::points(limit)), unit, meaning);
}

Key& KeyTable::name(std::string_view path, std::string& member, const std::vector<std::string>& names,
                    std::string_view meaning, std::string_view documented_type) {
  return add(path, bind(member, scenes::choice(names), documented_type), "", meaning);
}

std::vector<SceneKey> document(const KeyTable& table) {
  std::vector<SceneKey> keys;
  for (const Key& key : table.keys()) {
    const std::string meaning = key.condition.empty() ? key.meaning : key.meaning + " Only for " + key.condition + ".";
    keys.push_back(
        {key.path, key.value->documented_type(), key.unit, key.required ? "required" : key.value->write(0), meaning});
    for (SceneKey inner : key.value->inner_keys()) {
      inner.path = key.path + "[]." + inner.path;
      keys.push_back(std::move(inner));
    }
  }
  return keys;
}

}  // namespace flowskin::scenes
