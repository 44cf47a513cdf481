#pragma once

/// Bulldozing resistance of the soil against the side face of a wheel that slides sideways.
namespace talus::terramech {

/// Resistance of the soil to a vertical blade at the depth h below the surface, per width of the blade [N/m]:
///   R = D1 (c h + D2 gamma h^2 / 2),  D1 = cot X + tan(X + phi),  D2 = cot X + cot^2 X tan phi,
///   X = 45 deg - phi/2
/// (hegedus_1960 for a vertical blade, used by ishigami_2007 for wheels). c, phi and gamma are cohesion,
/// friction angle and unit weight of the soil.
struct Hegedus {
  double per_depth_Pa = 0.0;            ///< coefficient D1 c of h
  double per_depth_squared_N_m3 = 0.0;  ///< coefficient D1 D2 gamma / 2 of h^2

  /// Returns R [N/m] at the blade depth h = depth_m.
  double resistance_N_m(double depth_m) const {
    return depth_m * (per_depth_Pa + depth_m * per_depth_squared_N_m3);
  }
};

/// Strength and unit weight of the soil that the blade pushes aside, in the local gravity.
struct PushedSoil {
  double cohesion_Pa = 0.0;   ///< cohesion c >= 0
  double tan_friction = 0.0;  ///< tangent of the friction angle, tan phi >= 0 [-]
  double weight_N_m3 = 0.0;   ///< unit weight gamma = density times gravity, >= 0
};

/// Returns the coefficients of the blade resistance in a soil.
Hegedus hegedus(const PushedSoil& soil);

/// Part of the side face of a wheel that is below the soil surface.
struct WheelFace {
  double radius_m = 0.1;         ///< wheel radius r > 0
  double entry_angle_rad = 0.0;  ///< entry angle theta_1 in [0, pi/2]
};

/// Returns the resistance of the soil to the side face of a wheel [N]: the integral of the blade resistance
/// R(h) over the chord of the face, int R(h) dx with x = r sin theta, h = r (cos theta - cos theta_1) and
/// theta from -theta_1 to theta_1. Both halves of the face push undisturbed soil, independent of the exit
/// angle of the contact (ours; ishigami_2007 integrates only over the contact of the rim). The closed form is
///   D1 [c r^2 (theta_1 - S C) + D2 gamma r^3 (S - S^3/3 - theta_1 C)],  S, C = sin, cos theta_1.
double faceResistance_N(const Hegedus& soil, const WheelFace& face);

}  // namespace talus::terramech
