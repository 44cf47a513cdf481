#pragma once

/// Bulldozing resistance of the soil on the side face of a wheel that slides sideways.
namespace talus::terramech {

/// Resistance of a vertical blade that pushes soil of height h, per width of the blade [N/m]:
///   R = D1 (c h + D2 gamma h^2 / 2),  D1 = cot X + tan(X + phi),  D2 = cot X + cot^2 X tan phi,
///   X = 45 deg - phi/2
/// (hegedus_1960 with a vertical blade, as in ishigami_2007).
struct Hegedus {
  double per_depth_Pa = 0.0;            ///< D1 c
  double per_depth_squared_N_m3 = 0.0;  ///< D1 D2 gamma / 2

  double resistance_N_m(double depth_m) const {
    return depth_m * (per_depth_Pa + depth_m * per_depth_squared_N_m3);
  }
};

/// Strength and unit weight of the pushed soil in the local gravity.
struct PushedSoil {
  double cohesion_Pa = 0.0;   ///< c >= 0
  double tan_friction = 0.0;  ///< tan phi >= 0
  double weight_N_m3 = 0.0;   ///< gamma = density times gravity, >= 0
};

Hegedus hegedus(const PushedSoil& soil);

/// Side face of a wheel below the soil surface.
struct WheelFace {
  double radius_m = 0.1;         ///< > 0
  double entry_angle_rad = 0.0;  ///< theta_1 in [0, pi/2]
};

/// Returns the resistance of the face [N]: int R(h) dx over the chord of the face, x = r sin theta, h = r
/// (cos theta - cos theta_1), theta from -theta_1 to theta_1. Both halves of the face push undisturbed soil,
/// independent of the exit angle (ours; ishigami_2007 integrates over the rim's contact). Closed form:
///   D1 [c r^2 (theta_1 - S C) + D2 gamma r^3 (S - S^3/3 - theta_1 C)],  S, C = sin, cos theta_1.
double faceResistance_N(const Hegedus& soil, const WheelFace& face);

}  // namespace talus::terramech
