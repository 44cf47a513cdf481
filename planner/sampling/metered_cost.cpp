#include <cmath>
#include <limits>

#include <talus/planner/sampling/metered_cost.hpp>

namespace talus::planner {

double MeteredCost::operator()(const Segment& motion) const noexcept {
  if (motion.from == last_.from && motion.to == last_.to) return last_cost_J_;
  const double metres = std::hypot(motion.to.x_m - motion.from.x_m, motion.to.y_m - motion.from.y_m);
  work_ += 1 + static_cast<std::uint64_t>(metres / motion_.map().grid().resolution_m);
  last_ = motion;
  last_cost_J_ = turnsAllowed(motion) ? motion_(motion) : std::numeric_limits<double>::infinity();
  return last_cost_J_;
}

bool MeteredCost::turnsAllowed(const Segment& motion) const noexcept {
  return (motion.from == ends_.from || motion_.turnAllowed(motion, motion.from)) &&
         (motion.to == ends_.to || motion_.turnAllowed(motion, motion.to));
}

}  // namespace talus::planner
