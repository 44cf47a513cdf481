#pragma once

namespace safety {

/// Soil in SI units.
struct Soil {
  double cohesion_Pa = 0.0;
  double friction_angle_rad = 0.0;
  double sinkage_exponent = 1.0;
  double cohesive_modulus = 0.0;
  double frictional_modulus = 0.0;
  double shear_modulus_m = 0.02;
  double c1 = 0.43;
  double c2 = 0.32;
  double density_kg_m3 = 1600.0;
  double digging_exponent = 0.4;
  double side_bulldozing = 1.0;
};

/// A rigid wheel and its operating state.
struct LoadedWheel {
  double radius_m = 0.1;
  double width_m = 0.1;
  double load_N = 50.0;
  double slip = 0.0;            ///< driven 1 - v/(r omega) in [0, 1]; braked r omega/v - 1 in [-1, 0)
  double slip_angle_rad = 0.0;  ///< angle between the wheel plane and the direction of travel, [0, pi/3]
  double gravity_m_s2 = 9.80665;
};

/// Forces and sinkage of a wheel.
struct WheelAnswer {
  bool carried = false;  ///< false: the wheel sinks to its axle, and the forces are those at that sinkage
  double sinkage_m = 0.0;
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;  ///< along the wheel plane
  double side_force_N = 0.0;    ///< normal to the wheel plane, against the sliding
};

/// Wong and Reece's rigid wheel in the form of the thesis (kang_2003, App. C, contact from the axle
/// forward):
///   sigma = k r^n (cos t - cos t1)^n in front of t_m, the mirrored stress behind it, t_m = (c1 + c2 i) t1
///   tau = (c + sigma tan phi)(1 - e^(-j/K)), odd in j, j = r [t1 - t - (1 - i)(sin t1 - sin t)] driven,
///         j = r [t1 - t - (sin t1 - sin t)/(1 + i)] braked
///   W, DP, T = r b int (sigma cos t + tau sin t), r b int (tau cos t - sigma sin t), r^2 b int tau
/// At a slip angle (docs/slopes.md) tau points along the path of the rim over the soil, (j, r q tan(beta)
/// (t1 - t)) with q = v cos(beta)/(r omega); n grows by n_d (s_R - |i|), s_R = |(r omega - v cos beta, v sin
/// beta)|/max(r omega, v); the side force includes sin(beta) times Hegedus' D1 (c h + D2 gamma h^2/2) over
/// the chord below the surface. Finds t1 by false position on W and computes the integrals by adaptive
/// Simpson quadrature; simple rather than fast.
WheelAnswer drive(const Soil& soil, const LoadedWheel& wheel);

/// Soil in the rut of an equal wheel: four times the stiffness, half the shear displacement
/// (docs/simulation.md).
Soil inRut(Soil soil);

}  // namespace safety
