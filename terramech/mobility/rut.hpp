#pragma once

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Returns the soil in the rut of an equal wheel: k_c and k_phi times Soil::rut_stiffness r, K over sqrt(r). When a plate
/// reloads soil, the soil is some tens of times stiffer (wong_2001, response to repetitive loading), but a slipping
/// wheel continues to dig: with r = 4 the resistance of a second wheel is about half that of the first, because
/// resistance increases with the square root of the sinkage. Compacted soil has a smaller K (in senatore_sandu_2011 K
/// falls with density). Cohesion and friction angle are unchanged (ours: their increase is neglected).
Soil rutted(const Soil& soil);
/// Returns the model in the rut of an equal wheel: unchanged if it has a multipass effect, which then describes
/// the second pass; otherwise on the soil in the rut.
RefinedModel rutted(const RefinedModel& model);

}  // namespace talus::terramech
