#pragma once

#include <string>
#include <vector>

namespace talus::cli {

/// A closed interval, low < high.
struct Range {
  double low = 0.0;
  double high = 1.0;
};

/// Round tick values inside the range: multiples of 1, 2 or 5 times a power of ten, about `count` values.
std::vector<double> ticks(Range range, int count);

/// Returns the largest 1, 2 or 5 times a power of ten that does not exceed the value; value > 0.
double roundBelow(double value);

/// The number as a tick label, with no more decimals than the step needs.
std::string tickLabel(double value, double step);

}  // namespace talus::cli
