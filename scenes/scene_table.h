// The keys of the scene file, each described once: the reader, the writer and the documentation all follow these
// tables.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.h"
#include "scenes/scene_file.h"
#include "scenes/scene_values.h"

namespace flowskin::scenes {

class Problems;

/// One key of an object that stands for a T.
template <class T>
struct Key {
  std::string path;  ///< Dotted, from the object: "min" or "motion.rate".
  std::string type;
  std::string unit;
  std::string meaning;
  bool required = false;
  bool selects = false;                   ///< Its value decides which other keys apply.
  std::string condition;                  ///< In words, such as `shape "ball"`; empty: the key always applies.
  std::function<bool(const T&)> applies;  ///< Empty: always.
  /// Throws Mismatch; `path` is that of the value, for problems inside it.
  std::function<void(const JsonNode&, T&, const std::string& path, Problems&)> read;
  std::function<std::string(const T&, int indent)> write;
  std::vector<SceneKey> inner;  ///< Keys of the objects of a list, with paths from the root.

  bool applies_to(const T& object) const { return !applies || applies(object); }
  Key&& is_required() && {
    required = true;
    return std::move(*this);
  }
  Key&& selecting() && {
    selects = true;
    return std::move(*this);
  }
  Key&& only_for(std::string words, std::function<bool(const T&)> test) && {
    condition = std::move(words);
    applies = std::move(test);
    return std::move(*this);
  }
};

/// Keys in the order of the file; a selecting key stands before those it decides on.
template <class T>
using Table = std::vector<Key<T>>;

/// The tables. `vocabulary` gives the names that only the program knows.
Table<Scene> scene_table(const SceneVocabulary& vocabulary);
Table<BodySpec> body_table();
Table<sph::Fluid> fluid_table();
Table<EmitterSpec> emitter_table();
Table<SinkSpec> sink_table();
Table<BoundarySpec> boundary_table();

}  // namespace flowskin::scenes
