#pragma once

#include <talus/terramech/contact/soil.hpp>

/// Shear stress of a soil under a plate or a rim.
namespace talus::terramech {

/// Mohr-Coulomb strength (thesis A.2): tau_max = c + sigma tan phi [Pa] at normal stress sigma [Pa] >= 0.
double shearStrength_Pa(const Soil& soil, double normal_Pa);

/// Janosi and Hanamoto (thesis A.4; janosi_hanamoto_1961): tau = tau_max (1 - e^{-|j|/K}) [Pa], signed as the
/// shear displacement j [m].
double janosiHanamoto_Pa(const Soil& soil, double normal_Pa, double displacement_m);

/// Idealised elasto-plastic law (thesis A.3, whose "strain" is the shear displacement): tau = tau_max
/// min(|j|/K, 1) [Pa], signed as j.
double elastoPlastic_Pa(const Soil& soil, double normal_Pa, double displacement_m);

}  // namespace talus::terramech
