#include <cmath>
#include <sstream>
#include <stdexcept>

#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {
namespace {

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace

void RangeCheck::finite(const char* field, double value) const {
  if (!std::isfinite(value)) refuse(field, value, "finite");
}

void RangeCheck::atLeast(const char* field, double value, double bound) const {
  finite(field, value);
  if (value < bound) refuse(field, value, ">= " + text(bound));
}

void RangeCheck::above(const char* field, double value, double bound) const {
  finite(field, value);
  if (value <= bound) refuse(field, value, "> " + text(bound));
}

void RangeCheck::within(const char* field, double value, Interval interval) const {
  finite(field, value);
  if (value < interval.low || value > interval.high)
    refuse(field, value, "in [" + text(interval.low) + ", " + text(interval.high) + "]");
}

void RangeCheck::zeroOrWithin(const char* field, double value, Interval interval) const {
  finite(field, value);
  if (value != 0.0 && (value < interval.low || value > interval.high))
    refuse(field, value, "0 or in [" + text(interval.low) + ", " + text(interval.high) + "]");
}

void RangeCheck::refuse(const char* field, double value, const std::string& bound) const {
  throw std::invalid_argument(owner_ + ": " + field + " = " + text(value) + ", must be " + bound);
}

}  // namespace talus::terramech
