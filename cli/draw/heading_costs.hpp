#pragma once

#include <nlohmann/json_fwd.hpp>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// Returns the data from which cli/page/rose.js computes the cost by heading: the cost curves used by the
/// cells, at nodes within the limits of pitch and roll, an image of the gradients of the cells, and an image
/// of their curve indices and categories. Returns null if the scene has no costs.
nlohmann::ordered_json headingCostsOf(const Scene& scene);

}  // namespace talus::cli
