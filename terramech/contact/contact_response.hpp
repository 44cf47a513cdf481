#pragma once

#include <Eigen/Core>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// The Wong-Reece contact as an estimator wants it: forces of a driven wheel at a given sinkage and slip,
/// with their derivatives by soil, sinkage and slip in the same pass. No root is sought, nothing is checked
/// or thrown.
namespace talus::terramech {

/// The soil under one wheel: k = k_c/b + k_phi is all that one width can see.
struct ContactSoil {
  double cohesion_Pa = 0.0;
  double friction_angle_rad = 0.0;
  double sinkage_exponent = 1.0;
  double sinkage_modulus = 1e6;  ///< k [N/m^(n+2)]
  double shear_modulus_m = 0.02;
  double c1 = 0.43;
  double c2 = 0.32;
};

/// The same for a wheel of width_m [m].
ContactSoil contactSoil(const Soil& soil, double width_m);

/// Where a driven wheel stands: 0 < z < r, 0 <= i <= 1.
struct ContactState {
  double sinkage_m = 0.0;
  double slip = 0.0;
};

/// Rows of a response, columns of its derivative.
enum ContactRow { kLoad, kTorque, kPull };
enum ContactColumn { kCohesion, kFriction, kExponent, kModulus, kShear, kSinkage, kSlip, kContactColumns };

/// W [N], T [Nm], DP [N].
using ForceVector = Eigen::Vector3d;

/// d(W, T, DP) / d(c, phi, n, k, K, z, i), each in SI.
using ContactDerivative = Eigen::Matrix<double, 3, kContactColumns>;

/// Thesis C.8 to C.10 with theta_2 = 0, by Gauss-Legendre of 10 points a half in t, s = t^3: within 1e-4 of
/// the integral over Table 2.1 and n from 0.3 to 1.6, far below any sensor; rim_contact.hpp has the exact
/// one.
ForceVector contactForces(const ContactSoil& soil, const Wheel& wheel, const ContactState& state);

/// The forces, and their exact derivative (of the quadrature) in `derivative`.
ForceVector contactForces(const ContactSoil& soil, const Wheel& wheel, const ContactState& state,
                          ContactDerivative& derivative);

}  // namespace talus::terramech
