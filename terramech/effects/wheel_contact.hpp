#pragma once

#include <limits>
#include <vector>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>

/// One wheel on soil with everything that an effect may change, integrated by rim_contact.hpp with a quicker
/// rule: the Wong-Reece wheel of wong_reece.hpp when nothing is changed, and then equal to it to 1e-6 of the
/// load.
namespace talus::terramech {

/// What the contact of one wheel is solved from. SI; every field is already what acts, effects included.
struct WheelContact {
  double load_N = 0.0;          ///< vertical load > 0
  double slip = 0.0;            ///< along the wheel plane, [-1, 1]; see shear_displacement.hpp
  double slip_angle_rad = 0.0;  ///< beta, between the wheel plane and the travel; 0: no side force
  double rolling = 1.0;  ///< r omega over the full speed of travel [-]: 0 locked; for effects, not solved

  double radius_m = 0.1;        ///< of the contact circle, > 0
  double width_m = 0.1;         ///< b > 0
  double shear_radius_m = 0.1;  ///< r_s of shear displacement and torque, r for a smooth wheel

  double sinkage_modulus = 0.0;   ///< k = k_c/b + k_phi [N/m^(n+2)]
  double sinkage_exponent = 1.0;  ///< n [-]
  double cohesion_Pa = 0.0;       ///< c
  double tan_friction = 0.0;      ///< tan phi
  double shear_modulus_m = 0.02;  ///< K
  double density_kg_m3 = 1600.0;  ///< for forces that move soil
  double gravity_m_s2 = 9.80665;  ///< the same
  /// As Soil, of a wheel that slides sideways; an effect with a law of its own takes either out.
  double slip_sinkage_exponent = 0.0;
  double digging_exponent = 0.0;
  double side_bulldozing = 0.0;
  double c1 = 0.43;  ///< theta_m = (c1 + c2 i) theta_1
  double c2 = 0.32;

  double rebound = 0.0;  ///< kappa [-]: contact ends at theta_2 = -acos(1 - kappa z/r)
  /// H: below it pressure grows by hard_modulus.
  double hard_depth_m = std::numeric_limits<double>::infinity();
  double hard_modulus_Pa_m = 0.0;  ///< k_h of the lower layer
  // A wheel that digs: z = z0 + hypot(dug, ploughed_m) + extra_sinkage_m, dug = (gain - 1) z0 + dug_m, at
  // most 1.95 r, z0 being the static sinkage; the ground below then carries the load at a lower stress.
  double sinkage_gain = 1.0;
  double dug_m = 0.0;            ///< along the wheel plane, by lugs
  double ploughed_m = 0.0;       ///< across it
  double extra_sinkage_m = 0.0;  ///< other
  double rear_fill = 0.0;  ///< share of dug that lies behind: contact ends at theta_2 of kappa z + fill dug

  bool operator==(const WheelContact&) const = default;
};

/// What the soil does to the wheel.
struct ContactForces {
  double sinkage_m = 0.0;
  double dug_m = 0.0;  ///< of the sinkage, what the driven wheel threw behind itself
  double entry_angle_rad = 0.0;
  double static_entry_rad = 0.0;  ///< before an imposed sinkage: what starts the next search best
  double growth = 0.0;  ///< d log W / d log theta_1 there [-], 0: not known; the next search goes on by it
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;
  double side_force_N = 0.0;  ///< signed against the sideways motion: negative for slip_angle > 0
};

/// The contact of a smooth rigid wheel without effects: what lugs do, effects say, whatever Wheel::lug_thrust.
WheelContact contactOf(const Soil& soil, const Wheel& wheel);

/// Forces on the wheel at the sinkage that carries its load; `entry_guess_rad` and `growth`, ContactForces of a contact like
/// it, start the search, 0: none.
/// A wheel at a slip angle digs and pushes soil aside as in wong_reece.hpp. A load that the soil cannot carry
/// above the axle gives the wheel sunk to its axle, the stress scaled to carry it: fits pass through such
/// points, and none of them is a fit. Contact ends at the axle's height whatever the sinkage. Never throws.
/// Thread-safe. Integrals: rimForces();
///   tau = (c + sigma tan phi)(1 - e^{-j/K}) along the resultant displacement j = hypot(j_x, j_y),
/// which is the friction circle of an isotropic soil (ishigami_2007).
ContactForces solveContact(const WheelContact& contact, double entry_guess_rad = 0.0, double growth = 0.0);

/// Contacts in their order and what the soil does to each: the memory of who solves nearly the same ones
/// again and again.
struct SolvedContacts {
  std::vector<WheelContact> contacts;
  std::vector<ContactForces> forces;  ///< as many
};

/// Brings `solved` to `contacts`. One that stands there already keeps its forces, another in its place starts
/// the search. Those that no effect takes from the plain Wong-Reece wheel go through the kernel of
/// wong_reece_batch.hpp, four at a time, the others through solveContact().
void solveContacts(std::vector<WheelContact> contacts, SolvedContacts& solved);

}  // namespace talus::terramech
