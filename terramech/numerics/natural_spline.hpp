#pragma once

#include <vector>

namespace talus::terramech {

/// Natural cubic spline through the points (knots, values), constant beyond the outermost knots. With one
/// knot the spline is constant; without knots it is 0.
class NaturalSpline {
 public:
  NaturalSpline() = default;
  NaturalSpline(std::vector<double> knots, std::vector<double> values);

  /// Returns the value of the spline at x.
  double operator()(double x) const;

 private:
  std::vector<double> knots_, values_, curvatures_;
};

}  // namespace talus::terramech
