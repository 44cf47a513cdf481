#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <talus/costmap/evidence/class_lessons.hpp>
#include <talus/costmap/evidence/spreading.hpp>
#include <talus/costmap/ground/ground_kind.hpp>

namespace talus::costmap {
namespace {

constexpr double kUnit = 1048576.0;  // of the fixed-point sums

std::int64_t fixed(double value) {
  return static_cast<std::int64_t>(std::llround(value * kUnit));
}

constexpr double kPullStep = 0.005, kSinkageStep = 0.02;
constexpr double kSame = 1e-6;  // of a step: what has been rounded stays

double below(double value, double step) noexcept {
  return std::floor(value / step + kSame) * step;
}

double above(double value, double step) noexcept {
  return std::ceil(value / step - kSame) * step;
}

}  // namespace

void IndependentPlaces::set(const Square& square, std::optional<float> departure) {
  Colour& colour =
      colours_[(static_cast<unsigned>(square.first) & 1U) << 1 | (static_cast<unsigned>(square.second) & 1U)];
  const auto known = colour.known.find(square);
  if (known != colour.known.end()) {
    if (departure == known->second) return;
    colour.sorted.erase(colour.sorted.find(known->second));
    if (!departure) colour.known.erase(known);
  }
  if (!departure) return;
  colour.known[square] = *departure;
  colour.sorted.insert(*departure);
}

std::size_t IndependentPlaces::driven() const noexcept {
  std::size_t most = 0;
  for (const Colour& colour : colours_) most = std::max(most, colour.sorted.size());
  return most;
}

double IndependentPlaces::agreed(std::size_t places) const noexcept {
  double most = -std::numeric_limits<double>::infinity();
  for (const Colour& colour : colours_)
    if (colour.sorted.size() >= places)
      most = std::max(most, static_cast<double>(
                                *std::next(colour.sorted.rbegin(), static_cast<std::ptrdiff_t>(places) - 1)));
  return most;
}

void ClassLessons::sum(const BlockLesson& lesson, std::int64_t sign) {
  weight_ += sign * fixed(lesson.weight);
  pull_ += sign * fixed(lesson.weight * lesson.pull);
  if (lesson.raises) {
    raising_weight_ += sign * fixed(lesson.weight);
    raising_pull_ += sign * fixed(lesson.weight * lesson.pull);
    shared_ += sign * fixed(lesson.weight * lesson.shared);
    Told& told = by_drive_[lesson.drive];
    told.weight += sign * fixed(lesson.weight);
    told.pull += sign * fixed(lesson.weight * lesson.pull);
    if (told.weight == 0) by_drive_.erase(lesson.drive);
  }
  if (!lesson.sinkage) return;
  sinkage_weight_ += sign * fixed(lesson.weight);
  sinkage_ += sign * fixed(lesson.weight * *lesson.sinkage);
}

double ClassLessons::mostRise() const noexcept {
  return std::max(places_.agreed(kPlaces), 0.0);
}

ClassState ClassLessons::state() const noexcept {
  return {.pull = posterior_.pull.value,
          .pull_std = posterior_.pull.std,
          .own_std = posterior_.own_std,
          .shared = posterior_.shared,
          .sinkage = posterior_.sinkage.value,
          .may_raise = mayRaise(),
          .most_rise = mostRise()};
}

ClassState ClassLessons::stateInSteps() const noexcept {
  ClassState s = state();
  s.pull = below(s.pull, kPullStep);
  s.pull_std = std::min(above(s.pull_std, kPullStep), ground_.mean_std);
  s.own_std = std::min(above(s.own_std, kPullStep), ground_.mean_std);
  s.shared = above(s.shared, kPullStep);
  s.sinkage = above(s.sinkage, kSinkageStep);
  s.most_rise = below(s.most_rise, GroundKind::kPullStep);
  s.pull_step = kPullStep;
  s.sinkage_step = kSinkageStep;
  return s;
}

double ClassLessons::meanOf(const Told& told) const noexcept {
  const double prior = ground_.mean_std * ground_.mean_std;
  return prior * static_cast<double>(told.pull) / kUnit /
         (prior * static_cast<double>(told.weight) / kUnit + ground_.pull_std * ground_.pull_std);
}

// Infinite of fewer than two drives.
double ClassLessons::mostByDrives() const noexcept {
  double most = std::numeric_limits<double>::infinity();
  if (by_drive_.size() < 2) return most;
  for (const auto& [drive, told] : by_drive_) {
    const double weighed = ground_.mean_std * ground_.mean_std * static_cast<double>(told.weight) / kUnit /
                           (ground_.pull_std * ground_.pull_std);
    if (drive != 0) most = std::min(most, meanOf(told) + ground_.mean_std / std::sqrt(1.0 + weighed));
  }
  return most;
}

void ClassLessons::refresh() {
  const double variance = ground_.pull_std * ground_.pull_std;
  const double prior = ground_.mean_std * ground_.mean_std;
  const double heard = std::clamp(
      (static_cast<double>(places_.driven()) - 1.0) / (static_cast<double>(kPlaces) - 1.0), 0.0, 1.0);
  posterior_.places = static_cast<double>(weight_) / kUnit;
  double pull = heard * meanOf({weight_, pull_});
  if (raising_weight_ > 0) pull = std::min(pull, heard * meanOf({raising_weight_, raising_pull_}));
  posterior_.pull = {std::min({pull, mostByDrives(), mostRise()}), ground_.mean_std};
  posterior_.own_std = ground_.mean_std;
  posterior_.shared = 0.0;
  posterior_.sinkage.value = heard * meanOf({sinkage_weight_, sinkage_});
  if (mayRaise()) {
    const double raising = static_cast<double>(raising_weight_) / kUnit;
    const double share = prior * raising / (prior * raising + variance);
    posterior_.own_std = std::sqrt(prior * (1.0 - share));
    if (raising > 0.0) posterior_.shared = share * static_cast<double>(shared_) / kUnit / raising;
    posterior_.pull.std = std::sqrt(
        withSharedError({.prior = prior, .variance = prior * (1.0 - share), .shared = posterior_.shared}));
  } else {
    posterior_.sinkage.value = std::max(posterior_.sinkage.value, 0.0);
  }
  posterior_.sinkage.std = posterior_.pull.std * ground_.sinkage_std / ground_.pull_std;
}

}  // namespace talus::costmap
