#pragma once

namespace talus::costmap {

/// Rock limits of a rover.
struct RockCrossing {
  double diameter_m = 0.0;  ///< smallest rock that the rover cannot cross, > 0
  double area_m2 = 0.0;     ///< area of the rover's footprint, > 0
};

/// Probability that at least one rock of diameter >= diameter_m lies on an area area_m2, where rocks cover
/// the fraction `abundance` = k (0 to 1) of the ground. 0 for an abundance that is NaN or not positive.
///   F(D) = k e^(-q D),  q = 1.79 + 0.152/k                 area fraction of rocks larger than D
///                                                          (golombek_rapp_1997)
///   N(D) = integral over D' > D of (-dF/dD') 4/(pi D'^2)   rocks per square metre
///        = 4 k q/pi [e^(-q D)/D - q E1(q D)]
///   P = 1 - e^(-N A)                                       Poisson distribution
/// Returns 1 for an abundance above 0.5, for which the distribution, fitted to counted fields, underestimates
/// the number of large rocks (ours). Relative accuracy 1e-6 in N.
double rockHazard(double abundance, const RockCrossing& crossing);

}  // namespace talus::costmap
