// The command line of the program; the only file that includes CLI11, which is slow to compile.
#include "tools/commands/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <new>
#include <sstream>

#include "common/errors.h"
#include "common/thread_count.h"
#include "sph/solver.h"
#include "tools/commands/command.h"
#include "tools/pipeline/interruption.h"
#include "tools/report/messages.h"
#include "tools/report/run_log.h"

namespace flowskin::tools {

namespace {

constexpr int kDone = 0, kRunFailed = 1, kInputWrong = 2;

/// The number type of a target of one number, or nothing.
template <class T>
struct NumberOf {};
template <>
struct NumberOf<int> {
  using Type = int;
};
template <>
struct NumberOf<double> {
  using Type = double;
};
template <class T>
struct NumberOf<std::optional<T>> : NumberOf<T> {};
template <class T>
concept IsNumber = requires {
  typename NumberOf<T>::Type;
};

template <class T>
CLI::Option* add_target(CLI::App& app, const Option& option, T& target) {
  if constexpr (std::is_same_v<T, bool>) {
    return app.add_flag(option.name, target, option.help);
  } else {
    CLI::Option* added = app.add_option(option.name, target, option.help);
    if constexpr (IsNumber<T>) {
      using Number = typename NumberOf<T>::Type;
      if (const auto& range = option.limits.range)
        added->check(CLI::Range(static_cast<Number>(range->first), static_cast<Number>(range->second)));
    }
    return added;
  }
}

void add_option(CLI::App& app, const Option& option) {
  const OptionLimits& limits = option.limits;
  CLI::Option* added = std::visit([&](auto* target) { return add_target(app, option, *target); }, option.target);
  if (!limits.words.empty()) added->check(CLI::IsMember(limits.words));
  if (limits.count > 0) added->expected(static_cast<int>(limits.count));
  if (limits.is_required) added->required();
  if (limits.shows_default) added->capture_default_str();
  if (!limits.excludes.empty()) added->excludes(app.get_option(limits.excludes));
}

CLI::App* add_command(CLI::App& app, const Command& command) {
  CLI::App* added = app.add_subcommand(command.name, command.summary);
  CLI::App* with_options = command.takes_exactly_one ? added->add_option_group("about") : added;
  for (const Option& option : command.options) add_option(*with_options, option);
  if (command.takes_exactly_one) with_options->require_option(1);
  return added;
}

/// As one would type it.
std::string shell_word(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,/:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string as_typed(int argc, const char* const* argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) text += (i ? " " : "") + shell_word(argv[i]);
  return text;
}

/// CLI11 would only say that a subcommand is missing.
void check_subcommand(const std::vector<Command>& all, int argc, const char* const* argv) {
  const auto named = [&](const Command& command) { return command.name == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && std::none_of(all.begin(), all.end(), named))
    throw InputError(fmt::format("there is no subcommand \"{}\"; `flowskin --help` lists them", argv[1]));
}

int run_chosen(int argc, const char* const* argv) {
  CLI::App app{
      "A viscous SPH fluid simulator whose surface is a tracked mesh: textures flow with the fluid.\n"
      "Start with: flowskin run scenes/stairs.json"};
  app.name("flowskin");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done; 1 the run failed; 2 the input or the command line is wrong; 130, 143 or 129 interrupted by "
      "Ctrl-C, SIGTERM or, with --stop-on-hangup, SIGHUP (--resume goes on).\n"
      "`flowskin COMMAND --help` lists a command's options.");
  const std::vector<Command> all = commands();
  std::vector<const CLI::App*> added;
  for (const Command& command : all) added.push_back(add_command(app, command));
  check_subcommand(all, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream help, complaint;
    const int status = app.exit(error, help, complaint);
    put(help.str());
    say(printable(complaint.str()));
    return status == 0 ? kDone : kInputWrong;
  }
  const auto chosen = std::find_if(added.begin(), added.end(), [](const CLI::App* one) { return one->parsed(); });
  return all[static_cast<std::size_t>(chosen - added.begin())].run(as_typed(argc, argv));
}

int complain(const char* message, int status) {
  say_line(std::string("flowskin: ") + message);
  return status;
}

int run_guarded(int argc, const char* const* argv) {
  try {
    return run_chosen(argc, argv);
  } catch (const InterruptedError& error) {
    return complain(error.what(), InterruptedError::exit_status());
  } catch (const InputError& error) {
    return complain(error.what(), kInputWrong);
  } catch (const sph::SettingsError& error) {
    return complain(error.what(), kInputWrong);
  } catch (const std::bad_alloc&) {
    return complain("out of memory: use fewer particles (a larger spacing) or a larger edge_length", kRunFailed);
  } catch (const std::exception& error) {
    return complain(plain_message(error).c_str(), interrupted() ? InterruptedError::exit_status() : kRunFailed);
  }
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  secure_standard_streams();
  use_threads(0);
  const int status = run_guarded(argc, argv);
  const std::string failure = output_failure();
  if (failure.empty()) return status;
  return complain(("cannot write to standard output: " + failure).c_str(), status == kDone ? kRunFailed : status);
}

}  // namespace flowskin::tools
