#pragma once

#include <string>
#include <vector>

namespace talus::cli {

/// A closed interval, low < high.
struct Range {
  double low = 0.0;
  double high = 1.0;
};

/// Returns round tick values inside the range: about `count` multiples of 1, 2 or 5 times a power of ten.
std::vector<double> ticks(Range range, int count);

/// Returns the greatest number of the form 1, 2 or 5 times a power of ten that does not exceed `value` > 0.
double roundBelow(double value);

/// Returns a number as a tick label, with no more decimals than the step between ticks needs.
std::string tickLabel(double value, double step);

}  // namespace talus::cli
