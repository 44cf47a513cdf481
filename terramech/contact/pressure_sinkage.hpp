#pragma once

#include <talus/terramech/contact/soil.hpp>

/// Pressure-sinkage relation of Bekker: pressure under a plate or wheel at a given depth in the soil.
namespace talus::terramech {

/// Returns the pressure p = (k_c/b + k_phi) z^n [Pa] (Bekker, thesis Eq. A.1; bekker_1969) under a plate or
/// wheel whose smaller dimension is b = width_m > 0, at the depth z = depth_m >= 0.
double bekkerPressure_Pa(const Soil& soil, double width_m, double depth_m);

/// Returns the depth [m] at which Bekker's pressure equals pressure_Pa >= 0, for the smaller dimension b =
/// width_m. Throws std::domain_error if k_c/b + k_phi <= 0 and std::invalid_argument if pressure_Pa < 0.
double bekkerDepth_m(const Soil& soil, double width_m, double pressure_Pa);

}  // namespace talus::terramech
