#include "tools/pipeline/compared_method.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "common/errors.h"
#include "scenes/scene_file.h"
#include "scenes/settings_in_metres.h"

namespace flowskin::tools {
namespace {

constexpr const char* kAll = "all";
constexpr const char* kTwin = "curvature-belyaev";  // the same velocity by another formula
/// Keys that are the same for all methods: the method itself, what the source gives, and what makes the surface.
constexpr std::array<std::string_view, 7> kShared{"enabled", "velocity",  "steps_per_frame", "max_slip",
                                                  "radius",  "threshold", "wall_share"};

/// The words between the separators; none of an empty text.
std::vector<std::string> split(const std::string& list, char separator) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < list.size() || (begin > 0 && begin == list.size());) {
    const std::size_t end = std::min(list.find(separator, begin), list.size());
    words.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

std::vector<std::string> known_methods() {
  std::vector<std::string> names;
  for (const auto& method : tracking::velocity_methods()) names.push_back(method.name);
  return names;
}

std::pair<std::string, std::string> parse_setting(const std::string& text, const std::string& method) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(
        fmt::format("--compare: \"{}\" in \"{}\" is no setting; expected KEY=VALUE with a key of the "
                    "scene's tracking, such as fairing=0 or integrator=rk4",
                    text, method));
  std::string key = text.substr(0, equals);
  if (key == "fairing") key = "fairing_iterations";
  if (std::find(kShared.begin(), kShared.end(), key) != kShared.end())
    throw InputError(
        fmt::format("--compare: {} in \"{}\" is the same for all that is compared; set it in the scene", key, method));
  return {key, text.substr(equals + 1)};
}

void apply(const std::vector<std::pair<std::string, std::string>>& settings, const std::string& method,
           scenes::TrackingSpec& tracking) {
  for (const auto& [key, value] : settings) {
    try {
      scenes::set_tracking_key(tracking, key, value);
    } catch (const InputError& error) {
      throw InputError(fmt::format("--compare: \"{}\": {}", method, error.what()));
    }
  }
}

ComparedMethod parse_method(const std::string& text) {
  std::vector<std::string> words = split(text, ':');
  const std::vector<std::string> known = known_methods();
  const std::string velocity = words.empty() ? "" : words.front();
  if (std::find(known.begin(), known.end(), velocity) == known.end())
    throw InputError(fmt::format("--compare: there is no velocity method \"{}\"; expected some of {}, or all", velocity,
                                 fmt::join(known, ", ")));
  ComparedMethod method{text, velocity, {}};
  for (std::size_t k = 1; k < words.size(); ++k) method.settings.push_back(parse_setting(words[k], text));
  scenes::TrackingSpec any;
  apply(method.settings, text, any);
  return method;
}

}  // namespace

std::vector<ComparedMethod> methods_to_compare(const std::string& list) {
  std::vector<ComparedMethod> methods;
  const auto add = [&methods](ComparedMethod added) {
    if (std::none_of(methods.begin(), methods.end(), [&](const auto& method) { return method.name == added.name; }))
      methods.push_back(std::move(added));
  };
  for (const std::string& word : split(list, ',')) {
    if (word != kAll) {
      add(parse_method(word));
      continue;
    }
    for (const std::string& name : known_methods())
      if (name != kTwin) add({name, name, {}});
  }
  return methods;
}

tracking::TrackerSettings settings_for(const scenes::Scene& scene, const ComparedMethod& method) {
  scenes::Scene changed = scene;
  changed.tracking.velocity = method.velocity;
  apply(method.settings, method.name, changed.tracking);
  tracking::TrackerSettings settings = scenes::settings_in_metres(changed);
  settings.max_slip = 0;
  return settings;
}

}  // namespace flowskin::tools
