#include "common/orientation.h"

#include <array>

// This file is compiled without contraction to fused multiply-adds (CMakeLists.txt): the errors of sums below are those
// of sums that are rounded one by one.

namespace flowskin::exact {
namespace {

// A number as the exact sum of doubles that do not overlap, in ascending size [Shewchuk, Adaptive Precision
// Floating-Point Arithmetic, 1997, theorem 10]. The last one outweighs the others together and so has the sign of the
// sum. Zeros are left out.
template <int kCapacity>
class Expansion {
 public:
  int sign() const { return count_ == 0 ? 0 : sign_of(terms_[count_ - 1]); }
  int count() const { return count_; }
  double operator[](int i) const { return terms_[i]; }

  // Every rounded sum is kept together with its error, which is a double again [Knuth].
  void add(double value) {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      const double sum = value + terms_[i];
      const double added = sum - value;
      const double error = (value - (sum - added)) + (terms_[i] - added);
      if (error != 0) terms_[kept++] = error;
      value = sum;
    }
    if (value != 0) terms_[kept++] = value;
    count_ = kept;
  }

  // The error of a rounded product is a double too: what the fused multiply-add leaves of it.
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }

 private:
  std::array<double, kCapacity> terms_{};
  int count_ = 0;
};

using Difference = Expansion<2>;
using Minor = Expansion<16>;  // two products of differences, four terms by four

Difference difference(double a, double b) {
  Difference result;
  result.add(a);
  result.add(-b);
  return result;
}

// Adds factor * a * b, where factor is 1 or -1.
void add_product(const Difference& a, const Difference& b, double factor, Minor& sum) {
  for (int i = 0; i < a.count(); ++i) {
    for (int j = 0; j < b.count(); ++j) sum.add_product(factor * a[i], b[j]);
  }
}

// a d - b c
Minor minor(const Difference& a, const Difference& b, const Difference& c, const Difference& d) {
  Minor result;
  add_product(a, d, 1, result);
  add_product(b, c, -1, result);
  return result;
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<Difference, 3> u, v, w;
  for (int k = 0; k < 3; ++k) {
    u[k] = difference(a[k], d[k]);
    v[k] = difference(b[k], d[k]);
    w[k] = difference(c[k], d[k]);
  }
  Expansion<192> sum;  // three times a difference times a minor, twice 2 x 16 terms each
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    const Minor part = minor(v[next], v[last], w[next], w[last]);
    for (int i = 0; i < u[k].count(); ++i) {
      for (int j = 0; j < part.count(); ++j) sum.add_product(u[k][i], part[j]);
    }
  }
  return sum.sign();
}

int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  return minor(difference(a[0], c[0]), difference(a[1], c[1]), difference(b[0], c[0]), difference(b[1], c[1])).sign();
}

}  // namespace flowskin::exact
