#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/spreading.hpp>
#include <talus/costmap/ground/ground_kind.hpp>

namespace talus::costmap {
namespace {

constexpr double kUnit = 1048576.0;  // fixed-point units per 1

std::int64_t fixed(double value) {
  return static_cast<std::int64_t>(std::llround(value * kUnit));
}

constexpr double kPullStep = 0.005, kSinkageStep = 0.02;
constexpr double kSame = 1e-6;  // tolerance [steps], so that a rounded number rounds to itself

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

void ClassEvidence::WeightedSum::add(const WeightedSum& other) noexcept {
  weight += other.weight;
  departure += other.departure;
}

void ClassEvidence::add(std::uint16_t drive, const WeightedSum& sum, ByDrive& drives) {
  WeightedSum& all = drives[drive];
  all.add(sum);
  if (all.weight == 0) drives.erase(drive);
}

void ClassEvidence::sum(const BlockContribution& contribution, std::int64_t sign) {
  const auto sum = [&](double departure) {
    return WeightedSum{sign * fixed(contribution.weight), sign * fixed(contribution.weight * departure)};
  };
  if (contribution.raises) {
    pull_.add(sum(contribution.pull));
    add(contribution.drive, sum(contribution.pull), pull_by_drive_);
    shared_ += sign * fixed(contribution.weight * contribution.shared);
  } else {
    add(contribution.drive, sum(contribution.pull), lower_pull_);
  }
  if (!contribution.sinkage) return;
  if (contribution.sinkage_raises)
    sinkage_.add(sum(-*contribution.sinkage));
  else
    add(contribution.drive, sum(-*contribution.sinkage), lower_sinkage_);
}

double ClassEvidence::mostRise() const noexcept {
  return mayRaise() ? std::max(places_.agreed(kPlaces), 0.0) : 0.0;
}

ClassState ClassEvidence::state() const noexcept {
  return {.pull = posterior_.pull.value,
          .pull_std = posterior_.pull.std,
          .own_std = posterior_.own_std,
          .shared = posterior_.shared,
          .sinkage = posterior_.sinkage.value,
          .may_raise = mayRaise(),
          .most_rise = mostRise()};
}

ClassState ClassEvidence::stateInSteps() const noexcept {
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

// Conjugate update of the class mean with prior variance mean_std^2 (B12).
double ClassEvidence::meanOf(const WeightedSum& sum) const noexcept {
  const double prior = ground_.mean_std * ground_.mean_std;
  return prior * static_cast<double>(sum.departure) / kUnit /
         (prior * static_cast<double>(sum.weight) / kUnit + ground_.pull_std * ground_.pull_std);
}

// Least mean over all combinations of the contributions that may raise with any of the lowering drives (B12).
// The set of drives with the least mean contains all drives below some departure; the drives are therefore
// added in ascending order.
double ClassEvidence::leastMean(WeightedSum raising, const ByDrive& lowering) const {
  std::vector<WeightedSum> drives;
  for (const auto& [drive, sum] : lowering) drives.push_back(sum);
  std::ranges::sort(drives, [](const WeightedSum& a, const WeightedSum& b) {
    return static_cast<double>(a.departure) * static_cast<double>(b.weight) <
           static_cast<double>(b.departure) * static_cast<double>(a.weight);
  });
  double least = meanOf(raising);
  for (const WeightedSum& sum : drives) {
    raising.add(sum);
    least = std::min(least, meanOf(raising));
  }
  return least;
}

// Posterior standard deviation of the class mean from the given contributions alone (B12).
double ClassEvidence::deviationOf(const WeightedSum& sum) const noexcept {
  const double weighed = ground_.mean_std * ground_.mean_std * static_cast<double>(sum.weight) / kUnit /
                         (ground_.pull_std * ground_.pull_std);
  return ground_.mean_std / std::sqrt(1.0 + weighed);
}

// Least value of mean plus one standard deviation over the drives that may raise; infinite for fewer than two
// drives.
double ClassEvidence::mostByDrives() const noexcept {
  double most = std::numeric_limits<double>::infinity();
  if (pull_by_drive_.size() < 2) return most;
  for (const auto& [drive, sum] : pull_by_drive_)
    if (drive != 0) most = std::min(most, meanOf(sum) + deviationOf(sum));
  return most;
}

bool ClassEvidence::drivesAgree() const noexcept {
  constexpr double kApart =
      3.0;  // standard deviations of the difference; 0.3 % of pairs of sound drives lie further apart
  for (const auto& [one, weak] : pull_by_drive_)
    for (const auto& [other, strong] : pull_by_drive_)
      if (one != 0 && other != 0 &&
          meanOf(strong) - meanOf(weak) > kApart * std::hypot(deviationOf(weak), deviationOf(strong)))
        return false;
  return true;
}

void ClassEvidence::refresh() {
  const double variance = ground_.pull_std * ground_.pull_std;
  const double prior = ground_.mean_std * ground_.mean_std;
  const double heard = std::clamp(
      (static_cast<double>(places_.driven()) - 1.0) / (static_cast<double>(kPlaces) - 1.0), 0.0, 1.0);
  std::int64_t weight = pull_.weight;
  for (const auto& [drive, sum] : lower_pull_) weight += sum.weight;
  posterior_.places = static_cast<double>(weight) / kUnit;
  posterior_.pull = {std::min({heard * leastMean(pull_, lower_pull_), mostByDrives(), mostRise()}),
                     ground_.mean_std};
  posterior_.own_std = ground_.mean_std;
  posterior_.shared = 0.0;
  posterior_.sinkage.value = 0.0 - heard * leastMean(sinkage_, lower_sinkage_);
  if (mayRaise()) {
    const double raising = static_cast<double>(pull_.weight) / kUnit;
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
