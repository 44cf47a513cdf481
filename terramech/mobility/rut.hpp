#pragma once

#include <talus/terramech/contact/soil.hpp>

namespace talus::terramech {

/// Stiffness of soil on reloading by a driven wheel, relative to the first loading [-] (ours, number
/// unverified). Reloaded by a plate, soil is some tens of times stiffer (wong_2001, response to repetitive
/// loading), but a slipping wheel continues to dig. The resistance of the second wheel is about half that of
/// the first; the resistance grows with the root of the sinkage.
inline constexpr double kReloadStiffness = 4.0;

/// Divisor of the shear modulus K on reloading [-]. Compacted soil has a smaller K (in senatore_sandu_2011 K
/// falls with density). Ours: sqrt(kReloadStiffness), as the contact shortens.
inline constexpr double kReloadShear = 2.0;

/// Returns the soil in the rut of an equal wheel: stiffer moduli and smaller K, so that sinkage and
/// compaction resistance are smaller. Cohesion and friction angle are unchanged (ours: their gain is
/// neglected).
Soil rutted(const Soil& soil);

}  // namespace talus::terramech
