#pragma once

#include <Eigen/Core>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// Wong-Reece contact for estimators: forces of a driven wheel at a given sinkage and slip, and their
/// derivatives by soil parameters, sinkage and slip. The functions solve no equilibrium, do not check their
/// arguments and never throw.
namespace talus::terramech {

/// Soil parameters under one wheel of width b. Readings of a single wheel width determine only the sum k =
/// k_c/b + k_phi of the sinkage moduli k_c (cohesive) and k_phi (frictional).
struct ContactSoil {
  double cohesion_Pa = 0.0;
  double friction_angle_rad = 0.0;
  double sinkage_exponent = 1.0;
  double sinkage_modulus = 1e6;  ///< k [N/m^(n+2)]
  double shear_modulus_m = 0.02;
  double c1 = 0.43;
  double c2 = 0.32;
};

/// Returns the parameters of `soil` under a wheel of width_m > 0 [m].
ContactSoil contactSoil(const Soil& soil, double width_m);

/// State of a driven wheel: sinkage 0 < z < r, slip 0 <= i <= 1.
struct ContactState {
  double sinkage_m = 0.0;
  double slip = 0.0;
};

/// ContactRow indexes the rows of ForceVector and ContactDerivative, ContactColumn the columns of
/// ContactDerivative.
enum ContactRow { kLoad, kTorque, kPull };
enum ContactColumn { kCohesion, kFriction, kExponent, kModulus, kShear, kSinkage, kSlip, kContactColumns };

/// Load W [N], torque T [N m], drawbar pull DP [N].
using ForceVector = Eigen::Vector3d;

/// d(W, T, DP) / d(c, phi, n, k, K, z, i), in SI units.
using ContactDerivative = Eigen::Matrix<double, 3, kContactColumns>;

/// Returns W, T, DP of thesis Eqs. C.8 to C.10 with theta_2 = 0 (contact ends below the axle). Each half of
/// the contact is integrated by 10-point Gauss-Legendre quadrature in t = s^(1/3), with s the fraction of the
/// half. The quadrature error is below 1e-4 over Table 2.1 and n in [0.3, 1.6], less than any sensor error;
/// rim_contact.hpp has the accurate quadrature.
ForceVector contactForces(const ContactSoil& soil, const Wheel& wheel, const ContactState& state);

/// Returns the forces as above and writes the exact derivative of the quadrature to `derivative`.
ForceVector contactForces(const ContactSoil& soil, const Wheel& wheel, const ContactState& state,
                          ContactDerivative& derivative);

}  // namespace talus::terramech
