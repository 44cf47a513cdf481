#pragma once

#include <cstdint>
#include <unordered_map>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Tracks of wheels, in squares as wide as a wheel. A square becomes a rut after the rover has moved on by
/// more than two squares or has turned back, so that a wheel does not drive in the rut that it is making.
class Ruts {
 public:
  /// The width of the squares is the wheel width [m], > 0.
  explicit Ruts(double wheel_width_m) : square_m_(wheel_width_m) {}

  /// Marks the square under a wheel.
  void press(const maps::Point& place);
  /// Adds a driven distance.
  void moved(double distance_m) noexcept { odometer_m_ += distance_m; }
  /// The rover reversed its direction: all squares behind it are ruts at once.
  void turnBack() noexcept { odometer_m_ += 3.0 * square_m_; }
  /// Returns the number of earlier wheel passes at a place.
  int passes(const maps::Point& place) const;

 private:
  struct Mark {
    double pressed_at_m = 0.0;
    int passes = 1;
    int before = 0;  // passes before the present wheel
  };

  std::uint64_t square(const maps::Point& place) const noexcept;
  bool movedOn(const Mark& mark) const noexcept { return odometer_m_ - mark.pressed_at_m > 2.0 * square_m_; }

  double square_m_;
  double odometer_m_ = 0.0;
  std::unordered_map<std::uint64_t, Mark> marks_;
};

}  // namespace talus::planner
