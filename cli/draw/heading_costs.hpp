#pragma once

#include <nlohmann/json_fwd.hpp>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// Data from which cli/page/rose.js computes the cost per heading: the cost curves used by the cells, at
/// nodes within the limits of pitch and roll, an image of the cells' gradients, and an image of their curves
/// and categories. Null if the scene has no costs.
nlohmann::ordered_json headingCostsOf(const Scene& scene);

}  // namespace talus::cli
