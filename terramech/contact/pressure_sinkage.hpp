#pragma once

#include <talus/terramech/contact/soil.hpp>

/// Pressure-sinkage relations of Bekker and of Reece: pressure under a plate or wheel at a given depth in the
/// soil.
namespace talus::terramech {

/// Returns the pressure p = (k_c/b + k_phi) z^n [Pa] (Bekker, thesis Eq. A.1; bekker_1969) under a plate or
/// wheel whose smaller dimension is b = width_m > 0, at the depth z = depth_m >= 0.
double bekkerPressure_Pa(const Soil& soil, double width_m, double depth_m);

/// Returns the depth [m] at which Bekker's pressure equals pressure_Pa >= 0, for the smaller dimension b =
/// width_m. Throws std::domain_error if k_c/b + k_phi <= 0 and std::invalid_argument if pressure_Pa < 0.
double bekkerDepth_m(const Soil& soil, double width_m, double pressure_Pa);

/// Soil parameters of Reece's pressure-sinkage relation. Its dimensionless moduli are intended to be
/// independent of the plate size.
struct ReeceSoil {
  double cohesion_Pa = 0.0;        ///< cohesion c >= 0
  double weight_N_m3 = 0.0;        ///< unit weight gamma of the soil in the local gravity, >= 0
  double cohesive_factor = 0.0;    ///< cohesive modulus k'_c [-]
  double frictional_factor = 0.0;  ///< frictional modulus k'_phi [-]
  double sinkage_exponent = 1.0;   ///< sinkage exponent n > 0 [-]
};

/// Returns the pressure p = (c k'_c + gamma b k'_phi) (z/b)^n [Pa] (reece_1965) under a plate or wheel of
/// smaller dimension b = width_m at the depth z = depth_m.
double reecePressure_Pa(const ReeceSoil& soil, double width_m, double depth_m);

/// Returns the depth [m] at which Reece's pressure equals pressure_Pa >= 0. Throws std::domain_error if c
/// k'_c + gamma b k'_phi <= 0 and std::invalid_argument if pressure_Pa < 0.
double reeceDepth_m(const ReeceSoil& soil, double width_m, double pressure_Pa);

/// Returns the soil whose Bekker pressures under a plate or wheel of width b = width_m equal those of the
/// Reece soil: k = (c k'_c + gamma b k'_phi) / b^n. With this soil, wong_reece.hpp can use a Reece soil. All
/// fields other than the pressure-sinkage parameters are copied from `rest`.
Soil bekkerOf(const ReeceSoil& soil, double width_m, const Soil& rest);

}  // namespace talus::terramech
