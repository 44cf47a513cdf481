// Shows   slip and slip angle of a rover at equilibrium on an inclined plane, for headings all around.
// Needs   talus::terramech, talus::terramech_io.
// Prints  one row per heading, with the reason where there is no equilibrium.
// Call    slope_headings SOIL ROVER TILT_DEG.
// Next    plan_site.cpp: a route over such ground.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>

#include <talus/terramech/terramech_io.hpp>

namespace {

namespace terramech = talus::terramech;

constexpr double kDegrees = 180.0 / std::numbers::pi;

// Headings from uphill, over across the slope with the uphill side on the left, to downhill.
void print(const terramech::SlopeEquilibrium& equilibrium, double tilt_rad) {
  std::printf("heading  slip    slip angle  body turn  energy    strength reserve  holds\n");
  for (int heading = 0; heading <= 180; heading += 15) {
    const double gradient = std::tan(tilt_rad), way = heading / kDegrees;
    const terramech::Gradient plane{.along = gradient * std::cos(way), .across = gradient * std::sin(way)};
    const terramech::SlopeState s = equilibrium.at(plane);
    std::printf("%4d deg ", heading);
    if (s.holds())
      std::printf("%6.3f  %6.1f deg  %5.1f deg  %6.0f J/m            %6.3f  %s\n", s.slip,
                  s.slip_angle_rad * kDegrees, s.body_turn_rad * kDegrees, s.energy_J_per_m,
                  1.0 - equilibrium.leastStrength(plane), terramech::name(s.failure));
    else
      std::printf("     -           -          -          -                 -  %s\n",
                  terramech::name(s.failure));
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) {
    std::fprintf(stderr, "usage: slope_headings SOIL ROVER TILT_DEG\n");
    return 2;
  }
  try {
    const terramech::Rover rover = terramech::loadRover(arguments[2]);
    for (const std::string& assumed : terramech::slopeAssumptions(rover))
      std::fprintf(stderr, "%s\n", assumed.c_str());
    print(terramech::SlopeEquilibrium{terramech::loadSoil(arguments[1]), rover},
          std::atof(arguments[3]) / kDegrees);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
  return 0;
}
