#pragma once

#include <talus/terramech/contact/soil.hpp>

/// Shear strength and shear stress of a soil under a plate or a wheel rim.
namespace talus::terramech {

/// Returns the Mohr-Coulomb strength tau_max = c + sigma tan phi [Pa] (thesis Eq. A.2) at the normal stress
/// sigma = normal_Pa >= 0.
double shearStrength_Pa(const Soil& soil, double normal_Pa);

/// Returns the shear stress of Janosi and Hanamoto, tau = tau_max (1 - e^{-|j|/K}) [Pa] (thesis Eq. A.4;
/// janosi_hanamoto_1961), with the sign of the shear displacement j = displacement_m.
double janosiHanamoto_Pa(const Soil& soil, double normal_Pa, double displacement_m);

/// Returns the shear stress of the idealised elasto-plastic law, tau = tau_max min(|j|/K, 1) [Pa], with the
/// sign of the shear displacement j = displacement_m. The law is thesis Eq. A.3, where j is named strain.
double elastoPlastic_Pa(const Soil& soil, double normal_Pa, double displacement_m);

}  // namespace talus::terramech
