// The kinds of values that stand in scene files: how each is read, checked, written and named in the documentation.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/number_text.h"
#include "common/range.h"
#include "common/vectors.h"
#include "scenes/json_text.h"

namespace flowskin::scenes {

/// A value is not of the kind expected.
struct Mismatch {
  std::string found;
  std::string hint;           ///< Such as a near name; may be empty.
  std::size_t offset = npos;  ///< Place of the culprit inside the value; npos: the key itself.
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
};

/// A kind of value with the C++ type V.
template <class V>
struct Kind {
  std::string type;                                        ///< In words, range included.
  std::function<V(const JsonNode&)> read;                  ///< Throws Mismatch.
  std::function<std::string(const V&, int indent)> write;  ///< As JSON; further lines start with `indent` spaces.
};

/// Coordinates and other signed quantities may be this large: far beyond any scene, small enough for squares and cubes.
constexpr double max_coordinate = 1e6;
/// Places of recorded particles may be as far out as map coordinates, and farther.
constexpr double max_recorded_coordinate = 1e9;

Kind<double> number(Range range);
Kind<int> integer(int min, int max);
Kind<std::uint64_t> natural();
Kind<bool> boolean();
Kind<std::string> text();
/// A text, or a list of texts.
Kind<std::vector<std::string>> texts();
/// One of the names.
Kind<std::string> choice(const std::vector<std::string>& names);
/// Three numbers, each within +-limit.
Kind<Vec3> vector(double limit = max_coordinate);
/// Three numbers, or one that stands for all three; none is 0.
Kind<Vec3> scale();
/// True or false for each of x, y and z.
Kind<std::array<bool, 3>> axes();
/// Red, green, blue.
Kind<std::array<double, 3>> color();
/// Any number of points.
Kind<std::vector<Vec3>> points(double limit = max_coordinate);

}  // namespace flowskin::scenes
