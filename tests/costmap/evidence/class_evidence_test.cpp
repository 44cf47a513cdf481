#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/evidence/class_evidence.hpp>

namespace talus::costmap {
namespace class_evidence_test {

GroundClass sand() {
  return {.number = 1, .soil = testSand(), .pull_std = 0.05, .mean_std = 0.05};
}

TEST(IndependentPlaces, AdjacentSquaresAreNotCountedAsIndependent) {
  IndependentPlaces places;
  for (int column = 0; column < 4; ++column) places.set({column, 0}, 0.1F);
  EXPECT_EQ(places.driven(), 2U) << "of four in a row every other one";
  EXPECT_TRUE(std::isinf(places.agreed(3)));
  places.set({4, 0}, 0.05F);
  // Closed form: squares 0, 2 and 4 contain 0.1, 0.1 and 0.05
  EXPECT_NEAR(places.agreed(3), 0.05, 1e-7);
  places.set({4, 0}, std::nullopt);
  EXPECT_EQ(places.driven(), 2U);
}

ClassEvidence taught(const std::vector<double>& pulls, bool raises) {
  ClassEvidence contributions(sand());
  int column = 0;
  for (const double pull : pulls) {
    contributions.add({.weight = 1.0, .pull = pull, .sinkage = std::nullopt, .raises = raises});
    contributions.places().set({2 * column++, 0}, raises ? static_cast<float>(pull) : -INFINITY);
  }
  contributions.refresh();
  return contributions;
}

TEST(ClassEvidence, OnePlaceTeachesNothingTwoHalfThreeAll) {
  EXPECT_EQ(taught({-0.2}, true).posterior().pull.value, 0.0);
  const double two = taught({-0.2, -0.2}, true).posterior().pull.value;
  const double three = taught({-0.2, -0.2, -0.2}, true).posterior().pull.value;
  // Closed form: prior n y / (n prior + variance) for equal variances; the weight of two places is 1/2
  EXPECT_NEAR(two, 0.5 * -0.2 * 2.0 / 3.0, 1e-5);
  EXPECT_NEAR(three, -0.2 * 3.0 / 4.0, 1e-5);
}

TEST(ClassEvidence, RisesOnlyAsFarAsThreePlacesReach) {
  EXPECT_LE(taught({0.2, 0.2}, true).posterior().pull.value, 0.0);
  EXPECT_NEAR(taught({0.2, 0.2, 0.01}, true).posterior().pull.value, 0.01, 1e-6);
  EXPECT_LE(taught({0.2, 0.2, 0.2, 0.2}, false).posterior().pull.value, 0.0) << "none may raise";
  EXPECT_EQ(taught({0.2, 0.2, 0.2, 0.2}, false).posterior().pull.std, 0.05);
}

// Property: two drives of 25 places each may raise the class only if their means differ by less than 3
// standard deviations of the difference, in either order of the drives. Closed form: the mean over n places
// has the variance q^2 p^2 / (n q^2 + p^2), with q = p = 0.05.
TEST(ClassEvidence, DrivesThatContradictEachOtherRaiseNothing) {
  const double apart =
      3.0 * std::sqrt(2.0) * 0.05 / std::sqrt(26.0) * 26.0 / 25.0;  // in the contributions of the places
  for (const double times : {0.0, 0.9, 1.1, 2.0})
    for (const double sign : {-1.0, 1.0}) {
      ClassEvidence contributions(sand());
      for (std::uint16_t drive = 1; drive <= 2; ++drive)
        for (int place = 0; place < 25; ++place) {
          const double pull = drive == 1 ? 0.0 : sign * times * apart;
          contributions.add(
              {.weight = 1.0, .pull = pull, .sinkage = std::nullopt, .raises = true, .drive = drive});
          contributions.places().set({2 * place, 2 * drive}, static_cast<float>(pull));
        }
      contributions.refresh();
      EXPECT_EQ(contributions.mayRaise(), times < 1.0) << sign * times;
      EXPECT_EQ(contributions.state().may_raise, times < 1.0) << sign * times;
    }
}

// Property: evidence from unverified sensors never raises the class mean above the mean from verified
// evidence.
TEST(ClassEvidence, UnverifiedReadingsNeverRaise) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-0.2, 0.2);
  for (int world = 0; world < 200; ++world) {
    ClassEvidence contributions = taught({any(random), any(random), any(random), any(random)}, true);
    const double alone = contributions.posterior().pull.value;
    for (int i = 0; i < 10; ++i) {
      contributions.add({.weight = 1.0, .pull = any(random), .sinkage = std::nullopt, .raises = false});
      contributions.refresh();
      EXPECT_LE(contributions.posterior().pull.value, alone);
    }
  }
}

// Property: a drive with unverified sensors never raises the mean, changes the standard deviation or reduces
// the sinkage, with and without verified evidence, and with a second unverified drive.
TEST(ClassEvidence, UnverifiedDrivesNeverRaise) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(-0.2, 0.2), deep(0.0, 0.2);
  for (int world = 0; world < 500; ++world) {
    ClassEvidence contributions(sand());
    for (int column = 0; column < 8; ++column)
      contributions.places().set({2 * column, 0}, world % 2 == 0 ? 0.1F : -INFINITY);
    for (int i = 0; world % 2 == 0 && i < 6; ++i)
      contributions.add({.weight = 1.0,
                         .pull = any(random),
                         .sinkage = any(random),
                         .raises = true,
                         .sinkage_raises = true,
                         .drive = 1});
    contributions.refresh();
    for (std::uint16_t drive = 2; drive < 8; ++drive) {
      const ClassState before = contributions.state();
      const double of_drive = any(random), deeper = deep(random);
      for (int i = 0; i < 1 + world % 7; ++i)
        contributions.add({.weight = 0.5,
                           .pull = std::min(of_drive + 0.1 * any(random), 0.0),
                           .sinkage = deeper,
                           .raises = false,
                           .drive = drive});
      contributions.refresh();
      const ClassState after = contributions.state();
      EXPECT_LE(after.pull, before.pull + 1e-12);
      EXPECT_EQ(after.pull_std, before.pull_std);
      EXPECT_EQ(after.own_std, before.own_std);
      EXPECT_EQ(after.shared, before.shared);
      EXPECT_GE(after.sinkage, before.sinkage - 1e-12);
      EXPECT_EQ(after.may_raise, before.may_raise);
      EXPECT_LE(after.most_rise, before.most_rise);
    }
  }
}

// Closed form: the mean is the minimum over sets of drives of q^2 sum(h y)/(q^2 sum(h) + p^2). For -0.10, 0
// and -0.08 at one place each, the minimum is that of the set {-0.10, -0.08}.
TEST(ClassEvidence, MeanIsTheMinimumOverSetsOfDrives) {
  ClassEvidence contributions(sand());
  for (int column = 0; column < 8; ++column) contributions.places().set({2 * column, 0}, -INFINITY);
  const double of_drive[] = {-0.10, 0.0, -0.08};
  for (std::uint16_t drive = 1; drive <= 3; ++drive)
    contributions.add({.weight = 1.0, .pull = of_drive[drive - 1], .sinkage = std::nullopt, .drive = drive});
  contributions.refresh();
  EXPECT_NEAR(contributions.posterior().pull.value, -0.18 / 3.0, 1e-5);
}

// Closed form: with two drives the mean is at most the value of the weaker drive, q^2 W y/(q^2 W + p^2), with
// the standard deviation q/sqrt(1 + q^2 W/p^2) of that drive and W = 40 contributions. The result is
// bit-identical in either order, and after a drive is added and removed again.
TEST(ClassEvidence, NoDriveLiftsWhatAnotherShows) {
  const auto lessonOf = [](std::uint16_t drive) {
    return BlockContribution{.weight = 1.0,
                             .pull = drive == 1 ? -0.08 : 0.02,
                             .sinkage = std::nullopt,
                             .raises = true,
                             .drive = drive};
  };
  ClassEvidence one(sand()), other(sand());
  for (int column = 0; column < 8; ++column)
    for (ClassEvidence* contributions : {&one, &other}) contributions->places().set({2 * column, 0}, 0.1F);
  for (int i = 0; i < 40; ++i) {
    one.add(lessonOf(1));
    other.add(lessonOf(2));
  }
  one.refresh();
  const ClassState alone = one.state();
  EXPECT_NEAR(alone.pull, -0.08 * 40.0 / 41.0, 1e-5);
  for (int i = 0; i < 40; ++i) {
    one.add(lessonOf(2));
    other.add(lessonOf(1));
  }
  one.refresh();
  other.refresh();
  EXPECT_NEAR(one.posterior().pull.value, -0.08 * 40.0 / 41.0 + 0.05 / std::sqrt(41.0), 1e-5);
  EXPECT_EQ(one.state(), other.state());
  for (int i = 0; i < 40; ++i) one.remove(lessonOf(2));
  one.refresh();
  EXPECT_EQ(one.state(), alone);
}

// Property: each number is rounded conservatively by less than a step and not beyond the prior; numbers
// without evidence are unchanged.
TEST(ClassEvidence, StepsErrTowardsDanger) {
  EXPECT_EQ(ClassEvidence(sand()).stateInSteps().pull, 0.0);
  EXPECT_EQ(ClassEvidence(sand()).stateInSteps().pull_std, 0.05);
  for (int i = 0; i < 200; ++i) {
    const double y = -0.2 + 0.0021 * i;
    const ClassEvidence contributions = taught({y, y + 0.013, y - 0.007, y}, i % 3 > 0);
    const ClassState exact = contributions.state(), steps = contributions.stateInSteps();
    EXPECT_LE(steps.pull, exact.pull + 1e-8);
    EXPECT_GT(steps.pull, exact.pull - steps.pull_step);
    EXPECT_GE(steps.pull_std, exact.pull_std - 1e-8);
    EXPECT_LE(steps.pull_std, 0.05);
    EXPECT_GE(steps.own_std, exact.own_std - 1e-8);
    EXPECT_GE(steps.shared, exact.shared - 1e-8);
    EXPECT_GE(steps.sinkage, exact.sinkage - 1e-7);
    EXPECT_LT(steps.sinkage, exact.sinkage + steps.sinkage_step);
    EXPECT_LE(steps.most_rise, exact.most_rise + 3e-8);
    EXPECT_GT(steps.most_rise, exact.most_rise - 0.02);
    EXPECT_EQ(steps.may_raise, exact.may_raise);
    EXPECT_EQ(exact.pull_step, 0.0);
  }
}

// Property: removing a contribution restores the previous state to the bit.
TEST(ClassEvidence, ForgetsToTheBit) {
  ClassEvidence contributions = taught({-0.1, -0.05, -0.07}, true);
  const ClassPosterior before = contributions.posterior();
  const BlockContribution contribution{.weight = 0.37, .pull = -0.123, .sinkage = 0.2, .raises = true};
  contributions.add(contribution);
  contributions.refresh();
  EXPECT_NE(contributions.posterior().pull.value, before.pull.value);
  contributions.remove(contribution);
  contributions.refresh();
  EXPECT_EQ(contributions.posterior().pull.value, before.pull.value);
  EXPECT_EQ(contributions.posterior().pull.std, before.pull.std);
}

}  // namespace class_evidence_test
}  // namespace talus::costmap
