#pragma once

#include <string>
#include <vector>

#include <talus/terramech/estimate/drawbar_pull.hpp>

namespace talus::terramech {

/// Returns the names of the formulas of drawbar_pull.hpp that compute drawbar pull over load DP/W from
/// readings: "single-force" (ours, pullOverLoad()), "small-angle" (thesis Eq. 3.6), "triangular" (Eq. 3.12),
/// "plane" (Eq. 3.21).
const std::vector<std::string>& pullFormulas();

/// Returns DP/W [-] of a sample by the named formula. The standard deviation includes the errors of the
/// readings and the rms error of the formula over thesis Table 2.1 (`talus reproduce --goals`). Throws
/// std::invalid_argument for an unknown name, and the exceptions of drawbar_pull.hpp.
Estimate pullOverLoadBy(const std::string& formula, const Wheel& wheel, const WheelSample& sample,
                        const ReadingErrors& errors);

}  // namespace talus::terramech
