#pragma once

namespace talus::costmap {

/// Rock size that a rover cannot cross, and the area that must be free of such rocks.
struct RockCrossing {
  double diameter_m = 0.0;  ///< diameter of the smallest rock that the rover cannot cross, > 0
  double area_m2 = 0.0;     ///< area of the rover's footprint, > 0
};

/// Returns the probability P that at least one rock of diameter >= D = crossing.diameter_m lies on the area A
/// = crossing.area_m2, where rocks cover the fraction `abundance` = k (0 to 1) of the ground. Returns 0 for
/// an abundance that is NaN or not positive.
///   F(D) = k e^(-q D),  q = 1.79 + 0.152/k                 area fraction of rocks larger than D
///                                                          (golombek_rapp_1997)
///   N(D) = integral over D' > D of (-dF/dD') 4/(pi D'^2)   rocks per square metre
///        = 4 k q/pi [e^(-q D)/D - q E1(q D)]
///   P = 1 - e^(-N A)                                       Poisson distribution
/// Returns 1 for an abundance above 0.5: the distribution, which was fitted to counted fields, then
/// underestimates the number of large rocks (ours). The relative accuracy of N is 1e-6.
double rockHazard(double abundance, const RockCrossing& crossing);

}  // namespace talus::costmap
