#include "tracking/field/implicit_field.h"

namespace flowskin::tracking {
namespace {

/// The field itself, from wherever it is seen.
class SameEverywhere final : public LocalFields, private LocalField {
 public:
  explicit SameEverywhere(const ImplicitField& field) : field_(field) {}
  const LocalField& at(std::size_t /*point*/) const override { return *this; }

 private:
  double value(const Vec3& x) const override { return field_.value(x); }
  double value(const Vec3& x, Vec3& gradient) const override { return field_.value(x, gradient); }
  MotionJet motion_jet(const Vec3& x) const override { return field_.motion_jet(x); }
  FieldScale scale() const override { return field_.scale(); }

  const ImplicitField& field_;
};

}  // namespace

std::unique_ptr<const LocalFields> ImplicitField::near(const std::vector<Vec3>& /*points*/, double /*slack*/) const {
  return std::make_unique<SameEverywhere>(*this);
}

}  // namespace flowskin::tracking
