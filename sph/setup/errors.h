// What goes wrong in a simulation, by kind.
#pragma once

#include <stdexcept>

namespace flowskin::sph {

/// A setting is impossible (negative spacing, a fluid body without particles, ...); the message says which and why.
struct SettingsError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// The simulation blew up (NaN, a speed or density over its limit); the message says when, which particle, the likely
/// cause and the setting to change.
struct BlowUpError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace flowskin::sph
