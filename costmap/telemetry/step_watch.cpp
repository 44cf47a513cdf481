#include <algorithm>
#include <cmath>

#include <talus/costmap/telemetry/step_watch.hpp>

namespace talus::costmap {
namespace {

constexpr std::size_t kOnEitherSide = 3;  // least number of places on either side
constexpr double kLeastScatter =
    0.2;  // least scatter of a place, relative to `least_`: the scatter of few places may be lower by chance
constexpr std::size_t kMostPlaces = 1000;  // greatest number of places

}  // namespace

void StepWatch::add(double value) {
  if (!std::isfinite(value)) return;
  sum_ += value;
  if (++count_ < kRows) return;
  places_.push_back(sum_ / static_cast<double>(kRows));
  sum_ = 0.0;
  count_ = 0;
  if (places_.size() > kMostPlaces) places_.erase(places_.begin());
  look();
}

void StepWatch::look() {
  step_ = 0.0;
  const std::size_t n = places_.size();
  if (n < 2 * kOnEitherSide) return;
  double all = 0.0, squares = 0.0;
  for (const double p : places_) {
    all += p;
    squares += p * p;
  }
  double before = 0.0, most = kCertain;
  for (std::size_t i = 0; i < n; ++i) {
    const double left = static_cast<double>(i), right = static_cast<double>(n - i);
    if (i >= kOnEitherSide && n - i >= kOnEitherSide) {
      const double after = all - before;
      const double within = std::max(squares - before * before / left - after * after / right, 0.0);
      const double scatter = std::max(std::sqrt(within / static_cast<double>(n - 2)), kLeastScatter * least_);
      const double difference = after / right - before / left;
      const double errors = std::abs(difference) / (scatter * std::sqrt(1.0 / left + 1.0 / right));
      if (errors > most && std::abs(difference) >= least_) {
        most = errors;
        step_ = difference;
      }
    }
    before += places_[i];
  }
}

}  // namespace talus::costmap
