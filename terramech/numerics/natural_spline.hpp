#pragma once

#include <vector>

namespace talus::terramech {

/// Natural cubic spline through (knots, values); constant outside the knots. With one knot the spline is
/// constant, without knots 0.
class NaturalSpline {
 public:
  NaturalSpline() = default;
  NaturalSpline(std::vector<double> knots, std::vector<double> values);

  double operator()(double x) const;

 private:
  std::vector<double> knots_, values_, curvatures_;
};

}  // namespace talus::terramech
