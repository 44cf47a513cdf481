#pragma once

#include <map>
#include <vector>

#include "ground.hpp"
#include "journal.hpp"

namespace safety {

/// By how much ground is believed to pull more than its class: departure of DP/W [-].
struct Departure {
  double mean = 0.0;
  double deviation = 0.0;  ///< of the ground here, class and place together
  double learned = 0.0;    ///< deviation that the evidence explains; 0 where none is near
};

/// What a fair reader may believe of the ground after the journal, by plain formulas.
///
/// A reading. A steady rover on a gradient g pulls g of its load; the curve of the class says what it would
/// pull at the slip that it has. What all wheels of a moment miss together, sum N (g - DP_class(i)) / sum N,
/// is the departure of the ground under them; how they share it follows from torque and sinkage of each
/// (thesis Eq. 3.12: DP/W = -tan(t1/2) + [sin(t1/4)/(t1/4)]^2 / cos(t1/2) T/(rW)). Its deviation is that of
/// slope (0.01), slip (0.03 times the curve's slope), model (0.02), half of what the wheels differ, and of
/// carrying it from the slip to the reference slip. A wheel that spun without a gradient says what torque and
/// sinkage say (0.08). Rows that Talus refused count, too, when they speak for danger.
///
/// A place: the square of 1.25 m with all its readings, weighed by their deviations; its own is not below
/// 0.022, the model's error and that of ground inside a square, however many rows it has.
///
/// Ground: the Gaussian process over all places of a class, none left out: variance = class_deviation^2 +
/// place_deviation^2 rho(d) with rho Melkumyan and Ramos' sparse kernel of range 5 m, solved as one dense
/// system. Ground is believed stronger than its class only where three places of the class were driven.
class Belief {
 public:
  Belief(const Site& site, const std::vector<JournalRow>& rows);

  /// Of ground of a class at a place.
  Departure at(int class_number, Place p) const;
  /// How much deeper than its class's wheels sink there, by the square's own readings; 1 where it has none.
  double deeper(int class_number, Place p) const;
  /// Places with evidence of a class.
  std::size_t places(int class_number) const;

  /// Covariance of the departures at places of one class after the evidence, row-major.
  std::vector<double> covariance(int class_number, const std::vector<Place>& at) const;

  static constexpr double kRange_m = 5.0;
  static constexpr double kSquare_m = 1.25;

 private:
  struct Square {
    Place middle;
    double weight = 0.0, departure = 0.0;
    double depth_ratio = 0.0;
    int depths = 0;
  };
  struct Process {
    double class_variance = 0.0, place_variance = 0.0;
    std::vector<Square> squares;
    std::vector<double> factor;  // Cholesky, row-major
    std::vector<double> solved;  // K^-1 y
    std::vector<double> towards(Place p) const;
    std::vector<double> halfSolved(std::vector<double> k) const;
  };

  void moment(const Site& site, const std::vector<const JournalRow*>& rows);
  void put(int class_number, Place p, double departure, double deviation);
  Square& squareAt(int class_number, Place p);
  void solve(const Site& site);

  std::map<int, std::map<std::pair<int, int>, Square>> squares_;
  std::map<int, Process> processes_;
};

}  // namespace safety
