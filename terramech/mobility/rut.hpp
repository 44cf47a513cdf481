#pragma once

#include <talus/terramech/contact/soil.hpp>

namespace talus::terramech {

/// How much stiffer soil is when it is loaded again by a driven wheel. On reloading by a plate it is some
/// tens of times stiffer than at first (wong_2001, response to repetitive loading), but a wheel that slips
/// goes on digging: the second one is known to meet about half the first one's resistance, which grows with
/// the root of the sinkage. Ours, number unverified [-].
inline constexpr double kReloadStiffness = 4.0;

/// By how much less displacement its shear strength is mobilised there: compacted soil has a smaller K
/// (senatore_sandu_2011 let it fall with density). Ours: as the contact shortens, sqrt(kReloadStiffness) [-].
inline constexpr double kReloadShear = 2.0;

/// The soil as a wheel meets it in the rut of an equal one: compacted, so that it sinks less and
/// pays less for compaction, and of the same strength (ours: what cohesion and friction gain is left out).
Soil rutted(const Soil& soil);

}  // namespace talus::terramech
