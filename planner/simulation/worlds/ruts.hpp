#pragma once

#include <cstdint>
#include <unordered_map>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Where wheels have been, in squares as wide as a wheel. A square is a rut for whoever comes after the rover
/// moved on by two squares, or turned back: a wheel does not follow itself.
class Ruts {
 public:
  explicit Ruts(double wheel_width_m) : square_m_(wheel_width_m) {}

  /// A wheel stands here.
  void press(const maps::Point& place);
  /// The rover moved by so much.
  void moved(double distance_m) noexcept { odometer_m_ += distance_m; }
  /// It changed its direction: what lies behind is a rut at once.
  void turnBack() noexcept { odometer_m_ += 3.0 * square_m_; }
  /// How many wheels came by before.
  int passes(const maps::Point& place) const;

 private:
  struct Mark {
    double pressed_at_m = 0.0;
    int passes = 1;
    int before = 0;  // before the wheel that stands here now
  };

  std::uint64_t square(const maps::Point& place) const noexcept;
  bool movedOn(const Mark& mark) const noexcept { return odometer_m_ - mark.pressed_at_m > 2.0 * square_m_; }

  double square_m_;
  double odometer_m_ = 0.0;
  std::unordered_map<std::uint64_t, Mark> marks_;
};

}  // namespace talus::planner
