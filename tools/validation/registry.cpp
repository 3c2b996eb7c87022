// The list of all validations.
#include <fmt/format.h>

#include "scenes/nearest_name.h"
#include "tools/errors.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {

// Each is defined in the file of its name in tools/validation/cases/.
ValidationCase conservation_case();
ValidationCase oscillating_drop_case();
ValidationCase square_drop_case();
ValidationCase rheology_case();
ValidationCase bingham_slump_case();

const std::vector<ValidationCase>& validation_cases() {
  static const std::vector<ValidationCase> cases{
      conservation_case(), oscillating_drop_case(), square_drop_case(), rheology_case(), bingham_slump_case(),
  };
  return cases;
}

const ValidationCase& validation_case(const std::string& name) {
  std::vector<std::string> names;
  for (const ValidationCase& one : validation_cases()) {
    if (one.name == name) return one;
    names.push_back(one.name);
  }
  const std::string nearest = scenes::nearest_name(name, names);
  throw InputError(fmt::format("there is no validation \"{}\"{}; `flowskin validate --list` shows all", name,
                               nearest.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", nearest)));
}

}  // namespace flowskin::tools
