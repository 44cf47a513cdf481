#pragma once

#include <talus/terramech/contact/soil.hpp>

/// How far a plate sinks under a pressure.
namespace talus::terramech {

/// Bekker (thesis A.1; bekker_1969): p = (k_c/b + k_phi) z^n [Pa] for a plate or wheel of smaller dimension
/// width_m > 0 at depth z [m] >= 0.
double bekkerPressure_Pa(const Soil& soil, double width_m, double depth_m);

/// Its inverse: the depth [m] that carries a pressure [Pa] >= 0. Throws std::domain_error when k_c/b + k_phi
/// <= 0.
double bekkerDepth_m(const Soil& soil, double width_m, double pressure_Pa);

/// Dimensionless pressure-sinkage of Reece, for soils whose moduli should not change with the plate's size.
struct ReeceSoil {
  double cohesion_Pa = 0.0;        ///< c >= 0
  double weight_N_m3 = 0.0;        ///< gamma, unit weight in the gravity where it lies, >= 0
  double cohesive_factor = 0.0;    ///< k'_c [-]
  double frictional_factor = 0.0;  ///< k'_phi [-]
  double sinkage_exponent = 1.0;   ///< n > 0 [-]
};

/// Reece (reece_1965): p = (c k'_c + gamma b k'_phi) (z/b)^n [Pa].
double reecePressure_Pa(const ReeceSoil& soil, double width_m, double depth_m);

/// Its inverse: the depth [m] that carries a pressure [Pa] >= 0. Throws std::domain_error when the factor is
/// not above 0.
double reeceDepth_m(const ReeceSoil& soil, double width_m, double pressure_Pa);

/// The Bekker soil with the same pressures under a plate or wheel of this width: k = (c k'_c + gamma b
/// k'_phi) / b^n, everything else as in `rest`. How a Reece soil enters wong_reece.hpp.
Soil bekkerOf(const ReeceSoil& soil, double width_m, const Soil& rest);

}  // namespace talus::terramech
