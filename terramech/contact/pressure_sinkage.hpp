#pragma once

#include <talus/terramech/contact/soil.hpp>

/// Pressure-sinkage relations of Bekker and of Reece.
namespace talus::terramech {

/// Returns the pressure p = (k_c/b + k_phi) z^n [Pa] (Bekker, thesis Eq. A.1; bekker_1969) under a plate or
/// wheel of smaller dimension b = width_m > 0 at depth z >= 0 [m].
double bekkerPressure_Pa(const Soil& soil, double width_m, double depth_m);

/// Returns the depth [m] at which Bekker's pressure equals pressure_Pa >= 0. Throws std::domain_error if
/// k_c/b + k_phi <= 0, std::invalid_argument if pressure_Pa < 0.
double bekkerDepth_m(const Soil& soil, double width_m, double pressure_Pa);

/// Soil in Reece's pressure-sinkage relation, whose dimensionless moduli are intended not to depend on plate
/// size.
struct ReeceSoil {
  double cohesion_Pa = 0.0;        ///< c >= 0
  double weight_N_m3 = 0.0;        ///< unit weight gamma in the local gravity, >= 0
  double cohesive_factor = 0.0;    ///< k'_c [-]
  double frictional_factor = 0.0;  ///< k'_phi [-]
  double sinkage_exponent = 1.0;   ///< n > 0 [-]
};

/// Returns the pressure p = (c k'_c + gamma b k'_phi) (z/b)^n [Pa] (reece_1965).
double reecePressure_Pa(const ReeceSoil& soil, double width_m, double depth_m);

/// Returns the depth [m] at which Reece's pressure equals pressure_Pa >= 0. Throws std::domain_error if c
/// k'_c + gamma b k'_phi <= 0, std::invalid_argument if pressure_Pa < 0.
double reeceDepth_m(const ReeceSoil& soil, double width_m, double pressure_Pa);

/// Returns the Bekker soil with the same pressures under a plate or wheel of this width, k = (c k'_c + gamma
/// b k'_phi) / b^n, so that a Reece soil can be used with wong_reece.hpp. The remaining fields are copied
/// from `rest`.
Soil bekkerOf(const ReeceSoil& soil, double width_m, const Soil& rest);

}  // namespace talus::terramech
