#pragma once

#include <limits>
#include <vector>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// Contact of one wheel with all quantities that an effect may change, integrated by rim_contact.hpp with a
/// faster rule. Without effects the results equal those of wong_reece.hpp to 1e-6 of the load.
namespace talus::terramech {

/// Parameters of the contact of one wheel, after all effects. Plain data, SI.
struct WheelContact {
  double load_N = 0.0;          ///< vertical load > 0
  double slip = 0.0;            ///< along the wheel plane, [-1, 1], defined in shear_displacement.hpp
  double slip_angle_rad = 0.0;  ///< beta, from the wheel plane to the travel direction; 0: no side force
  double rolling = 1.0;         ///< r omega / v with the full speed v [-], 0 locked; input of effects only

  double radius_m = 0.1;        ///< radius of the contact arc, > 0
  double width_m = 0.1;         ///< b > 0
  double shear_radius_m = 0.1;  ///< r_s of shear displacement and torque; r for a smooth wheel

  double sinkage_modulus = 0.0;   ///< k = k_c/b + k_phi [N/m^(n+2)]
  double sinkage_exponent = 1.0;  ///< n [-]
  double cohesion_Pa = 0.0;       ///< c
  double tan_friction = 0.0;      ///< tan phi
  double shear_modulus_m = 0.02;  ///< K
  double density_kg_m3 = 1600.0;  ///< for forces that move soil
  double gravity_m_s2 = 9.80665;  ///< for forces that move soil
  /// Slip sinkage, and digging and side bulldozing at a slip angle, see Soil; an effect with another law sets
  /// the value to 0.
  double slip_sinkage_exponent = 0.0;
  double digging_exponent = 0.0;
  double side_bulldozing = 0.0;
  double c1 = 0.43;  ///< theta_m = (c1 + c2 i) theta_1
  double c2 = 0.32;

  double rebound = 0.0;  ///< kappa [-]: contact ends at theta_2 = -acos(1 - kappa z/r)
  /// H: below this depth h the pressure increases by hard_modulus_Pa_m (h - H).
  double hard_depth_m = std::numeric_limits<double>::infinity();
  double hard_modulus_Pa_m = 0.0;  ///< k_h of the lower layer
  // Digging: z = z0 + hypot(dug, ploughed_m) + extra_sinkage_m <= 1.95 r, dug = (sinkage_gain - 1) z0 +
  // dug_m, with z0 the static sinkage. The stress at the larger depth is scaled to carry the load.
  double sinkage_gain = 1.0;
  double dug_m = 0.0;            ///< along the wheel plane, by lugs
  double ploughed_m = 0.0;       ///< across the wheel plane
  double extra_sinkage_m = 0.0;  ///< by other causes
  /// Share of `dug` that refills behind the wheel: contact ends at theta_2 for the depth kappa z + rear_fill
  /// dug.
  double rear_fill = 0.0;

  bool operator==(const WheelContact&) const = default;
};

/// Sinkage and forces of a wheel, SI.
struct ContactForces {
  double sinkage_m = 0.0;
  double dug_m = 0.0;  ///< component of the sinkage that the driven wheel excavates
  double entry_angle_rad = 0.0;
  double static_entry_rad = 0.0;  ///< entry angle of the static sinkage; initial value of the next search
  double growth = 0.0;  ///< d log W / d log theta_1 at the result [-], for the next search; 0: unknown
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;
  double side_force_N = 0.0;  ///< opposite to the sideways motion: negative for slip_angle_rad > 0
};

/// Returns the contact of a smooth rigid wheel without effects. Wheel::lug_thrust is ignored; lugs act
/// through effects.
WheelContact contactOf(const Soil& soil, const Wheel& wheel);

/// Returns the forces on the wheel at the sinkage that carries its load. `entry_guess_rad` and `growth` are
/// initial values of the search, from the ContactForces of a similar contact; 0: default. Digging and side
/// bulldozing at a slip angle are those of wong_reece.hpp. If the soil cannot carry the load with the axle at
/// the surface, the result is the wheel sunk to its axle, with the stress scaled to carry the load, because
/// fits evaluate such soils. The entry angle is at most pi/2 at any sinkage. Never throws. Thread-safe.
/// Integrals: rimForces();
///   tau = (c + sigma tan phi)(1 - e^{-j/K}) along the resultant displacement j = hypot(j_x, j_y),
/// the friction circle of an isotropic soil (ishigami_2007).
ContactForces solveContact(const WheelContact& contact, double entry_guess_rad = 0.0, double growth = 0.0);

/// Contacts and their forces in the same order: a cache for repeated solutions of similar contacts.
struct SolvedContacts {
  std::vector<WheelContact> contacts;
  std::vector<ContactForces> forces;  ///< one per contact
};

/// Solves `contacts` and stores them in `solved`. An unchanged contact keeps its forces; for a changed one
/// the old forces are the initial values. Contacts without effects on the plain Wong-Reece wheel are solved
/// in batches by wong_reece_batch.hpp, the others by solveContact().
void solveContacts(std::vector<WheelContact> contacts, SolvedContacts& solved);

}  // namespace talus::terramech
