#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <site_fixture.hpp>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence.hpp>

namespace talus::costmap {
namespace class_evidence_test {

void addTimes(BlockEvidence& block, Source source, const Estimate& pull, double shared_std, int times) {
  for (int i = 0; i < times; ++i) block.sources[source].addPull(pull, shared_std);
}

// Property: the readings of a block are separated by drive and verification; a mean is weighted by inverse
// variance, with the model error as the least variance. Closed forms. A reading of standard deviation 0.05 counts as
// one sample.
TEST(BlockEvidence, PullsAreSeparatedBySource) {
  BlockEvidence block;
  addTimes(block, {0, Trust::Once}, {0.10, 0.05}, 0.03, 3);
  addTimes(block, {0, Trust::Once}, {0.20, 0.1}, 0.03, 4);
  addTimes(block, {0, Trust::Twice}, {0.30, 0.05}, 0.02, 5);
  addTimes(block, {0, Trust::Unverified}, {0.40, 0.05}, 0.03, 6);
  addTimes(block, {9, Trust::Once}, {0.10, 0.05}, 0.03, 3);
  const std::vector<SourcePull> pulls = block.pulls();
  ASSERT_EQ(pulls.size(), 4U);
  EXPECT_EQ(pulls[0].source.trust, Trust::Unverified);
  EXPECT_NEAR(pulls[1].pull, (3 * 0.10 / 0.0025 + 4 * 0.20 / 0.01) / (3 / 0.0025 + 4 / 0.01), 1e-8);
  EXPECT_NEAR(pulls[1].variance(), 0.0004 + 1.0 / (3 / 0.0025 + 4 / 0.01), 1e-8);
  EXPECT_NEAR(pulls[1].shared, 0.03, 1e-8);
  EXPECT_EQ(pulls[2].source.trust, Trust::Twice);
  EXPECT_EQ(pulls[3].source.drive, 9);
  EXPECT_NEAR(block.samples(), 18.0, 1e-8);
}

TEST(BlockEvidence, SinkageIsThatOfVerifiedSensorsIfAny) {
  BlockEvidence block;
  EXPECT_TRUE(std::isnan(block.sinkage()));
  block.sources[{0, Trust::Unverified}].addSinkage(0.9);
  EXPECT_FALSE(block.sinkageVerified());
  EXPECT_NEAR(block.sinkage(), 0.9, 1e-6);
  for (const double z : {0.1, 0.1, 0.1, 0.5}) block.sources[{0, Trust::Once}].addSinkage(z);
  EXPECT_NEAR(block.sinkage(), 0.2, 1e-6);
  EXPECT_TRUE(block.sinkageVerified());
}

// Property: readings in any order give equal sums, and what is taken off leaves what there was; the strictest of
// several bounds is kept.
TEST(BlockEvidence, ReadingsAreTakenOffExactly) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(-0.5, 0.5);
  std::vector<SourceReadings> all(200);
  for (SourceReadings& one : all) {
    one.addPull({value(random), 0.05 + 0.1 * std::abs(value(random))}, 0.02 + 0.1 * std::abs(value(random)));
    one.addSinkage(std::abs(value(random)));
  }
  const auto sums = [](const SourceReadings& r) {
    return std::tuple(r.weight, r.pull, r.shared, r.sinkages, r.sinkage);
  };
  SourceReadings half, taken;
  for (std::size_t i = 0; i < all.size(); i += 2) half.add(all[i], 1);
  std::ranges::shuffle(all, random);
  for (const SourceReadings& one : all) taken.add(one, 1);
  SourceReadings rest = taken;
  rest.add(half, -1);
  rest.add(half, 1);
  EXPECT_EQ(sums(rest), sums(taken));
  for (const SourceReadings& one : all) taken.add(one, -1);
  EXPECT_TRUE(taken.empty());
  BlockEvidence block;
  for (const GroundBound& bound : {GroundBound{-0.1, 0.6}, GroundBound{-0.3, 0.8}, GroundBound{0.05, 0.55}})
    block.sources[{0, Trust::Once}].bound.join(bound);
  EXPECT_EQ(block.bound().most_pull, -0.3);
  EXPECT_EQ(block.bound().least_sinkage, 0.8);
}

constexpr Variation kVariation{.pull_std = 0.05, .sinkage_std = 0.1, .correlation_length_m = 4.0};

TEST(SparseKernel, KernelDecreasesFromOneToZero) {
  EXPECT_DOUBLE_EQ(sparseKernel(0.0, 4.0), 1.0);
  EXPECT_EQ(sparseKernel(4.0, 4.0), 0.0);
  EXPECT_NEAR(sparseKernel(2.0, 4.0), 1.0 / 6.0, 1e-12);  // Closed form: (2 - 1)/3 * 1/2
}

TEST(GaussianProcess, OnePlaceIsTheConjugateUpdate) {
  const GaussianProcess process({{.place = {0, 0}, .pull = 0.1, .sinkage = 0.0, .variance = 0.0025}},
                                kVariation);
  // Closed form: a prior and a measurement of equal variance average with equal weights.
  EXPECT_NEAR(process.learned({0, 0}).departure.pull.value, 0.05, 1e-12);
  EXPECT_NEAR(process.learned({0, 0}).departure.pull.std, 0.05 * std::sqrt(0.5), 1e-12);
  EXPECT_EQ(process.learned({5, 0}).departure.pull.value, 0.0);
  EXPECT_EQ(process.learned({5, 0}).departure.pull.std, 0.05);
}

TEST(GaussianProcess, RepeatedPlacesDoNotReduceNeighbourVarianceBelowItsLimit) {
  std::vector<PlaceEvidence> many(20, {.place = {0, 0}, .pull = 0.1, .sinkage = 0.0, .variance = 0.0025});
  const double k = sparseKernel(2.0, 4.0);
  // Property: a place 2 m away that is known exactly reduces the variance by the share k^2 at most.
  EXPECT_GE(GaussianProcess(many, kVariation).learned({2, 0}).departure.pull.std,
            0.05 * std::sqrt(1.0 - k * k));
}

constexpr double kPrior = 0.2, kP = 0.05, kQ = 0.08;

constexpr double kDay_s = 86400.0;

GroundClass sand(double correlation_time_s = 0.0) {
  GroundClass ground{.number = 1, .soil = testSand(), .pull_std = kP, .mean_std = kQ};
  ground.soil.correlation_time_s = correlation_time_s;
  return ground;
}

SourcePull pullOf(std::uint16_t drive, Trust trust, double departure, double shared, double time_s = 0.0) {
  return {.source = {drive, trust},
          .weight = 1e9,
          .pull = kPrior + departure,
          .time_s = time_s,
          .shared = shared};
}

// Number of places as which one block with such a pull counts: less with the probability that it is on another
// soil, 0.02 with departures of 0.3.
double weightOf(const SourcePull& pull) {
  const double y = pull.pull - kPrior, v = kP * kP + kQ * kQ + pull.variance() + pull.shared * pull.shared;
  const double own = 0.98 * std::exp(-0.5 * y * y / v) / std::sqrt(v),
               other = 0.02 * std::exp(-0.5 * y * y / 0.09) / 0.3;
  return kP * kP / (kP * kP + pull.variance()) * own / (own + other);
}

double meanOf(const ClassState& state) {
  double mean = 0.0;
  for (const ClassHypothesis& h : state.hypotheses) mean += h.weight * h.pull;
  return mean;
}

TEST(ClassEvidence, WithoutEvidenceIsThePrior) {
  const ClassState state = ClassEvidence(sand()).state();
  ASSERT_EQ(state.hypotheses.size(), 1U);
  EXPECT_EQ(state.hypotheses[0].pull, 0.0);
  EXPECT_NEAR(std::hypot(state.hypotheses[0].own_std, state.hypotheses[0].shared_std), kQ, 1e-12);
}

// Property: the probability and the mean of each hypothesis are those of the joint normal distribution of the
// class mean, the driven places and the readings, by brute force over all combinations of faulty drives. In every
// second round the soil changes with time; the drives are out of order, and in some rounds one has no times.
TEST(ClassEvidence, HypothesesEqualBruteForce) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 30; ++round) {
    std::vector<SourcePull> pulls;
    const int drives = 1 + round % 3;
    const double changes_s = round % 2 * 30.0 * kDay_s;
    for (int d = 0; d < drives; ++d)
      pulls.push_back(pullOf(static_cast<std::uint16_t>(d), static_cast<Trust>((round + d) % 3),
                             std::clamp(0.08 * normal(random), -0.15, 0.15), 0.02 + 0.01 * d,
                             round % 5 == 4 && d == 1 ? 0.0 : kDay_s * (1000 + (20 - 7 * d) * d)));
    const auto newest = std::ranges::max(pulls, {}, &SourcePull::time_s).time_s;
    const auto alike = [&](double a_s, double b_s) {
      const auto at = [&](double time_s) { return time_s > 0.0 ? time_s : newest; };
      return changes_s > 0.0 ? std::exp(-std::abs(at(a_s) - at(b_s)) / changes_s) : 1.0;
    };
    ClassEvidence evidence(sand(changes_s));
    constexpr int kBlocks = 7;
    for (int b = 0; b < kBlocks; ++b) evidence.count(pulls, kPrior, 1.0, 1);
    const ClassState state = evidence.state();
    double places = 0.0;
    std::vector<double> error;  // variance of the error of each drive
    for (const SourcePull& one : pulls) places = std::max(places, kBlocks * weightOf(one));
    for (const SourcePull& one : pulls)
      error.push_back(one.shared * one.shared + kP * kP / (kBlocks * weightOf(one)) - kP * kP / places);
    const double faulty[] = {0.5, 0.07, 0.001};
    std::vector<std::pair<double, double>> expected;  // probability and mean of D
    double sum = 0.0;
    for (unsigned set = 0; set < 1U << drives; ++set) {
      double weight = 1.0;
      std::vector<int> sound;
      for (int d = 0; d < drives; ++d) {
        const double p = faulty[static_cast<int>(pulls[static_cast<std::size_t>(d)].source.trust)];
        const double y = pulls[static_cast<std::size_t>(d)].pull - kPrior;
        if ((set >> d & 1U) != 0) {
          const double v = std::pow(2.0 * kQ, 2) + kP * kP / places + error[static_cast<std::size_t>(d)];
          weight *= p * std::exp(-0.5 * y * y / v) / std::sqrt(v);
        } else {
          weight *= 1.0 - p;
          sound.push_back(d);
        }
      }
      const auto n = static_cast<Eigen::Index>(sound.size());
      Eigen::MatrixXd covariance(n, n);
      Eigen::VectorXd y(n), with_present(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto drive = static_cast<std::size_t>(sound[static_cast<std::size_t>(i)]);
        y(i) = pulls[drive].pull - kPrior;
        with_present(i) = kQ * kQ * alike(pulls[drive].time_s, newest);
        for (Eigen::Index j = 0; j < n; ++j)
          covariance(i, j) =
              (kQ * kQ + kP * kP / places) *
                  alike(pulls[drive].time_s,
                        pulls[static_cast<std::size_t>(sound[static_cast<std::size_t>(j)])].time_s) +
              (i == j ? error[drive] : 0.0);
      }
      double mean = 0.0;
      if (n > 0) {
        const Eigen::VectorXd solved = covariance.ldlt().solve(y);
        weight *= std::exp(-0.5 * y.dot(solved)) / std::sqrt(covariance.determinant());
        mean = with_present.dot(solved);
      }
      expected.emplace_back(weight, mean);
      sum += weight;
    }
    ASSERT_EQ(state.hypotheses.size(), expected.size());
    std::ranges::sort(expected, std::greater{});
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(state.hypotheses[i].weight, expected[i].first / sum, 1e-4) << round;
      EXPECT_NEAR(state.hypotheses[i].pull, expected[i].second, 2e-5) << round;
    }
  }
}

// Property: of two drives that contradict each other, some hypothesis of considerable weight has the weaker.
// A slip measured twice outweighs one measured once.
TEST(ClassEvidence, ContradictingDrivesLeaveTheWeakerOneProbable) {
  const auto with = [](Trust strong) {
    ClassEvidence evidence(sand());
    for (int b = 0; b < 20; ++b)
      evidence.count(std::vector{pullOf(1, Trust::Once, -0.09, 0.01), pullOf(2, strong, 0.09, 0.01)}, kPrior,
                     1.0, 1);
    double weak = 0.0;
    for (const ClassHypothesis& h : evidence.state().hypotheses) weak += h.pull < -0.05 ? h.weight : 0.0;
    return weak;
  };
  EXPECT_GT(with(Trust::Once), 0.3);
  EXPECT_LT(with(Trust::Twice), 0.25);
}

// Property: what an old drive over few places read below the present ground is common to its places.
TEST(ClassEvidence, ChangeOfTheSoilIsCommonToAnOldDrive) {
  ClassEvidence evidence(sand(kDay_s));
  const auto old = pullOf(1, Trust::Twice, -0.05, 0.02, kDay_s);
  for (int b = 0; b < 2; ++b) evidence.count(std::vector{old}, kPrior, 1.0, 1);
  for (int b = 0; b < 20; ++b)
    evidence.count(std::vector{pullOf(2, Trust::Twice, 0.05, 0.02, 200.0 * kDay_s)}, kPrior, 1.0, 1);
  EXPECT_NEAR(evidence.state().hypotheses[0].sound[0].second, -0.1, 0.015);
}

// Property: the order of blocks has no effect, and a block that is removed leaves nothing behind.
TEST(ClassEvidence, SumsAreExact) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<std::vector<SourcePull>> blocks;
  for (int b = 0; b < 40; ++b)
    blocks.push_back({pullOf(static_cast<std::uint16_t>(b % 3), Trust::Once, 0.05 * normal(random), 0.02)});
  ClassEvidence forwards(sand()), backwards(sand());
  for (const auto& block : blocks) forwards.count(block, kPrior, 0.4, 1);
  std::ranges::reverse(blocks);
  const std::vector<SourcePull> other{pullOf(77, Trust::Once, 0.1, 0.02)};
  backwards.count(other, kPrior, 0.4, 1);
  for (const auto& block : blocks) backwards.count(block, kPrior, 0.4, 1);
  backwards.count(other, kPrior, 0.4, -1);
  EXPECT_EQ(forwards.state(), backwards.state());
}

// Property: on classes and drives drawn from the model, the posterior mean is unbiased and the truth lies
// within one and two standard deviations as often as the normal distribution says. In every second world the soil
// changes between the drives.
TEST(ClassEvidence, PosteriorIsCalibrated) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  double bias = 0.0;
  int one = 0, two = 0;
  constexpr int kWorlds = 3000, kBlocks = 12;
  for (int world = 0; world < kWorlds; ++world) {
    const double days = world / 3 % 2 * 30.0, r = days > 0.0 ? std::exp(-10.0 / days) : 1.0;
    double truth = kQ * normal(random);
    ClassEvidence evidence(sand(days * kDay_s));
    const int drives = 1 + world % 3;
    std::vector<double> error, faulty, ground;
    for (int d = 0; d < drives; ++d) {
      if (d > 0) truth = r * truth + std::sqrt(1.0 - r * r) * kQ * normal(random);
      ground.push_back(truth);
      faulty.push_back(uniform(random) < 0.07 ? 1.0 : 0.0);
      error.push_back(faulty.back() > 0.0 ? 2.0 * kQ * normal(random) : 0.02 * normal(random));
    }
    for (int b = 0; b < kBlocks; ++b) {
      const double place = kP * normal(random);
      std::vector<SourcePull> pulls;
      for (std::size_t d = 0; d < error.size(); ++d)
        pulls.push_back(
            pullOf(static_cast<std::uint16_t>(d), Trust::Once,
                   faulty[d] > 0.0 ? error[d] : ground[d] + place + error[d] + 0.02 * normal(random), 0.02,
                   kDay_s * (100.0 + 10.0 * static_cast<double>(d))));
      evidence.count(pulls, kPrior, 1.0, 1);
    }
    const ClassState state = evidence.state();
    const double mean = meanOf(state);
    double variance = 0.0;
    for (const ClassHypothesis& h : state.hypotheses)
      variance +=
          h.weight * (std::pow(h.pull - mean, 2) + h.own_std * h.own_std + h.shared_std * h.shared_std);
    const double z = (truth - mean) / std::sqrt(variance);
    bias += (mean - truth) / kWorlds;
    one += std::abs(z) < 1.0 ? 1 : 0;
    two += std::abs(z) < 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(bias, 0.0, 0.003);
  EXPECT_NEAR(one / double{kWorlds}, 0.70, 0.06);  // mixtures have longer tails than the normal distribution
  EXPECT_NEAR(two / double{kWorlds}, 0.95, 0.02);
}

}  // namespace class_evidence_test
}  // namespace talus::costmap
