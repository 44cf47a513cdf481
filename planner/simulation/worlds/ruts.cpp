#include <cmath>

#include <talus/planner/simulation/worlds/ruts.hpp>

namespace talus::planner {

std::uint64_t Ruts::square(const maps::Point& place) const noexcept {
  const auto index = [this](double value_m) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value_m / square_m_))) &
           0xffffffffU;
  };
  return index(place.x_m) << 32 | index(place.y_m);
}

void Ruts::press(const maps::Point& place) {
  const auto [found, fresh] = marks_.try_emplace(square(place), Mark{.pressed_at_m = odometer_m_});
  if (fresh) return;
  Mark& mark = found->second;
  if (movedOn(mark)) {
    mark.before = mark.passes;
    ++mark.passes;
  }
  mark.pressed_at_m = odometer_m_;
}

int Ruts::passes(const maps::Point& place) const {
  const auto found = marks_.find(square(place));
  if (found == marks_.end()) return 0;
  return movedOn(found->second) ? found->second.passes : found->second.before;
}

}  // namespace talus::planner
