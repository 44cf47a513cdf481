#pragma once

#include <Eigen/Core>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// Wong-Reece wheel-soil contact for estimators: the forces on a driven wheel at a given sinkage and slip,
/// and the derivatives of these forces with respect to soil parameters, sinkage and slip. The functions do
/// not search for the sinkage that carries a load, do not check their arguments and never throw.
namespace talus::terramech {

/// Soil parameters under one wheel of width b. Readings of a single wheel width determine only the sum k =
/// k_c/b + k_phi of the cohesive sinkage modulus k_c and the frictional sinkage modulus k_phi.
struct ContactSoil {
  double cohesion_Pa = 0.0;         ///< cohesion c
  double friction_angle_rad = 0.0;  ///< friction angle phi
  double sinkage_exponent = 1.0;    ///< sinkage exponent n [-]
  double sinkage_modulus = 1e6;     ///< sinkage modulus k [N/m^(n+2)]
  double shear_modulus_m = 0.02;    ///< shear deformation modulus K
  double c1 = 0.43;  ///< ratio theta_m / theta_1 of stress-peak angle to entry angle at slip 0 [-]
  double c2 = 0.32;  ///< increase of theta_m / theta_1 per unit slip [-]
};

/// Returns the Soil with the parameters of a ContactSoil: k_c = 0, k_phi = k.
Soil soilOf(const ContactSoil& contact);

/// Sinkage and slip of a driven wheel of radius r.
struct ContactState {
  double sinkage_m = 0.0;  ///< z, 0 < z < r
  double slip = 0.0;       ///< i, 0 <= i <= 1 [-]
};

/// Row index of ForceVector and ContactDerivative: load W, torque T, drawbar pull DP.
enum ContactRow { kLoad, kTorque, kPull };
/// Column index of ContactDerivative: c, phi, n, k, K, sinkage z, slip i. kContactColumns is their number.
enum ContactColumn { kCohesion, kFriction, kExponent, kModulus, kShear, kSinkage, kSlip, kContactColumns };

/// Load W [N], torque T [N m] and drawbar pull DP [N] of a wheel, indexed by ContactRow.
using ForceVector = Eigen::Vector3d;

/// Matrix of derivatives d(W, T, DP) / d(c, phi, n, k, K, z, i), in SI units.
using ContactDerivative = Eigen::Matrix<double, 3, kContactColumns>;

/// Returns the load W, torque T and drawbar pull DP of thesis Eqs. C.8 to C.10 with exit angle theta_2 = 0,
/// i.e. the contact ends below the axle. The stress peak divides the contact into two halves. Each half is
/// integrated by 10-point Gauss-Legendre quadrature in t = s^(1/3), where s is the fraction of the half. The
/// quadrature error is below 1e-4 over thesis Table 2.1 and n in [0.3, 1.6], less than any sensor error. A
/// more accurate quadrature is in rim_contact.hpp.
ForceVector contactForces(const ContactSoil& soil, const Wheel& wheel, const ContactState& state);

/// Returns the same forces and writes the exact derivative of the quadrature to `derivative`.
ForceVector contactForces(const ContactSoil& soil, const Wheel& wheel, const ContactState& state,
                          ContactDerivative& derivative);

}  // namespace talus::terramech
