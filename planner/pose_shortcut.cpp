#include <algorithm>
#include <utility>

#include <planner/pose_shortcut.hpp>

namespace talus::planner {
namespace {

// Poses before each leg, and after the last.
std::vector<Pose> joints(const PosePath& path) {
  std::vector<Pose> poses{path.start};
  for (const auto& leg : path.legs) poses.push_back(after(poses.back(), leg));
  return poses;
}

// The drive with legs first..last-1 replaced by the direct curve.
PosePath replaced(const PosePath& path, const std::vector<Pose>& at,
                  std::pair<std::size_t, std::size_t> stretch, const Kinematics& kinematics) {
  const auto begin = path.legs.begin();
  PosePath shorter{.start = path.start, .legs = {begin, begin + static_cast<std::ptrdiff_t>(stretch.first)}};
  const auto direct = connection(at[stretch.first], at[stretch.second], kinematics);
  shorter.legs.insert(shorter.legs.end(), direct.begin(), direct.end());
  shorter.legs.insert(shorter.legs.end(), begin + static_cast<std::ptrdiff_t>(stretch.second),
                      path.legs.end());
  return shorter;
}

// Tries every stretch of `gap` legs; whether anything became cheaper.
bool pass(PosePath& path, double& price, const PoseCost& cost, std::size_t gap) {
  bool better = false;
  for (std::size_t first = 0; first + gap <= path.legs.size();) {
    PosePath shorter = replaced(path, joints(path), {first, first + gap}, cost.kinematics());
    const double shorter_price = cost(shorter);
    if (shorter_price < price * (1.0 - 1e-9)) {
      path = std::move(shorter);
      price = shorter_price;
      better = true;
    }
    first += std::max<std::size_t>(1, gap / 4);
  }
  return better;
}

}  // namespace

PosePath shortened(const PosePath& path, const PoseCost& cost) {
  PosePath best = path;
  double price = cost(best);
  for (std::size_t gap = best.legs.size(); gap >= 2; gap = std::min(gap - 1, gap * 3 / 4))
    while (pass(best, price, cost, std::min(gap, best.legs.size())) && best.legs.size() > gap) {
    }
  return best;
}

}  // namespace talus::planner
