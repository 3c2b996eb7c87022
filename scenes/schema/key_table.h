// The keys of an object of the scene file, each bound to the member of the settings that it sets: the reader, the
// writer and the documentation all follow this table.
#pragma once

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/named_value.h"
#include "scenes/schema/scene_key.h"
#include "scenes/schema/values.h"

namespace flowskin::scenes {

class KeyTable;
class Problems;

/// A value of the scene file and the member that it sets, which must outlive this.
class BoundValue {
 public:
  virtual ~BoundValue() = default;
  /// In words, range included, as messages say what was expected.
  virtual std::string type() const = 0;
  virtual std::string documented_type() const { return type(); }
  /// Sets the member; `path` is that of the value, for problems inside it. Throws Mismatch.
  virtual void read(const JsonNode& node, const std::string& path, Problems& problems) = 0;
  /// The member as JSON; further lines start with `indent` spaces.
  virtual std::string write(int indent) const = 0;
  /// Keys of the objects of a list.
  virtual std::vector<SceneKey> inner_keys() const { return {}; }
};

/// When a key has a meaning.
struct Condition {
  std::string words;  ///< Such as `shape "ball"`.
  std::function<bool()> holds;
};

struct Key {
  std::string path;  ///< Dotted, from the object: "min" or "motion.rate".
  std::string unit, meaning;
  std::unique_ptr<BoundValue> value;
  bool required = false;
  bool selects = false;   ///< Its value decides which other keys apply.
  std::string condition;  ///< In words; empty: the key always applies.
  std::vector<std::function<bool()>> tests;

  bool applies() const {
    return std::all_of(tests.begin(), tests.end(), [](const auto& test) { return test(); });
  }
  Key& is_required();
  Key& selecting();
  /// With several conditions all must hold; messages name the first.
  Key& only_for(const Condition& when);
};

/// A member that is one of an enumeration's values, which have names in the scene file.
class BoundEnumeration : public BoundValue {
 public:
  explicit BoundEnumeration(std::vector<std::string> names) : names_(std::move(names)) {}
  std::string type() const override;
  void read(const JsonNode& node, const std::string& path, Problems& problems) override;
  std::string write(int indent) const override;

 private:
  virtual void choose(std::size_t name) = 0;
  /// Number of the name; that of all names where the member is none of them.
  virtual std::size_t chosen() const = 0;

  std::vector<std::string> names_;
};

/// A member that is a list of objects.
class BoundList : public BoundValue {
 public:
  std::string type() const override { return "list of objects"; }
  void read(const JsonNode& node, const std::string& path, Problems& problems) override;
  std::string write(int indent) const override;

 private:
  virtual void clear() = 0;
  virtual std::size_t size() const = 0;
  /// Adds an item and gives its keys.
  virtual void append(KeyTable& keys) = 0;
  virtual void item(std::size_t index, KeyTable& keys) const = 0;
};

/// Keys in the order of the file; a selecting key stands before those it decides on. Every function adds a key and
/// returns it, for is_required() and the like.
class KeyTable {
 public:
  const std::vector<Key>& keys() const { return keys_; }
  /// Every key from number `first` on applies only there.
  void restrict_from(std::size_t first, const Condition& when);

  Key& number(std::string_view path, double& member, Range range, std::string_view unit, std::string_view meaning);
  Key& integer(std::string_view path, int& member, int min, int max, std::string_view unit, std::string_view meaning);
  Key& natural(std::string_view path, std::uint64_t& member, std::string_view meaning);
  Key& boolean(std::string_view path, bool& member, std::string_view meaning);
  Key& text(std::string_view path, std::string& member, std::string_view meaning);
  /// A text, or a list of texts.
  Key& texts(std::string_view path, std::vector<std::string>& member, std::string_view meaning);
  /// Three numbers, each within +-limit.
  Key& vector(std::string_view path, Vec3& member, std::string_view unit, std::string_view meaning,
              double limit = max_coordinate);
  /// Three numbers, or one that stands for all three; none is 0.
  Key& scale(std::string_view path, Vec3& member, std::string_view meaning);
  Key& axes(std::string_view path, std::array<bool, 3>& member, std::string_view meaning);
  Key& color(std::string_view path, std::array<double, 3>& member, std::string_view meaning);
  Key& points(std::string_view path, std::vector<Vec3>& member, std::string_view unit, std::string_view meaning,
              double limit = max_coordinate);
  /// One of names that a registry gives; `documented_type` stands for their list in the documentation.
  Key& name(std::string_view path, std::string& member, const std::vector<std::string>& names, std::string_view meaning,
            std::string_view documented_type = "");
  /// One of an enumeration's values by name.
  template <class E>
  Key& choice(std::string_view path, E& member, const std::vector<NamedValue<E>>& values, std::string_view meaning);
  template <class E, std::size_t count>
  Key& choice(std::string_view path, E& member, const std::array<NamedValue<E>, count>& values,
              std::string_view meaning) {
    return choice(path, member, std::vector(values.begin(), values.end()), meaning);
  }
  /// Objects; `keys_of` adds the keys of one.
  template <class Item>
  Key& list(std::string_view path, std::vector<Item>& items, void (*keys_of)(KeyTable&, Item&),
            std::string_view meaning);

 private:
  Key& add(std::string_view path, std::unique_ptr<BoundValue> value, std::string_view unit, std::string_view meaning);

  std::vector<Key> keys_;
};

/// The documentation of a table; the defaults are the present values.
std::vector<SceneKey> document(const KeyTable& table);

template <class E>
class BoundChoice final : public BoundEnumeration {
 public:
  BoundChoice(E& member, std::vector<std::string> names, std::vector<E> values)
      : BoundEnumeration(std::move(names)), member_(member), values_(std::move(values)) {}

 private:
  void choose(std::size_t name) override { member_ = values_[name]; }
  std::size_t chosen() const override {
    return static_cast<std::size_t>(std::find(values_.begin(), values_.end(), member_) - values_.begin());
  }

  E& member_;
  std::vector<E> values_;
};

template <class E>
Key& KeyTable::choice(std::string_view path, E& member, const std::vector<NamedValue<E>>& values,
                      std::string_view meaning) {
  std::vector<std::string> names;
  std::vector<E> known;
  for (const auto& [name, value] : values) {
    names.emplace_back(name);
    known.push_back(value);
  }
  return add(path, std::make_unique<BoundChoice<E>>(member, std::move(names), std::move(known)), "", meaning);
}

template <class Item>
class BoundItems final : public BoundList {
 public:
  using KeysOf = void (*)(KeyTable&, Item&);
  BoundItems(std::vector<Item>& items, KeysOf keys_of) : items_(items), keys_of_(keys_of) {}
  std::vector<SceneKey> inner_keys() const override {
    Item untouched;
    KeyTable keys;
    keys_of_(keys, untouched);
    return document(keys);
  }

 private:
  void clear() override { items_.clear(); }
  std::size_t size() const override { return items_.size(); }
  void append(KeyTable& keys) override { keys_of_(keys, items_.emplace_back()); }
  void item(std::size_t index, KeyTable& keys) const override { keys_of_(keys, items_[index]); }

  std::vector<Item>& items_;
  KeysOf keys_of_;
};

template <class Item>
Key& KeyTable::list(std::string_view path, std::vector<Item>& items, void (*keys_of)(KeyTable&, Item&),
                    std::string_view meaning) {
  return add(path, std::make_unique<BoundItems<Item>>(items, keys_of), "", meaning);
}

}  // namespace flowskin::scenes
