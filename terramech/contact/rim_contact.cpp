#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <talus/terramech/contact/rim_contact.hpp>

namespace talus::terramech::detail {

Breaks breaksAt(double zero, const Halves& h) {
  if (!(zero == zero)) return {};
  const bool in_front = zero > h.peak_rad;
  return {{0.0,
           in_front ? (h.entry_rad - zero) / (h.entry_rad - h.peak_rad)
                    : (zero - h.exit_rad) / (h.peak_rad - h.exit_rad),
           1.0},
          3};
}

void throwSunk(double load_N) {
  throw std::domain_error("the wheel sinks to its axle before the soil carries " + std::to_string(load_N) +
                          " N");
}

namespace {

constexpr double kDeepest = 0.5 * std::numbers::pi;
constexpr double kRounding = 4e-16;

}  // namespace

EntrySearch::EntrySearch(const RimLoad& wanted)
    : wanted_N_(wanted.load_N),
      entry_(std::clamp(wanted.first_guess, 1e-9, kDeepest)),
      growth_(wanted.growth),
      tolerance_(wanted.tolerance) {}

EntrySearch::Status EntrySearch::take(double load_N) {
  const bool carries = load_N >= wanted_N_;
  (carries ? high_ : low_) = entry_;
  const double log_ratio = load_N > 0.0 ? std::log(load_N / wanted_N_) : -50.0;
  if (std::abs(log_ratio) < tolerance_ || (high_ > 0.0 && high_ - low_ <= kRounding * high_))
    return Status::Found;
  if ((!carries && entry_ >= kDeepest) || ++trials_ > 200) return Status::Sunk;
  learnGrowth(log_ratio);
  const double step_to = std::min(next(log_ratio), kDeepest);
  if (std::abs(step_to - entry_) <= kRounding * entry_) return Status::Found;
  entry_ = step_to;
  return Status::Searching;
}

void EntrySearch::learnGrowth(double log_ratio) {
  const double log_entry = std::log(entry_), run = log_entry - last_log_entry_;
  const double slope = (log_ratio - last_log_ratio_) / run;
  if (trials_ > 1 && run != 0.0 && slope > 0.05 && slope < 50.0) growth_ = slope;
  last_log_entry_ = log_entry;
  last_log_ratio_ = log_ratio;
}

double EntrySearch::next(double log_ratio) const {
  const double secant = entry_ * std::exp(std::clamp(-log_ratio / growth_, -3.0, 1.0));
  const bool inside = secant > low_ && (high_ == 0.0 || secant < high_);
  if (inside) return secant;
  return high_ > 0.0 ? 0.5 * (low_ + high_) : 1.5 * entry_;
}

}  // namespace talus::terramech::detail
