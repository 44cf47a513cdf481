#pragma once

#include <string>

namespace talus::terramech {

/// Closed interval [low, high] of valid values of a field, in the unit of the field.
struct Interval {
  double low;
  double high;
};

/// Checks the fields of one object. Each check throws std::invalid_argument with the message "owner: field =
/// value, must be bound" if the value is not finite or outside its range.
class RangeCheck {
 public:
  /// `owner` names the checked object in messages.
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
