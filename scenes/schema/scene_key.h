// A key of the scene file as the documentation has it.
#pragma once

#include <string>

namespace flowskin::scenes {

/// One key of the scene file, for documentation and for `flowskin scene --keys`.
struct SceneKey {
  std::string path;           ///< such as "fluid.viscosity" or "bodies[].radius"
  std::string type;           ///< such as "number", "3 numbers", "one of: box, planar, spherical"
  std::string unit;           ///< such as "m^2/s", "spacings", or "" for none
  std::string default_value;  ///< as JSON; "required" where there is none
  std::string meaning;        ///< one sentence
};

}  // namespace flowskin::scenes
