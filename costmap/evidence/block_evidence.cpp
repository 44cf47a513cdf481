#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>

#include <talus/costmap/evidence/block_evidence.hpp>
#include <talus/costmap/evidence/spreading.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::costmap {
namespace {

namespace kind = reading_kind;

constexpr double kStep = 0.01;
constexpr double kLowest = -1.28;
constexpr double kSurest = 0.025;  // standard deviation of grade 0 [-]
constexpr double kModel =
    0.02;  // error of thesis Eq. 3.12 for drawbar pull over load, common to all readings of a place [-]
constexpr double kSinkageStd = 0.02;    // standard deviation of one reading of sinkage over radius [-]
constexpr double kReferenceStd = 0.05;  // standard deviation of a reading that counts as one sample [-]
constexpr double kLeastShared = 0.02, kSharedStep = 1.5;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

double stdOf(std::size_t grade) noexcept {
  return kSurest * std::exp2(0.5 * static_cast<double>(grade));
}

std::uint8_t stepped(double steps) noexcept {
  return static_cast<std::uint8_t>(std::clamp(steps, 0.0, 255.0));
}

// Mean of the lower tail of probability p of a standard normal distribution (density phi, distribution
// function Phi), with the sign reversed: phi(Phi^-1(p))/p. Tabulated at p = 2^-i and interpolated linearly in
// log p, which never exceeds the exact value.
double tailMean(double p) {
  static const std::array<double, 33> table = [] {
    std::array<double, 33> t{};
    for (std::size_t i = 1; i < t.size(); ++i) {
      const double share = std::ldexp(1.0, -static_cast<int>(i));
      t[i] = terramech::normalDensity(terramech::normalQuantile(share)) / share;
    }
    return t;
  }();
  const double at = std::min(-std::log2(p), 31.0);
  const auto i = static_cast<std::size_t>(at);
  return table[i] + (at - static_cast<double>(i)) * (table[i + 1] - table[i]);
}

// Readings of one grade of certainty.
struct Part {
  double count = 0.0;
  double value = 0.0;  // weakest value, see summarise()
};

// Sets `part` from `counts`, sorted by step. `sign`: 1 if lower values are weaker, -1 if higher values are
// weaker.
template <typename Value>
void addWeakest(std::span<const ReadingCount> counts, double std, double sign, Value value, Part& part) {
  double all = 0.0, lowest = 0.0, sum = 0.0;
  for (const ReadingCount& c : counts) all += c.count;
  part = {all, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const ReadingCount& c = counts[sign > 0.0 ? i : counts.size() - 1 - i];
    lowest += c.count;
    sum += c.count * sign * value(c.step);
    const bool last = i + 1 == counts.size();
    if (!last && counts[sign > 0.0 ? i + 1 : counts.size() - 2 - i].step == c.step) continue;
    part.value = std::min(part.value, sum / lowest + std * tailMean(lowest / all));
  }
  part.value *= sign;
}

double pullOf(std::uint8_t step) noexcept {
  return kLowest + kStep * step;
}
// Returns the pull of a bound. Step 0 represents all lower pulls and returns -10.
double mostPullOf(std::uint8_t step) noexcept {
  constexpr double kLeast = -10.0;
  return step == 0 ? kLeast : pullOf(step);
}
double sinkageOf(std::uint8_t step) noexcept {
  return kStep * step;
}

std::span<const ReadingCount> ofKind(std::span<const ReadingCount> counts, std::uint8_t which) noexcept {
  const auto low = std::find_if(counts.begin(), counts.end(), [&](const auto& c) { return c.kind == which; });
  const auto high = std::find_if(low, counts.end(), [&](const auto& c) { return c.kind != which; });
  return {low, high};
}

// Weighted sum of estimates of one number, weights by inverse variance.
struct Weighed {
  double weight = 0.0, sum = 0.0;
  void add(const Part& part, double std) noexcept {
    weight += part.count / (std * std);
    sum += part.count / (std * std) * part.value;
  }
};

double variance(double weight) noexcept {
  return kModel * kModel + 1.0 / weight;
}

// Keeps `pull` as the weakest pull if its estimate as the only reading, estimateAlone(), is below `least`.
void keepWeakest(double pull, double of_variance, const Estimate& prior, BlockEvidence& block,
                 double& least) {
  const double left = estimateAlone({.departure = pull - prior.value, .variance = of_variance}, prior.std);
  if (left >= least) return;
  least = left;
  block.weak_pull = static_cast<float>(pull);
  block.weak_variance = static_cast<float>(of_variance);
}

// Readings of one grade of certainty that may raise, with any shared error, sorted by step. Returns a view of
// `counts`, or of `merged` if the readings are of several kinds.
std::span<const ReadingCount> raisingOf(std::span<const ReadingCount> counts, std::size_t grade,
                                        std::vector<ReadingCount>& merged) {
  merged.clear();
  std::span<const ReadingCount> only;
  for (std::size_t shared = 0; shared < kind::kSharedGrades; ++shared) {
    const auto heard =
        ofKind(counts, static_cast<std::uint8_t>(kind::kPull + shared * kind::kGrades + grade));
    if (heard.empty()) continue;
    if (only.empty()) {
      only = heard;
      continue;
    }
    if (merged.empty()) merged.assign(only.begin(), only.end());
    merged.insert(merged.end(), heard.begin(), heard.end());
  }
  if (merged.empty()) return only;
  std::sort(merged.begin(), merged.end(), [](const ReadingCount& a, const ReadingCount& b) {
    return std::tuple(a.step, a.kind, a.drive) < std::tuple(b.step, b.kind, b.drive);
  });
  return merged;
}

// Returns the mean shared error of the readings that may raise an estimate, weighted by inverse variance.
double sharedOf(std::span<const ReadingCount> counts) noexcept {
  double weight = 0.0, sum = 0.0;
  for (const ReadingCount& c : counts) {
    if (c.kind >= kind::kPullLowers) break;
    const double std = stdOf(c.kind % kind::kGrades), w = c.count / (std * std);
    weight += w;
    sum += w * sharedStd(c.kind / kind::kGrades);
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

// Weighted pulls of the readings that may raise, and of all readings.
struct Pulls {
  Weighed raising, all;
};

// Adds the weakest pull of each grade of certainty. `least`: lowest estimate of a single pull so far, see
// keepWeakest().
Pulls weighPulls(std::span<const ReadingCount> counts, const Estimate& prior, BlockEvidence& block,
                 double& least) {
  Pulls out;
  std::vector<ReadingCount> merged;
  for (std::size_t grade = 0; grade < kind::kGrades; ++grade) {
    const double std = stdOf(grade);
    for (const std::uint8_t first : {kind::kPull, kind::kPullLowers}) {
      const auto heard = first == kind::kPull ? raisingOf(counts, grade, merged)
                                              : ofKind(counts, static_cast<std::uint8_t>(first + grade));
      if (heard.empty()) continue;
      Part part;
      addWeakest(heard, std, 1.0, pullOf, part);
      keepWeakest(part.value, variance(part.count / (std * std)), prior, block, least);
      out.all.add(part, std);
      if (first == kind::kPull) out.raising.add(part, std);
      block.lowers |= first == kind::kPullLowers;
    }
  }
  if (out.all.weight > 0.0)
    keepWeakest(out.all.sum / out.all.weight, variance(out.all.weight), prior, block, least);
  return out;
}

// Standard error of the mean of the readings that may raise, from their scatter and the quantisation step;
// infinite for fewer than two readings.
double scatterOfMean(std::span<const ReadingCount> counts) noexcept {
  double n = 0.0, sum = 0.0, squares = 0.0;
  for (const ReadingCount& c : counts) {
    if (c.kind >= kind::kPullLowers) break;
    n += c.count;
    sum += c.count * pullOf(c.step);
    squares += c.count * pullOf(c.step) * pullOf(c.step);
  }
  if (n < 2.0) return std::numeric_limits<double>::infinity();
  return std::sqrt((std::max(squares - sum * sum / n, 0.0) / (n - 1.0) + kStep * kStep) / n);
}

// Limits block.pull by the drive with the least bound, see summarise(): the mean of the drive, plus kBeyond
// standard errors if these exceed kModel, plus the difference between the least of n and the least of two
// sound drives.
void boundByDrives(std::span<const ReadingCount> counts, const Estimate& prior, BlockEvidence& block,
                   double& least) {
  constexpr double kBeyond = 2.0;
  constexpr double kSound = 0.02;  // standard deviation between sound drives in one block [-] (ours)
  const auto isOfFirst = [&](const ReadingCount& c) { return c.drive == counts.front().drive; };
  if (counts.empty() || std::ranges::all_of(counts, isOfFirst)) return;
  double raising_drives = 0.0, most = std::numeric_limits<double>::infinity(), of_variance = 0.0;
  for (const std::uint16_t drive : drivesOf(counts)) {
    const std::vector<ReadingCount> own = ofDrive(counts, drive);
    const Weighed raising = weighPulls(own, prior, block, least).raising;
    if (raising.weight <= 0.0) continue;
    raising_drives += 1.0;
    const double beyond = kBeyond * scatterOfMean(own);
    const double bound = raising.sum / raising.weight + (beyond > kModel ? beyond : 0.0);
    if (bound >= most) continue;
    most = bound;
    of_variance = variance(raising.weight);
  }
  if (raising_drives < 2.0) return;
  most += kSound * (tailMean(1.0 / raising_drives) - tailMean(0.5));
  if (most >= static_cast<double>(block.pull)) return;
  block.pull = static_cast<float>(most);
  block.variance = static_cast<float>(of_variance);
}

void summarisePull(std::span<const ReadingCount> counts, const Estimate& prior, BlockEvidence& block) {
  double least = std::numeric_limits<double>::infinity();
  block.lowers = false;
  const auto [raising, all] = weighPulls(counts, prior, block, least);
  if (all.weight <= 0.0) block.weak_pull = block.weak_variance = kNone;
  block.pull = raising.weight > 0.0 ? static_cast<float>(raising.sum / raising.weight) : kNone;
  block.variance = raising.weight > 0.0 ? static_cast<float>(variance(raising.weight)) : kNone;
  block.shared = static_cast<float>(sharedOf(counts));
  boundByDrives(counts, prior, block, least);
}

}  // namespace

double sharedStd(std::size_t grade) noexcept {
  return grade == 0 ? 0.0 : kLeastShared * std::pow(kSharedStep, static_cast<double>(grade) - 1.0);
}

ReadingCount pullReading(const Estimate& pull, bool may_raise, double shared_std) noexcept {
  const double grade = std::ceil(2.0 * std::log2(pull.std / kSurest) - 1e-9);
  const double clamped = grade > 0.0 ? std::min(grade, kind::kGrades - 1.0) : 0.0;
  std::size_t shared = 0;
  while (shared < kind::kSharedGrades && !(shared_std <= sharedStd(shared) + 1e-9)) ++shared;
  const bool raises = may_raise && shared < kind::kSharedGrades;
  const auto kind = static_cast<std::uint8_t>(
      (raises ? kind::kPull + static_cast<double>(shared * kind::kGrades) : kind::kPullLowers) + clamped);
  return {kind, stepped(std::floor((pull.value - kLowest) / kStep + (raises ? 0.5 : 1e-6))), 1};
}

ReadingCount sinkageReading(double sinkage_over_radius, bool may_raise) noexcept {
  return {may_raise ? kind::kSinkage : kind::kSinkageLowers,
          stepped(std::ceil(sinkage_over_radius / kStep - 1e-6)), 1};
}

std::vector<ReadingCount> boundReadings(const GroundBound& bound) {
  std::vector<ReadingCount> readings;
  const auto keep = [&](std::uint8_t which, ReadingCount reading) {
    reading.kind = which;
    readings.push_back(reading);
  };
  if (!std::isnan(bound.most_pull)) keep(kind::kMostPullHere, pullReading({bound.most_pull, kSurest}, false));
  if (!std::isnan(bound.least_sinkage))
    keep(kind::kLeastSinkageHere, sinkageReading(bound.least_sinkage, false));
  return readings;
}

void summarise(std::span<const ReadingCount> counts, const Estimate& prior, BlockEvidence& block) {
  summarisePull(counts, prior, block);
  const auto pulls = ofKind(counts, kind::kMostPullHere), depths = ofKind(counts, kind::kLeastSinkageHere);
  block.most_pull = pulls.empty() ? kNone : static_cast<float>(mostPullOf(pulls.front().step));
  block.least_sinkage = depths.empty() ? kNone : static_cast<float>(sinkageOf(depths.back().step));
  block.sinkage = std::numeric_limits<float>::quiet_NaN();
  block.sinkage_raises = false;
  for (const std::uint8_t which : {kind::kSinkage, kind::kSinkageLowers}) {
    const auto heard = ofKind(counts, which);
    if (heard.empty()) continue;
    Part part;
    addWeakest(heard, kSinkageStd, -1.0, sinkageOf, part);
    block.sinkage = std::fmax(block.sinkage, static_cast<float>(part.value));
    block.sinkage_raises |= which == kind::kSinkage;
  }
}

std::vector<std::uint16_t> drivesOf(std::span<const ReadingCount> counts) {
  std::vector<std::uint16_t> drives;
  for (const ReadingCount& c : counts) drives.push_back(c.drive);
  std::ranges::sort(drives);
  drives.erase(std::unique(drives.begin(), drives.end()), drives.end());
  return drives;
}

std::vector<ReadingCount> ofDrive(std::span<const ReadingCount> counts, std::uint16_t drive) {
  std::vector<ReadingCount> own;
  std::ranges::copy_if(counts, std::back_inserter(own), [&](const auto& c) { return c.drive == drive; });
  return own;
}

double samples(std::span<const ReadingCount> counts) noexcept {
  double sum = 0.0;
  for (const ReadingCount& c : counts) {
    if (c.kind >= kind::kSinkage) continue;
    const double std = stdOf(c.kind % kind::kGrades);
    sum += c.count * kReferenceStd * kReferenceStd / (std * std);
  }
  return sum;
}

}  // namespace talus::costmap
