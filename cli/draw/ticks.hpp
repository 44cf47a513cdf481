#pragma once

#include <string>
#include <vector>

namespace talus::cli {

/// A closed interval of an axis, low < high.
struct Range {
  double low = 0.0;
  double high = 1.0;
};

/// Round marks of an axis: multiples of 1, 2 or 5 times a power of ten, about `count` of them inside the
/// range.
std::vector<double> ticks(Range range, int count);

/// The largest 1, 2 or 5 times a power of ten that is not above the value; value > 0.
double roundBelow(double value);

/// The number as a label of an axis with such a step: no more decimals than the step needs.
std::string tickLabel(double value, double step);

}  // namespace talus::cli
