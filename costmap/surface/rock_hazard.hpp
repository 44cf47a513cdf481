#pragma once

namespace talus::costmap {

/// A rover among rocks: which ones stop it, and how much ground it covers at once.
struct RockCrossing {
  double diameter_m = 0.0;  ///< smallest rock that it cannot drive over, > 0
  double area_m2 = 0.0;     ///< of the ground it stands on, > 0
};

/// Probability that at least one rock at least `diameter_m` wide lies on `area_m2` where rocks cover the
/// share `abundance` (0 to 1) of the ground; 0 for an abundance that is NaN or not positive.
///   F(D) = k e^(-q D),  q = 1.79 + 0.152/k                 share covered by rocks wider than D
///                                                          (golombek_rapp_1997)
///   N(D) = integral over D' > D of (-dF/dD') 4/(pi D'^2)   rocks a square metre
///        = 4 k q/pi [e^(-q D)/D - q E1(q D)]
///   P = 1 - e^(-N A)                                       rocks thrown at random
/// 1 where rocks cover more than half of the ground: the distribution, of counted fields, has ever fewer great rocks there
/// than the ground has room for (ours). Rocks wider than 2.5 m are not counted apart. Relative accuracy 1e-6 in N.
double rockHazard(double abundance, const RockCrossing& crossing);

}  // namespace talus::costmap
