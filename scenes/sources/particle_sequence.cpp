#include "scenes/sources/particle_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "common/bounds.h"
#include "common/errors.h"
#include "common/number_text.h"
#include "scenes/io/json_particles.h"
#include "scenes/io/particle_file.h"
#include "scenes/io/read_bytes.h"
#include "scenes/io/vtp_reader.h"
#include "scenes/scene_checks.h"
#include "scenes/sources/file_pattern.h"
#include "scenes/sources/name_order.h"
#include "scenes/sources/particle_spacing.h"
#include "scenes/sources/step_times.h"

namespace flowskin::scenes {
namespace {

constexpr double default_interval = 1.0 / 30;  // s
/// Between files, by their times (s).
constexpr double shortest_interval = 1e-9, longest_interval = 1e9;
/// Times this near to whole multiples of the interval (in intervals) are taken for them: files hold them rounded.
constexpr double even_tolerance = 1e-3;
/// Frame rates this near to a whole number (relative) are taken for it.
constexpr double whole_rate_tolerance = 1e-3;
/// By order, most particles of two files would have to move this many spacings: then the order is not theirs.
constexpr double far_in_spacings = 2;

ParticleNeeds needs_of(const RecordedSpec& spec) {
  ParticleNeeds needs;
  needs.ids = spec.ids == RecordedSpec::Ids::automatic;
  needs.keep = spec.keep;
  if (!spec.region.empty()) {
    if (spec.region.size() != 2) throw InputError("particles.recorded.region: expected two corners");
    needs.region = sph::Box{spec.region[0].cwiseMin(spec.region[1]), spec.region[0].cwiseMax(spec.region[1])};
  }
  needs.skip_invalid = spec.skip_invalid;
  needs.skip_duplicates = spec.skip_duplicates;
  return needs;
}

using Entries = std::vector<std::pair<double, std::filesystem::path>>;

/// Time and file of each entry of a .pvd or .vtk.series, whatever it is called; none where the file is another one.
Entries entries_of_collection(const std::filesystem::path& file) {
  if (!is_collection(file)) return {};
  const std::string bytes = read_bytes(file);
  if (!is_file_series(bytes)) return parse_pvd(bytes, file);
  Entries entries;
  for (auto& [time, name] : parse_file_series(bytes, file.string()))
    entries.emplace_back(time, file.parent_path() / name);
  return entries;
}

/// What a look at each file tells.
struct Census {
  std::vector<double> times;         // empty where some file tells none
  std::vector<std::int64_t> counts;  // numbers of time steps; the same
  bool same_count = true;
};

class SequenceOpener {
 public:
  SequenceOpener(const RecordedSpec& spec, const std::string& directory) : spec_(spec), directory_(directory) {}

  ParticleSequence open() {
    if (spec_.frame_interval > 0 && spec_.frame_interval < shortest_interval)
      throw InputError(fmt::format("particles.recorded.frame_interval is {:.4g} s; expected 0 or at least {:g} s",
                                   spec_.frame_interval, shortest_interval));
    if (!take_collection()) take_files();
    sequence_.needs = needs_of(spec_);
    const std::vector<ParticleTable>& steps = sequence_.tables->steps(sequence_.places.front().file);
    const std::vector<std::string>& notes = steps.front().notes;
    sequence_.notes.insert(sequence_.notes.end(), notes.begin(), notes.end());
    const bool has_many_steps = steps.size() > 1;
    if (has_many_steps) take_steps();
    const ParticleTable table = sequence_.tables->table(sequence_.places.front());
    sequence_.first = particles_of_file(table, sequence_.places.front().name(), sequence_.needs);
    refuse_if_none_is_left();
    if (sequence_.places.size() == 1)
      sequence_.notes.push_back(fmt::format(
          "a single frame: its surface is made, {}",
          sequence_.first.has_velocities ? "moving as the velocities in the file say" : "and its velocity is zero"));
    const bool wants_times = file_times_.empty() && spec_.frame_interval == 0 && table.time.has_value();
    const bool wants_ids =
        sequence_.places.size() > 1 && spec_.ids == RecordedSpec::Ids::automatic && !sequence_.first.has_ids;
    const bool wants_counts =
        sequence_.places.size() > 1 && file_times_.empty() && !has_many_steps && table.step.has_value();
    const Census census = wants_times || wants_ids || wants_counts ? look_at_all(whole_count(table)) : Census{};
    if (wants_counts) count_steps_in_files(census.counts);
    tell_of_names();
    settle_times(wants_times ? census.times : std::vector<double>{}, table.time.has_value());
    settle_ids(census);
    return std::move(sequence_);
  }

  std::vector<FrameTables::Place> places() {
    if (!take_collection()) take_files();
    return std::move(sequence_.places);
  }

  std::vector<std::filesystem::path> files() {
    const bool by_collection = take_collection();
    if (!by_collection) take_files();
    std::vector<std::filesystem::path> files;
    for (const FrameTables::Place& place : sequence_.places) {
      files.push_back(place.file);
      files.insert(files.end(), place.more.begin(), place.more.end());
    }
    if (by_collection) files.emplace_back(absolute_name(directory_, spec_.files.front()));
    return files;
  }

 private:
  /// @throws InputError where the options leave out every particle of every file; it names those that do.
  void refuse_if_none_is_left() const {
    const ParticleNeeds& needs = sequence_.needs;
    if (sequence_.first.left_out.all() == 0 || !sequence_.first.state.ids.empty()) return;
    LeftOut left_out = sequence_.first.left_out;
    for (std::size_t k = 1; k < sequence_.places.size(); ++k) {
      const FrameTables::Place& place = sequence_.places[k];
      const ParticleFile file = particles_from_table(sequence_.tables->table(place), place.name(), needs);
      if (!file.state.ids.empty()) return;
      left_out += file.left_out;
    }
    const ParticleFile all =
        particles_from_table(sequence_.tables->table(sequence_.places.front()), sequence_.places.front().name(),
                             {.ids = false, .skip_invalid = true});
    std::string where;
    if (needs.region && !all.state.positions.empty()) {
      const Box box = bounds(all.state.positions);
      where =
          fmt::format(". Those of the first file lie between ({:.4g}, {:.4g}, {:.4g}) and ({:.4g}, {:.4g}, {:.4g}) m",
                      box.min.x(), box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z());
    }
    const std::size_t others = sequence_.places.size() - 1;
    throw InputError(
        fmt::format("{}: no particle is left{}; left out of {}: {}{}", sequence_.places.front().name(),
                    others > 0 ? fmt::format(" in this and {} other frame{}", others, others == 1 ? "" : "s") : "",
                    left_out.all(), left_out_text(left_out), where));
  }

  /// A single .pvd or .vtk.series names the files and their times. Files of one time are parts of one frame.
  bool take_collection() {
    if (spec_.files.size() != 1) return false;
    Entries entries = entries_of_collection(absolute_name(directory_, spec_.files.front()));
    if (entries.empty()) return false;
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [time, path] : entries) {
      if (!file_times_.empty() && time == file_times_.back()) {
        sequence_.places.back().more.push_back(path);
        continue;
      }
      file_times_.push_back(time);
      sequence_.places.push_back({path, {}, 0, true});
    }
    if (entries.size() > sequence_.places.size())
      sequence_.notes.push_back(fmt::format("{} files for {} times: those of one time are read as one", entries.size(),
                                            sequence_.places.size()));
    return true;
  }

  /// Files of many steps: every step is a frame.
  void take_steps() {
    if (!file_times_.empty())
      throw InputError(fmt::format("{}: holds {} time steps, but its time is given from outside; give the file alone",
                                   sequence_.places.front().file.string(),
                                   sequence_.tables->steps(sequence_.places.front().file).size()));
    const std::vector<FrameTables::Place> files = std::exchange(sequence_.places, {});
    std::vector<std::int64_t> counts;
    for (const FrameTables::Place& place : files) {
      const std::vector<ParticleTable>& steps = sequence_.tables->steps(place.file);
      for (std::size_t k = 0; k < steps.size(); ++k) {
        sequence_.places.push_back({place.file, {}, k, false});
        if (steps[k].step) counts.push_back(static_cast<std::int64_t>(*steps[k].step));
      }
    }
    sequence_.notes.push_back(
        fmt::format("{} time steps in {} file{}", sequence_.places.size(), files.size(), files.size() == 1 ? "" : "s"));
    numbers_.clear();
    files_are_uneven_.clear();
    files_are_missing_.clear();
    steps_.resize(sequence_.places.size());
    std::iota(steps_.begin(), steps_.end(), 0.0);
    if (counts.size() == sequence_.places.size()) count_time_steps(counts);
  }

  /// Gaps between the numbers of time steps are gaps in time.
  void count_time_steps(const std::vector<std::int64_t>& counts) {
    const StepTimes by_number = times_of_steps(counts, sequence_.places.front().file.string());
    if (!by_number.warning.empty()) sequence_.warnings.push_back(by_number.warning);
    if (by_number.places.empty()) return;
    steps_ = by_number.places;
    step_unit_ = by_number.unit;
    sequence_.is_even = by_number.are_even;
  }

  /// The same of files of one step each, whose names say less.
  void count_steps_in_files(const std::vector<std::int64_t>& counts) {
    if (counts.size() != sequence_.places.size() ||
        std::adjacent_find(counts.begin(), counts.end(), std::greater_equal<>()) != counts.end())
      return;
    files_are_uneven_.clear();
    files_are_missing_.clear();
    count_time_steps(counts);
  }

  void take_files() {
    std::vector<std::string> names;
    for (const std::string& name : spec_.files) names.push_back(absolute_name(directory_, name));
    NumberedFiles files = files_of_patterns(names);
    if (spec_.times_in_names) file_times_ = times_from_names(files);
    if (files.look_like_times) numbers_ = files.numbers;
    for (std::filesystem::path& path : files.paths) sequence_.places.push_back({std::move(path), {}, 0, true});
    steps_.assign(files.steps.begin(), files.steps.end());
    sequence_.notes.insert(sequence_.notes.end(), files.notes.begin(), files.notes.end());
    files_are_uneven_ = std::move(files.uneven);
    files_are_missing_ = std::move(files.missing);
  }

  void tell_of_names() {
    if (!files_are_uneven_.empty()) sequence_.notes.push_back(files_are_uneven_);
    if (!files_are_missing_.empty())
      sequence_.warnings.push_back(files_are_missing_ +
                                   ": the time goes on across the gaps, particles are interpolated");
  }

  static std::vector<double> times_from_names(const NumberedFiles& files) {
    if (files.numbers.empty() && files.paths.size() > 1)
      throw InputError(fmt::format("{}: there is no one number in the names of the files that could be a time",
                                   files.paths.front().string()));
    return files.numbers;
  }

  /// Of the first file, as look_at_all() counts.
  std::size_t whole_count(const ParticleTable& table) const {
    const bool whole = sequence_.needs.keep.empty() && !sequence_.needs.region;
    return whole ? table.count : sequence_.first.state.ids.size();
  }

  /// @param count of particles in the first file
  Census look_at_all(std::size_t count) const {
    Census census;
    bool all_have_times = true;
    for (const FrameTables::Place& place : sequence_.places) {
      const ParticleTable table = sequence_.tables->table(place);
      // What is kept may be less in one file than in another.
      const bool whole = sequence_.needs.keep.empty() && !sequence_.needs.region;
      const std::size_t here =
          whole ? table.count : particles_from_table(table, place.name(), sequence_.needs).state.ids.size();
      census.same_count = census.same_count && here == count;
      all_have_times = all_have_times && table.time && std::isfinite(*table.time);
      if (all_have_times) census.times.push_back(*table.time);
      if (table.step) census.counts.push_back(static_cast<std::int64_t>(*table.step));
    }
    if (!all_have_times) census.times.clear();
    return census;
  }

  void settle_times(const std::vector<double>& times_in_files, bool first_has_time) {
    const bool ascending = std::adjacent_find(times_in_files.begin(), times_in_files.end(), std::greater_equal<>()) ==
                           times_in_files.end();
    if (spec_.frame_interval > 0 && step_unit_ > 1 && sequence_.is_even)
      sequence_.notes.push_back(fmt::format("{:g} time steps are {:.4g} s", step_unit_, spec_.frame_interval));
    if (spec_.frame_interval > 0 && (file_times_.empty() || sequence_.places.size() == 1)) {
      by_steps(spec_.frame_interval);
    } else if (spec_.frame_interval > 0) {
      steps_.clear();
      for (std::size_t k = 0; k < file_times_.size(); ++k) steps_.push_back(static_cast<double>(k));
      by_steps(spec_.frame_interval);
    } else if (!file_times_.empty()) {
      by_times(file_times_);
    } else if (sequence_.places.size() > 1 && times_in_files.size() == sequence_.places.size() && ascending) {
      by_times(times_in_files);
    } else {
      by_steps(default_interval);
      if (sequence_.places.size() > 1)
        sequence_.notes.push_back(
            fmt::format("{}: 1/30 s {} is assumed; --frame-rate or --time-step sets it",
                        first_has_time ? "the times in the files do not ascend" : "the files give no times",
                        step_unit_ > 0 ? fmt::format("for {:g} time steps", step_unit_) : "between files"));
      if (!numbers_.empty())
        sequence_.notes.push_back(fmt::format(
            "the numbers in the names, {} to {}, look like times in seconds: --times-in-names plays them so",
            number_text(numbers_.front()), number_text(numbers_.back())));
    }
  }

  void by_steps(double interval) {
    if (steps_.empty()) steps_.assign(1, 0);
    sequence_.interval = interval;
    for (const double step : steps_) sequence_.times.push_back(step * interval);
    if (!sequence_.is_even)
      sequence_.notes.push_back(fmt::format(
          "the time steps are unevenly numbered: times are in proportion to the numbers, {:g} time steps are {:.4g} s, "
          "and frames are interpolated",
          step_unit_, interval));
  }

  void by_times(const std::vector<double>& times) {
    std::vector<double> intervals;
    for (std::size_t k = 1; k < times.size(); ++k) intervals.push_back(times[k] - times[k - 1]);
    double interval = intervals.empty() ? default_interval : quantile(intervals, 0.5);
    if (!(interval >= shortest_interval && interval <= longest_interval &&
          times.back() - times.front() <= longest_interval * 1e6))
      throw InputError(
          fmt::format("{}: the times from {:.4g} to {:.4g} s, usually {:.4g} s apart, are none that can be played "
                      "({:.4g} to {:.4g} s apart); --time-step or --frame-rate gives others",
                      sequence_.places.front().file.string(), times.front(), times.back(), interval, shortest_interval,
                      longest_interval));
    const double rate = 1 / interval;
    if (std::round(rate) >= 1 && std::abs(rate - std::round(rate)) < whole_rate_tolerance * rate)
      interval = 1 / std::round(rate);
    sequence_.interval = interval;
    sequence_.is_even = true;
    std::vector<std::uint64_t> steps;
    for (const double time : times) {
      const double step = (time - times.front()) / interval;
      const double whole = std::round(step);
      // The tolerance grows with the steps: the interval itself is rounded.
      sequence_.is_even = sequence_.is_even && std::abs(step - whole) < even_tolerance * std::max(1.0, whole);
      steps.push_back(static_cast<std::uint64_t>(std::max(0.0, whole)));
    }
    sequence_.is_even = sequence_.is_even && std::adjacent_find(steps.begin(), steps.end()) == steps.end();
    if (sequence_.is_even) {
      steps_.assign(steps.begin(), steps.end());
      by_steps(interval);
      if (steps.back() + 1 > steps.size())
        sequence_.warnings.push_back(
            fmt::format("{} of {} files are missing by their times: particles are interpolated across the gaps",
                        steps.back() + 1 - steps.size(), steps.back() + 1));
    } else {
      for (const double time : times) sequence_.times.push_back(time - times.front());
      sequence_.notes.push_back(fmt::format(
          "the files are not evenly spaced in time: {:.4g} s is the usual step, frames are interpolated", interval));
    }
  }

  void settle_ids(const Census& census) {
    using Ids = ParticleSequence::Ids;
    if (spec_.ids == RecordedSpec::Ids::none) {
      sequence_.ids = Ids::none;
    } else if (spec_.ids == RecordedSpec::Ids::order || (!sequence_.first.has_ids && sequence_.places.size() == 1)) {
      sequence_.ids = Ids::order;
    } else if (!sequence_.first.has_ids) {
      sequence_.ids = Ids::none;
      if (spec_.skip_invalid || spec_.skip_duplicates || !spec_.region.empty()) {
        sequence_.notes.emplace_back(
            "the particles have no ids, and some may be left out: it is not known which is which from file to file");
        return;
      }
      if (!census.same_count) {
        sequence_.notes.emplace_back(
            "the particles have no ids and their number changes: it is not known which is which from file to file");
      } else if (!order_is_lasting()) {
        sequence_.warnings.emplace_back(
            "the particles have no ids, and their order changes from file to file: it is not known which is which");
      } else {
        sequence_.ids = Ids::order;
        sequence_.notes.emplace_back(
            "the particles have no ids but the same number in every file: their order is taken for ids (--no-ids "
            "refuses)");
      }
    }
  }

  /// False where, by their order, most particles would jump from the first file to the second although the particles as
  /// a whole hardly move: some programs sort them anew.
  bool order_is_lasting() const {
    if (sequence_.places.size() < 2) return true;
    const std::vector<Vec3>& before = sequence_.first.state.positions;
    const std::vector<Vec3> after =
        particles_of_file(sequence_.tables->table(sequence_.places[1]), sequence_.places[1].name(), sequence_.needs)
            .state.positions;
    std::vector<double> moved;
    for (std::size_t i = 0; i < before.size(); ++i) moved.push_back((after[i] - before[i]).norm());
    const double by_order = quantile(moved, 0.5), nearest = quantile(nearest_distances(before, after), 0.5);
    return by_order <= far_in_spacings * estimated_spacing(before) || by_order <= 4 * nearest;
  }

  const RecordedSpec& spec_;
  const std::string& directory_;
  std::vector<double> file_times_;  // of a collection, or in the names
  std::vector<double> numbers_;     // in the names, where they look like times
  std::vector<double> steps_;       // by the numbers, in intervals
  double step_unit_ = 0;            // how many time steps of the solver an interval has, where they are numbered
  std::string files_are_uneven_, files_are_missing_;  // by their names, in words
  ParticleSequence sequence_;
};

}  // namespace

bool is_collection(const std::filesystem::path& file) {
  constexpr std::size_t telling = 4096;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  const std::string start = first_bytes(file, telling);
  return start.find("\"Collection\"") != std::string::npos || start.find("<Collection") != std::string::npos ||
         file.extension() == ".pvd" || is_file_series(start);
}

ParticleSequence open_sequence(const RecordedSpec& spec, const std::string& directory) {
  return SequenceOpener(spec, directory).open();
}

std::vector<std::filesystem::path> sequence_files(const RecordedSpec& spec, const std::string& directory) {
  return SequenceOpener(spec, directory).files();
}

std::vector<FrameTables::Place> sequence_places(const RecordedSpec& spec, const std::string& directory) {
  return SequenceOpener(spec, directory).places();
}

ParticleFile read_sequence_file(const ParticleSequence& sequence, std::size_t k) {
  const FrameTables::Place& place = sequence.places[k];
  ParticleFile file = particles_of_file(sequence.tables->table(place), place.name(), sequence.needs);
  const auto require = [&](bool has, bool first_has, const char* what) {
    if (first_has && !has)
      throw InputError(
          fmt::format("{}: the particles have no {}, but those of {} do; all files of a sequence need the "
                      "same columns",
                      place.name(), what, sequence.places.front().name()));
  };
  require(file.has_ids, sequence.first.has_ids && sequence.ids == ParticleSequence::Ids::of_files, "ids");
  require(file.has_velocities, sequence.first.has_velocities, "velocities");
  require(file.has_rest_positions, sequence.first.has_rest_positions, "rest positions");
  const std::size_t count = file.state.positions.size(), first_count = sequence.first.state.positions.size();
  if (sequence.ids == ParticleSequence::Ids::order && count != first_count)
    throw InputError(
        fmt::format("{}: {} particles where the first file has {}, and they have no ids (column \"id\") to "
                    "find them again by; --no-ids does without them",
                    place.name(), count, first_count));
  return file;
}

}  // namespace flowskin::scenes
