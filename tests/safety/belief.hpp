#pragma once

#include <map>
#include <vector>

#include "ground.hpp"
#include "journal.hpp"

namespace safety {

/// Estimated departure of the ground's DP/W from the mean of its class [-].
struct Departure {
  double mean = 0.0;
  double deviation = 0.0;  ///< standard deviation at the place: class and place effects together
  double learned = 0.0;    ///< standard deviation explained by the evidence; 0 without evidence nearby
};

/// Estimate of the ground after the journal, computed by plain formulas independent of Talus.
///
/// Reading: a steady rover on a gradient g needs a pull of g times its load. The class curve gives the pull
/// DP_class(i) at the observed slip. The common residual of all wheels of a moment, sum N (g - DP_class(i))
/// / sum N, is the departure of the ground under the wheels. Torque and sinkage of each wheel distribute the
/// departure over the wheels (thesis Eq. 3.12: DP/W = -tan(t1/2) + [sin(t1/4)/(t1/4)]^2 / cos(t1/2) T/(rW)).
/// The standard deviation of a reading combines slope (0.01), slip (0.03 times the slope of the curve),
/// model (0.02), half of the difference between the wheels, and the transfer from the observed slip to the
/// reference slip. For a wheel that spun without a known gradient, torque and sinkage alone give the
/// departure (standard deviation 0.08). Rows that Talus rejected count as well if they indicate danger.
///
/// Place: a square of 1.25 m with all its readings, weighted by their standard deviations. The standard
/// deviation of a place is at least 0.022 however many rows it has: model error and variation of the ground
/// inside a square.
///
/// Ground: the Gaussian process over all places of a class, without approximation: variance =
/// class_deviation^2 + place_deviation^2 rho(d), rho being Melkumyan and Ramos' sparse kernel of range 5 m,
/// solved as one dense system. The estimate exceeds the class mean only if at least three places of the
/// class were driven.
class Belief {
 public:
  Belief(const Site& site, const std::vector<JournalRow>& rows);

  /// Departure of ground of a class at a place.
  Departure at(int class_number, Place p) const;
  /// Ratio of observed sinkage to the sinkage of the class, from the readings of the square at p [-]; 1
  /// without readings.
  double deeper(int class_number, Place p) const;
  /// Number of places of a class with evidence.
  std::size_t places(int class_number) const;

  /// Posterior covariance of the departures at places of one class, row-major.
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
    std::vector<double> factor;  // Cholesky factor, row-major
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
