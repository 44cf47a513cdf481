#include <algorithm>
#include <cmath>
#include <limits>

#include <talus/costmap/telemetry/response.hpp>

namespace talus::costmap {
namespace {

constexpr std::size_t kRecent = 24;
constexpr std::size_t kRemembered = 240;

}  // namespace

void Response::add(double cause, double effect) noexcept {
  if (!std::isfinite(cause) || !std::isfinite(effect)) return;
  ++count_;
  cause_ += cause;
  effect_ += effect;
  causes_ += cause * cause;
  effects_ += effect * effect;
  product_ += cause * effect;
}

double Response::causeVariance() const noexcept {
  const double n = static_cast<double>(count_);
  return std::max(causes_ / n - cause_ * cause_ / (n * n), 0.0);
}

terramech::Estimate Response::slope() const noexcept {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (count_ < kEnough) return {kNone, kNone};
  const double n = static_cast<double>(count_), cause = causeVariance();
  const double slope = (product_ / n - cause_ * effect_ / (n * n)) / cause;
  const double left = std::max(effects_ / n - effect_ * effect_ / (n * n) - slope * slope * cause, 0.0);
  return {slope, std::sqrt(left / ((n - 2.0) * cause))};
}

bool Response::follows(const Claim& claim) const noexcept {
  if (count_ < kEnough || causeVariance() < claim.variation * claim.variation) return false;
  const terramech::Estimate of = slope();
  return of.value >= claim.least + claim.certain * of.std - 1e-12;
}

double Response::meanDifference() const noexcept {
  return (effect_ - cause_) / static_cast<double>(count_);
}

void ResponseSeries::add(double cause, double effect) {
  if (!std::isfinite(cause) || !std::isfinite(effect)) return;
  whole_.add(cause, effect);
  last_.emplace_back(cause, effect);
  if (last_.size() > kRemembered) last_.pop_front();
}

Response ResponseSeries::recent(double variation) const {
  Response out;
  for (auto at = last_.rbegin(); at != last_.rend(); ++at) {
    out.add(at->first, at->second);
    if (out.size() >= kRecent && out.causeVariance() >= variation * variation) break;
  }
  return out;
}

}  // namespace talus::costmap
