#pragma once

#include <nlohmann/json_fwd.hpp>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// What cli/page/rose.js prices headings by: the cost curves that the cells refer to, at their nodes within the limits of
/// pitch and roll, and an image each of the cells' gradients and of their curves and categories; null without costs.
nlohmann::ordered_json headingCostsOf(const Scene& scene);

}  // namespace talus::cli
