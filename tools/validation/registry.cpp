// The list of all validations.
#include <fmt/format.h>

#include "common/errors.h"
#include "scenes/nearest_name.h"
#include "tools/validation/validation_case.h"

namespace flowskin::tools {

// Each is defined in the file of its name in tools/validation/cases/.
ValidationCase hydrostatic_case();
ValidationCase conservation_case();
ValidationCase symmetry_case();
ValidationCase poiseuille_case();
ValidationCase couette_case();
ValidationCase film_case();
ValidationCase rheology_case();
ValidationCase taylor_green_case();
ValidationCase oscillating_drop_case();
ValidationCase square_drop_case();
ValidationCase bingham_slump_case();
ValidationCase gravity_current_case();
ValidationCase dam_break_case();

const std::vector<ValidationCase>& validation_cases() {
  static const std::vector<ValidationCase> cases{
      hydrostatic_case(),   conservation_case(),    symmetry_case(),     poiseuille_case(),       couette_case(),
      film_case(),          rheology_case(),        taylor_green_case(), oscillating_drop_case(), square_drop_case(),
      bingham_slump_case(), gravity_current_case(), dam_break_case(),
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
