#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <talus/costmap/evidence/block_evidence.hpp>

namespace talus::costmap {
namespace {

namespace kind = reading_kind;

constexpr double kStep = 0.01;
constexpr double kLowest = -1.28;
constexpr double kSurest = 0.025;  // standard deviation of grade 0 [-]
constexpr double kModel =
    0.02;  // error of thesis Eq. 3.12 for drawbar pull over load, common to all readings of a place [-]
constexpr double kReferenceStd = 0.05;  // standard deviation of a reading that counts as one sample [-]
constexpr double kLeastShared = 0.02, kSharedStep = 1.5;
// Shared error of unverified readings, those of a sound slip sensor before its offset and scale are estimated
// (ours).
constexpr double kUnverifiedShared = 0.03;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

double stdOf(std::size_t grade) noexcept {
  return kSurest * std::exp2(0.5 * static_cast<double>(grade));
}

std::uint8_t stepped(double steps) noexcept {
  return static_cast<std::uint8_t>(std::clamp(steps, 0.0, 255.0));
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

// Both grades of a kind of pulls, g + 8 h.
std::size_t gradesOf(std::uint8_t of) noexcept {
  return of >= kind::kPullTwice ? std::size_t{of} - kind::kPullTwice : of;
}

// True if a kind is a pull.
bool isPull(std::uint8_t of) noexcept {
  return of < kind::kSinkage || of >= kind::kPullTwice;
}

}  // namespace

double SourcePull::variance() const noexcept {
  return kModel * kModel + 1.0 / weight;
}

double sharedStd(std::size_t grade) noexcept {
  return grade == 0 ? 0.0 : kLeastShared * std::pow(kSharedStep, static_cast<double>(grade) - 1.0);
}

ReadingCount pullReading(const Estimate& pull, Trust trust, double shared_std) noexcept {
  const double grade = std::ceil(2.0 * std::log2(pull.std / kSurest) - 1e-9);
  const double clamped = grade > 0.0 ? std::min(grade, kind::kGrades - 1.0) : 0.0;
  std::size_t shared = 0;
  while (shared < kind::kSharedGrades && !(shared_std <= sharedStd(shared) + 1e-9)) ++shared;
  const bool unverified = trust == Trust::Unverified || shared == kind::kSharedGrades;
  const std::size_t first =
      unverified ? kind::kPullUnverified
                 : (trust == Trust::Twice ? kind::kPullTwice : kind::kPull) + shared * kind::kGrades;
  return {static_cast<std::uint8_t>(static_cast<double>(first) + clamped),
          stepped(std::round((pull.value - kLowest) / kStep)), 1};
}

ReadingCount sinkageReading(double sinkage_over_radius, bool verified) noexcept {
  return {verified ? kind::kSinkage : kind::kSinkageUnverified,
          stepped(std::round(sinkage_over_radius / kStep)), 1};
}

std::vector<ReadingCount> boundReadings(const GroundBound& bound) {
  std::vector<ReadingCount> readings;
  if (!std::isnan(bound.most_pull))
    readings.push_back(
        {kind::kMostPullHere, stepped(std::floor((bound.most_pull - kLowest) / kStep + 1e-6)), 1});
  if (!std::isnan(bound.least_sinkage))
    readings.push_back({kind::kLeastSinkageHere, stepped(std::ceil(bound.least_sinkage / kStep - 1e-6)), 1});
  return readings;
}

std::vector<SourcePull> pullsOf(std::span<const ReadingCount> counts) {
  std::map<Source, SourcePull> sources;
  for (const ReadingCount& c : counts) {
    if (!isPull(c.kind)) continue;
    const bool twice = c.kind >= kind::kPullTwice, unverified = !twice && c.kind >= kind::kPullUnverified;
    const std::size_t grades = gradesOf(c.kind);
    const double std = stdOf(grades % kind::kGrades), w = c.count / (std * std);
    SourcePull& one = sources[{c.drive, unverified ? Trust::Unverified : twice ? Trust::Twice : Trust::Once}];
    one.weight += w;
    one.pull += w * pullOf(c.step);
    one.shared += w * (unverified ? kUnverifiedShared : sharedStd(grades / kind::kGrades));
  }
  std::vector<SourcePull> pulls;
  for (auto& [source, one] : sources)
    pulls.push_back({source, one.weight, one.pull / one.weight, one.shared / one.weight});
  return pulls;
}

void summarise(std::span<const ReadingCount> counts, BlockEvidence& block) {
  block.pull = block.sinkage = block.most_pull = block.least_sinkage = kNone;
  double weight = 0.0, pull = 0.0, depths = 0.0, depth = 0.0;
  for (const SourcePull& one : pullsOf(counts)) {
    weight += one.weight;
    pull += one.weight * one.pull;
  }
  if (weight > 0.0) block.pull = static_cast<float>(pull / weight);
  block.sinkage_verified = std::ranges::any_of(counts, [](auto& c) { return c.kind == kind::kSinkage; });
  for (const ReadingCount& c : counts) {
    if (c.kind == (block.sinkage_verified ? kind::kSinkage : kind::kSinkageUnverified)) {
      depths += c.count;
      depth += c.count * sinkageOf(c.step);
    }
    if (c.kind == kind::kMostPullHere)
      block.most_pull = std::fmin(block.most_pull, static_cast<float>(mostPullOf(c.step)));
    if (c.kind == kind::kLeastSinkageHere)
      block.least_sinkage = std::fmax(block.least_sinkage, static_cast<float>(sinkageOf(c.step)));
  }
  if (depths > 0.0) block.sinkage = static_cast<float>(depth / depths);
}

double samples(std::span<const ReadingCount> counts) noexcept {
  double sum = 0.0;
  for (const ReadingCount& c : counts) {
    if (!isPull(c.kind)) continue;
    const double std = stdOf(gradesOf(c.kind) % kind::kGrades);
    sum += c.count * kReferenceStd * kReferenceStd / (std * std);
  }
  return sum;
}

}  // namespace talus::costmap
