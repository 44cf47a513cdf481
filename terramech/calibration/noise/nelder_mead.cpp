#include <nlopt.hpp>

#include <talus/terramech/calibration/noise/nelder_mead.hpp>

namespace talus::terramech {
namespace {

using Cost = std::function<double(const std::vector<double>&)>;

double costAt(const std::vector<double>& x, std::vector<double>&, void* cost) {
  return (*static_cast<const Cost*>(cost))(x);
}

}  // namespace

std::vector<double> nelderMead(const Cost& cost, const std::vector<double>& start,
                               const NelderMeadOptions& options) {
  if (start.empty()) return start;
  nlopt::opt search(nlopt::LN_NELDERMEAD, static_cast<unsigned>(start.size()));
  search.set_min_objective(costAt, const_cast<Cost*>(&cost));
  search.set_initial_step(options.step);
  search.set_maxeval(options.evaluations);
  search.set_ftol_abs(options.tolerance);
  std::vector<double> x = start;
  double value = 0.0;
  try {
    search.optimize(x, value);
  } catch (const nlopt::roundoff_limited&) {  // no step improves x within rounding
  }
  return x;
}

}  // namespace talus::terramech
