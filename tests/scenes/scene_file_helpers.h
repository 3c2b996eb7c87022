// Short ways to parse a scene and to look at the message of one that is wrong.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "common/errors.h"
#include "scenes/scene_file.h"

namespace flowskin::scenes {

inline std::filesystem::path source_folder() { return std::filesystem::path(FLOWSKIN_SOURCE_DIR); }

inline Scene parse(const std::string& text) { return parse_scene(text, "test.json", source_folder() / "scenes"); }

/// The message of the error that a text makes; "no error" where it makes none.
inline std::string error_of(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// A valid scene on five lines; `more` is put in as further top-level keys on line 4.
inline std::string small_scene(const std::string& more = "") {
  return "{\n  \"particles\": {\"spacing\": 0.1},\n  \"bodies\": [{\"shape\": \"ball\", \"center\": [0, 1, 0], "
         "\"radius\": 0.5}]" +
         std::string(more.empty() ? "\n" : ",\n  " + more) + "\n}\n";
}

}  // namespace flowskin::scenes
