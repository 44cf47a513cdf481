#include <terramech/rim_contact.hpp>

namespace talus::terramech::detail {

Breaks breaks(const ShearDisplacement& displacement, double peak_rad, double exit_rad) {
  const double zero = displacement.signChange_rad(exit_rad);
  if (!(zero == zero)) return {};
  const double entry = displacement.entryAngle_rad();
  const double s =
      zero > peak_rad ? (entry - zero) / (entry - peak_rad) : (zero - exit_rad) / (peak_rad - exit_rad);
  return {{0.0, std::cbrt(s), 1.0, 1.0}, 3};
}

}  // namespace talus::terramech::detail
