#include "scenes/sources/step_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "scenes/sources/name_order.h"
#include "scenes/sources/particle_spacing.h"

namespace flowskin::scenes {
namespace {

/// Numbers that span more units per frame than this are no step counts.
constexpr double most_units_per_frame = 1000;
/// A distance of more units than this is a gap.
constexpr double gap_in_units = 2.5;

/// The largest distance, where it is a gap among distances that are uneven anyway.
std::string gap_of(const std::vector<std::int64_t>& numbers, const std::vector<double>& distances, double unit) {
  const auto largest = std::max_element(distances.begin(), distances.end());
  if (*largest <= gap_in_units * unit) return {};
  return fmt::format(
      "the time steps are {:g} apart as a rule, but {:g} after {}: the time goes on across the gaps, particles are "
      "interpolated",
      unit, *largest, numbers[static_cast<std::size_t>(largest - distances.begin())]);
}

}  // namespace

StepTimes times_of_steps(const std::vector<std::int64_t>& numbers, const std::string& name) {
  StepTimes times;
  if (numbers.size() < 2) return times;
  if (std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) != numbers.end()) {
    times.warning = fmt::format(
        "{}: the numbers of the time steps do not ascend; they are played in the order in which they stand", name);
    return times;
  }
  NameOrder counted;
  counted.counts = numbers;
  counted.numbers.assign(numbers.begin(), numbers.end());
  if (const Raster raster = raster_of(counted); raster.is_regular && raster.stride > 0) {
    times.places.assign(raster.steps.begin(), raster.steps.end());
    times.unit = raster.stride;
    if (raster.missing > 0)
      times.warning = fmt::format(
          "{} of {} time steps are missing by their numbers (the first after {}): the time goes on across the gaps, "
          "particles are interpolated",
          raster.missing, raster.steps.back() + 1, numbers[raster.before_gap]);
    return times;
  }
  std::vector<double> distances;
  for (std::size_t k = 1; k < numbers.size(); ++k)
    distances.push_back(static_cast<double>(numbers[k]) - static_cast<double>(numbers[k - 1]));
  const double unit = quantile(distances, 0.5), span = counted.numbers.back() - counted.numbers.front();
  if (span > most_units_per_frame * unit * static_cast<double>(numbers.size())) {
    times.warning = fmt::format(
        "{}: the time steps are numbered {} to {}, with gaps too large for numbers of steps: they only give the order, "
        "and all are the same time apart",
        name, numbers.front(), numbers.back());
    return times;
  }
  for (const double number : counted.numbers) times.places.push_back((number - counted.numbers.front()) / unit);
  times.unit = unit;
  times.are_even = false;
  times.warning = gap_of(numbers, distances, unit);
  return times;
}

}  // namespace flowskin::scenes
