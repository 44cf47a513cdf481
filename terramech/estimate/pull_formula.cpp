#include <cmath>
#include <stdexcept>

#include <talus/terramech/estimate/pull_formula.hpp>

namespace talus::terramech {

const std::vector<std::string>& pullFormulas() {
  static const std::vector<std::string> names{"single-force", "small-angle", "triangular", "plane"};
  return names;
}

Estimate pullOverLoadBy(const std::string& formula, const Wheel& wheel, const WheelSample& sample,
                        const ReadingErrors& errors) {
  const Estimate ours = pullOverLoad(wheel, sample, errors);
  if (formula == "single-force") return ours;
  if (formula == "small-angle") return {pullAtSmallAngle(wheel, sample), std::hypot(ours.std, 0.013)};
  if (formula == "triangular") return {pullOfTriangularStress(wheel, sample), std::hypot(ours.std, 0.014)};
  if (formula == "plane") return {kThesisPlane.at(wheel, sample), std::hypot(ours.std, 0.028)};
  throw std::invalid_argument("formula '" + formula +
                              "' is unknown, must be single-force, small-angle, triangular or plane");
}

}  // namespace talus::terramech
