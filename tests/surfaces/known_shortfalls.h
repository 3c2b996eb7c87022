// Where scenes do not keep a limit yet, and how far off they are: nothing else may go wrong, and this no worse.
#pragma once

#include <string>

namespace flowskin::surfaces {

struct KnownShortfall {
  std::string scene, heading;  ///< As in the table.
  int frames;                  ///< So many may be beyond the limit.
  double worst;                ///< None may be worse.
};

/// Null where there is none. docs/surfaces.md has the reasons.
const KnownShortfall* known_shortfall(const std::string& scene, const std::string& heading);

}  // namespace flowskin::surfaces
