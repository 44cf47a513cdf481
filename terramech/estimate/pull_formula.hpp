#pragma once

#include <string>
#include <vector>

#include <talus/terramech/estimate/drawbar_pull.hpp>

namespace talus::terramech {

/// Names of the formulas of drawbar_pull.hpp that give DP/W from readings: "single-force" (ours,
/// pullOverLoad()), "small-angle" (thesis Eq. 3.6), "triangular" (3.12), "plane" (3.21).
const std::vector<std::string>& pullFormulas();

/// DP/W [-] by the formula of that name. The standard deviation carries the readings' errors and the
/// formula's own rms error over thesis Table 2.1 (`talus reproduce --goals`). Throws std::invalid_argument for
/// another name, and as drawbar_pull.hpp.
Estimate pullOverLoadBy(const std::string& formula, const Wheel& wheel, const WheelSample& sample,
                        const ReadingErrors& errors);

}  // namespace talus::terramech
