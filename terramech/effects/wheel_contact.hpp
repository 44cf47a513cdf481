#pragma once

#include <limits>
#include <vector>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// Contact of one wheel with all quantities that an effect may change, and the solution of this contact. The
/// forces are integrated as in rim_contact.hpp with a faster quadrature rule. Without effects the results
/// equal those of wong_reece.hpp within 1e-6 of the load.
namespace talus::terramech {

/// Parameters of the wheel-soil contact after all effects (corrections to Wong-Reece) have changed them.
/// Plain data in SI units.
struct WheelContact {
  double load_N = 0.0;  ///< vertical load > 0
  double slip = 0.0;    ///< slip along the wheel plane, [-1, 1], defined in shear_displacement.hpp
  /// Slip angle beta from the wheel plane to the travel direction; 0: no side force.
  double slip_angle_rad = 0.0;
  double rolling = 1.0;  ///< r omega / v with the full travel speed v [-], 0 if locked; used only by effects

  double radius_m = 0.1;        ///< radius r of the contact arc, > 0
  double width_m = 0.1;         ///< width b > 0
  double shear_radius_m = 0.1;  ///< radius r_s of shear displacement and torque; r for a smooth wheel

  double sinkage_modulus = 0.0;   ///< sinkage modulus k = k_c/b + k_phi [N/m^(n+2)]
  double sinkage_exponent = 1.0;  ///< sinkage exponent n [-]
  double cohesion_Pa = 0.0;       ///< cohesion c
  double tan_friction = 0.0;      ///< tangent of the friction angle, tan phi [-]
  double shear_modulus_m = 0.02;  ///< shear deformation modulus K
  double density_kg_m3 = 1600.0;  ///< bulk density, for forces that move soil
  double gravity_m_s2 = 9.80665;  ///< gravity, for forces that move soil
  /// Parameters of slip sinkage, and of digging and side bulldozing at a slip angle, defined in Soil. An
  /// effect that replaces one of these laws sets its parameter to 0.
  double slip_sinkage_exponent = 0.0;
  double digging_exponent = 0.0;
  double side_bulldozing = 0.0;
  double c1 = 0.43;  ///< angle of the stress peak: theta_m = (c1 + c2 i) theta_1
  double c2 = 0.32;

  double rebound = 0.0;  ///< rebound kappa [-]: contact ends at theta_2 = -acos(1 - kappa z/r)
  /// Depth H of a harder lower layer: at a depth h > H the pressure increases by hard_modulus_Pa_m (h - H).
  double hard_depth_m = std::numeric_limits<double>::infinity();
  double hard_modulus_Pa_m = 0.0;  ///< modulus k_h of the lower layer
  // Digging increases the static sinkage z0 to z = z0 + hypot(dug, ploughed_m) + extra_sinkage_m <= 1.95 r,
  // with dug = (sinkage_gain - 1) z0 + dug_m. The stress at the larger depth is scaled so that it carries the
  // load.
  double sinkage_gain = 1.0;     ///< factor on the static sinkage z0 [-]
  double dug_m = 0.0;            ///< sinkage that lugs excavate along the wheel plane
  double ploughed_m = 0.0;       ///< sinkage that the wheel excavates across the wheel plane
  double extra_sinkage_m = 0.0;  ///< sinkage by other causes
  /// Share of `dug` that refills behind the wheel [-]: the contact ends at the angle theta_2 of the depth
  /// kappa z + rear_fill dug.
  double rear_fill = 0.0;

  bool operator==(const WheelContact&) const = default;
};

/// Sinkage and forces of a wheel, in SI units.
struct ContactForces {
  double sinkage_m = 0.0;         ///< sinkage z
  double dug_m = 0.0;             ///< part of the sinkage that the driven wheel excavates
  double entry_angle_rad = 0.0;   ///< entry angle theta_1 of the contact
  double static_entry_rad = 0.0;  ///< entry angle at the static sinkage; initial value of the next search
  double growth = 0.0;  ///< d log W / d log theta_1 at the result [-], for the next search; 0: unknown
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;
  /// Force across the wheel plane, opposite to the sideways motion: negative for slip_angle_rad > 0.
  double side_force_N = 0.0;
};

/// Returns the contact parameters of a smooth rigid wheel on a soil, without effects. Wheel::lug_thrust is
/// ignored, because effects represent the lugs.
WheelContact contactOf(const Soil& soil, const Wheel& wheel);

/// Returns the forces on a wheel at the sinkage at which the soil carries its load. `entry_guess_rad` and
/// `growth` are initial values of the search, from the ContactForces of a similar contact; 0 selects a
/// default. Digging and side bulldozing at a slip angle are those of wong_reece.hpp. If the soil carries less
/// than the load with the axle at the surface, the result is the wheel sunk to its axle, with the stress
/// scaled to carry the load, because fits evaluate such soils. The entry angle is at most pi/2 at any
/// sinkage. Never throws. Thread-safe. The forces are the integrals of rimForces() with the shear stress
///   tau = (c + sigma tan phi)(1 - e^{-j/K}) along the resultant displacement j = hypot(j_x, j_y),
/// which corresponds to the friction circle of an isotropic soil (ishigami_2007).
ContactForces solveContact(const WheelContact& contact, double entry_guess_rad = 0.0, double growth = 0.0);

/// Cache of solved contacts, for repeated solutions of similar contacts.
struct SolvedContacts {
  std::vector<WheelContact> contacts;  ///< contact parameters
  std::vector<ContactForces> forces;   ///< forces of each contact, in the order of `contacts`
};

/// Solves `contacts` and stores contacts and forces in `solved`. A contact equal to the stored contact of the
/// same index keeps its forces; for a changed contact the stored forces are the initial values of the search.
/// Contacts without effects are solved in batches by wong_reece_batch.hpp, other contacts by solveContact().
void solveContacts(std::vector<WheelContact> contacts, SolvedContacts& solved);

}  // namespace talus::terramech
