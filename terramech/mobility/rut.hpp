#pragma once

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Stiffness of a soil that a driven wheel loads for the second time, relative to the first loading [-]
/// (ours, number unverified). When a plate reloads soil, the soil is some tens of times stiffer (wong_2001,
/// response to repetitive loading), but a slipping wheel continues to dig. The value is
/// chosen because the resistance of a second wheel is about half that of the first, and the resistance
/// increases with the square root of the sinkage.
inline constexpr double kReloadStiffness = 4.0;

/// Divisor of the shear modulus K of soil that a wheel loads for the second time [-]. Compacted soil has a
/// smaller K (in senatore_sandu_2011 K falls with density). The value sqrt(kReloadStiffness) is ours,
/// because the contact is shorter.
inline constexpr double kReloadShear = 2.0;

/// Returns the soil in the rut of an equal wheel. Its sinkage moduli are larger and its K is smaller, so that
/// sinkage and compaction resistance are smaller. Cohesion and friction angle are unchanged (ours: their
/// increase is neglected).
Soil rutted(const Soil& soil);
/// Returns the model in the rut of an equal wheel: unchanged if it has a multipass effect, which then describes
/// the second pass; otherwise on the soil in the rut.
RefinedModel rutted(const RefinedModel& model);

}  // namespace talus::terramech
