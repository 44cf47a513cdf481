#pragma once

#include <string>

namespace talus::terramech {

/// Closed interval of valid values of a field, in the unit of the field.
struct Interval {
  double low;
  double high;
};

/// Throws std::invalid_argument "owner: field = value, must be bound" if a field is not finite or outside its
/// range.
class RangeCheck {
 public:
  explicit RangeCheck(std::string owner) : owner_(std::move(owner)) {}

  void finite(const char* field, double value) const;
  void atLeast(const char* field, double value, double bound) const;
  void above(const char* field, double value, double bound) const;
  void within(const char* field, double value, Interval interval) const;
  void zeroOrWithin(const char* field, double value, Interval interval) const;

 private:
  [[noreturn]] void refuse(const char* field, double value, const std::string& bound) const;

  std::string owner_;
};

}  // namespace talus::terramech
