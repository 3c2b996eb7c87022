// A subcommand of the program as data: what it is called, what it may be told, what it does.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace flowskin::tools {

/// Where the value of an option goes. A bool makes it a flag, which sets it.
using OptionTarget = std::variant<bool*, int*, double*, std::string*, std::filesystem::path*, std::optional<int>*,
                                  std::optional<double>*, std::optional<std::string>*, std::vector<double>*,
                                  std::vector<std::string>*, std::vector<std::filesystem::path>*>;

/// What an option takes besides text of the right type.
struct OptionLimits {
  std::optional<std::pair<double, double>> range{};  ///< Of numbers, both ends included.
  std::vector<std::string> words{};                  ///< The only ones; empty: any.
  std::size_t count = 0;                             ///< So many numbers; 0: as the target takes.
  bool is_required = false;
  bool shows_default = false;  ///< In the help: the target's value before the command line is read.
  std::string excludes{};      ///< An option named before this one, which cannot be given as well.
};

struct Option {
  std::string name;  ///< "--frames"; without dashes it is what stands behind the subcommand
  OptionTarget target;
  std::string help;
  OptionLimits limits{};
};

struct Command {
  std::string name;     ///< The word on the command line.
  std::string summary;  ///< One line for the help.
  std::vector<Option> options;
  /// Does it, once the options have their values; `run` keeps the targets alive. Returns the exit status or throws.
  /// @param command_line as typed
  std::function<int(const std::string& command_line)> run;
  bool takes_exactly_one = false;  ///< Of the options.
};

/// All subcommands, in the order of the help: registry.cpp.
std::vector<Command> commands();

}  // namespace flowskin::tools
