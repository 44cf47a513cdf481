// Each test puts one fault into an otherwise sound site and checks that the judge reports the fault.
#include "judge.hpp"

#include <cmath>
#include <limits>
#include <set>

#include "risk.hpp"

namespace safety {
namespace {

const Rover kMer{.mass_kg = 176,
                 .gravity_m_s2 = 3.71,
                 .wheel_radius_m = 0.125,
                 .wheel_width_m = 0.16,
                 .wheelbase_m = 1.22,
                 .track_m = 1.06,
                 .clearance_m = 0.29,
                 .centre_of_mass_height_m = 0.47,
                 .max_pitch_rad = 0.436,
                 .max_roll_rad = 0.436,
                 .max_torque_Nm = 45};

// A loam whose greatest pull up to slip 0.8 is 0.26 of this rover's load, and 0.148 at slip 0.5.
SoilPrior loam() {
  return {.mean = {.cohesion_Pa = 7445,
                   .friction_angle_rad = 0.4398,
                   .sinkage_exponent = 0.7,
                   .cohesive_modulus = 5270,
                   .frictional_modulus = 1515040}};
}
SoilPrior dust() {
  return {.mean = {.friction_angle_rad = 0.42,
                   .cohesive_modulus = 1400,
                   .frictional_modulus = 300000,
                   .shear_modulus_m = 0.015}};
}

// A site of 20 m by 20 m and class 1 that rises eastwards.
Site plain(double gradient = 0.0) {
  Site site{.rover = kMer};
  site.elevation_m = {.width = 40, .height = 40, .cell_m = 0.5, .values = {}};
  for (int row = 0; row < 40; ++row)
    for (int column = 0; column < 40; ++column)
      site.elevation_m.values.push_back(gradient * 0.5 * (column + 0.5));
  site.classes = site.elevation_m;
  site.classes->values.assign(1600, 1.0);
  site.kinds = {{1, groundKind(loam(), kMer)}, {2, groundKind(dust(), kMer)}};
  return site;
}

void setCells(Raster& raster, Cell first, Cell last, double value) {
  for (int row = first.row; row <= last.row; ++row)
    for (int column = first.column; column <= last.column; ++column)
      raster.values[static_cast<std::size_t>(row * raster.width + column)] = value;
}

Route line(Place from, Place to) {
  Route route;
  route.vertices = {from, to};
  route.elevation_m = {std::nan(""), std::nan("")};
  route.turn_rad = {0.0, 0.0};
  route.heading_rad = {0.0, 0.0};
  return route;
}

const Route kEast = line({5, 10.1}, {15, 10.1});

std::set<std::string> causes(const Site& site, const Route& route, const std::vector<JournalRow>& rows = {}) {
  const Belief belief(site, rows);
  std::set<std::string> found;
  for (const Violation& violation : Judge(site, belief).judge(route)) found.insert(violation.cause);
  return found;
}

// Journal rows of six wheels at one moment, with a slip on a gradient.
std::vector<JournalRow> moment(Place middle, double slip, double gradient, double time_s) {
  std::vector<JournalRow> rows;
  for (int w = 0; w < 6; ++w)
    rows.push_back({.source = "made",
                    .accepted = true,
                    .time_s = time_s,
                    .place = {middle.x_m + 0.6 * (w / 2 - 1), middle.y_m + (w % 2 ? 0.5 : -0.5)},
                    .load_N = kMer.wheelLoad_N(),
                    .slip = slip,
                    .torque_Nm = std::nan(""),
                    .sinkage_m = std::nan(""),
                    .gradient = gradient,
                    .pass = 1});
  return rows;
}

using Causes = std::set<std::string>;

TEST(SafetyJudge, SafeGroundHasNoFault) {
  EXPECT_EQ(causes(plain(), kEast), Causes{});
  EXPECT_EQ(causes(plain(0.1), kEast), Causes{});
}

TEST(SafetyJudge, SlopeBeyondTheDrawbarPullIsAFault) {
  EXPECT_TRUE(causes(plain(0.32), kEast).contains("pull"));
  EXPECT_TRUE(causes(plain(0.4), kEast).contains("category"));
}

const Route kNorth = line({10.1, 5}, {10.1, 15});

TEST(SafetyJudge, CrossSlopeBeyondTheSideForceIsAFault) {
  EXPECT_EQ(causes(plain(0.2), kNorth), Causes{});
  EXPECT_EQ(causes(plain(0.4), kNorth), Causes{"side force"});
  // Property: the side-force limit is the same for both sides and both directions of travel.
  EXPECT_EQ(causes(plain(-0.4), kNorth), Causes{"side force"});
  EXPECT_EQ(causes(plain(0.4), line({10.1, 15}, {10.1, 5})), Causes{"side force"});
  // Property: a slope is refused if evidence shows that the ground is weaker.
  std::vector<JournalRow> rows;
  for (int k = 0; k < 4; ++k)
    for (const JournalRow& row : moment({10.0, 10.1}, 0.5, 0.0, k)) rows.push_back(row);
  const double steep = 0.29;
  EXPECT_EQ(causes(plain(steep), kNorth), Causes{});
  EXPECT_TRUE(causes(plain(steep), kNorth, rows).contains("side force"));
}

// Closed form: the components of the weight on an inclined plane in three dimensions.
TEST(SafetyJudge, DemandEqualsTheWeightComponentsOnThePlane) {
  for (const double a : {-0.4, 0.0, 0.3})
    for (const double c : {-0.5, 0.0, 0.2}) {
      const double t = std::sqrt(1 + a * a), n = std::sqrt(1 + a * a + c * c);
      // With t = (1, 0, a)/|t| and n = (-a, -c, 1)/|n|, the z component of n x t is c/(|n| |t|).
      const double along = a / t, normal = 1 / n, across = std::abs(c) / (n * t);
      const Judge::Planar needed = Judge::demand({a, c});
      EXPECT_NEAR(needed.along, along / normal, 1e-12);
      EXPECT_NEAR(needed.across, across / normal, 1e-12);
    }
}

// Property: a state in equilibrium meets the demand, and ground weaker by the reserve is just in
// equilibrium.
TEST(SafetyJudge, ReserveIsTheTolerablePullDeficit) {
  const Site site = plain();
  const Belief belief(site, {});
  for (const Judge::Planar gradient : {Judge::Planar{0.15, 0.0}, Judge::Planar{0.1, 0.1},
                                       Judge::Planar{-0.1, 0.2}, Judge::Planar{0.0, -0.2}}) {
    const auto stand = *Judge(site, belief).wheels({{10, 10.1}, 0, 0, false}, gradient);
    const Judge::Planar needed = Judge::demand(gradient);
    const double reserve = Judge::reserve(stand, needed, 0.8);
    EXPECT_GT(reserve, 0.0);
    EXPECT_TRUE(Judge::hold(stand, needed, 0.8, reserve - 1e-3).holds);
    EXPECT_FALSE(Judge::hold(stand, needed, 0.8, reserve + 1e-3).holds);
    EXPECT_LE(reserve, Judge::mostPull(stand) - needed.along + 0.02);
  }
}

TEST(SafetyJudge, PitchAndRollLimitsAreDirectional) {
  EXPECT_TRUE(causes(plain(0.5), kEast).contains("pitch"));
  EXPECT_EQ(causes(plain(0.5), kNorth), (Causes{"roll", "side force"}));
}

TEST(SafetyJudge, NoDataAndLeavingTheMapAreFaults) {
  Site site = plain();
  setCells(site.elevation_m, {20, 20}, {20, 20}, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(causes(site, kEast).contains("unknown ground"));
  EXPECT_TRUE(causes(plain(), line({5, 10}, {25, 10})).contains("outside the map"));
}

TEST(SafetyJudge, RoverWidthIsChecked) {
  Site site = plain();
  // The line runs at y = 10.1. These cells begin 0.4 m to its left; the outer wheels reach 0.61 m.
  setCells(site.classes.value(), {20, 21}, {20, 21}, 9.0);
  EXPECT_EQ(causes(site, kEast), (Causes{"wheel on refused ground", "width over refused ground"}));
  EXPECT_EQ(causes(site, line({5, 9.85}, {15, 9.85})), Causes{});
}

TEST(SafetyJudge, KeepOutAreaIsAFault) {
  Site site = plain();
  site.keep_out = {{{10.0, 10.4}, {10.5, 10.4}, {10.2, 11.0}, {10.0, 10.4}}};
  EXPECT_TRUE(causes(site, kEast).contains("width over refused ground"));
}

TEST(SafetyJudge, TrapUnderHalfTheWheelsReducesPull) {
  // Dust lies under the left wheels alone, on a slope that is traversable on loam and not on dust.
  Site site = plain(0.17);
  setCells(site.classes.value(), {0, 21}, {39, 39}, 2.0);
  EXPECT_EQ(causes(plain(0.17), kEast), Causes{});
  EXPECT_TRUE(causes(site, kEast).contains("pull"));
}

TEST(SafetyJudge, EdgeUnderTheRoverIsAFault) {
  Site site = plain();
  for (int row = 0; row < 40; ++row) setCells(site.elevation_m, {20, row}, {39, row}, 0.8);
  EXPECT_TRUE(causes(site, kEast).contains("relief"));
}

// Property: the judge reports a vertical step of 0.32 m, above the clearance of 0.3 m, although the residual
// from the plane under the rover is below the relief limit.
TEST(SafetyJudge, VerticalStepHiddenByThePlaneIsAFault) {
  Site site = plain();
  site.rover.clearance_m = 0.3;
  for (int row = 0; row < 40; ++row) setCells(site.elevation_m, {20, row}, {39, row}, 0.32);
  EXPECT_TRUE(causes(site, kEast).contains("step"));
  EXPECT_FALSE(causes(site, kEast).contains("relief"));
  EXPECT_EQ(causes(plain(0.1), kEast), Causes{});
}

TEST(SafetyJudge, EvidenceOfWeakGroundIsAFault) {
  // Wheels slipped 0.5 on level ground, where loam pulls 0.15: the ground was weaker by that amount.
  std::vector<JournalRow> rows;
  for (int k = 0; k < 4; ++k)
    for (const JournalRow& row : moment({10.0, 10.1}, 0.5, 0.0, k)) rows.push_back(row);
  EXPECT_EQ(causes(plain(0.18), kEast), Causes{});
  EXPECT_TRUE(causes(plain(0.18), kEast, rows).contains("pull"));
  // Property: rejected rows that indicate danger count as well.
  for (JournalRow& row : rows) row.accepted = false;
  EXPECT_TRUE(causes(plain(0.18), kEast, rows).contains("pull"));
}

TEST(SafetyJudge, EvidenceOfOnePlaceDoesNotRaiseTheEstimate) {
  const Site site = plain(0.32);
  std::vector<JournalRow> rows;
  for (int k = 0; k < 20; ++k)
    for (JournalRow row : moment({10.0, 10.1}, 0.05, 0.3, k)) {
      row.place = {10.0, 10.1};
      rows.push_back(row);
    }
  EXPECT_TRUE(causes(site, kEast, rows).contains("pull"));
  EXPECT_LE(Belief(site, rows).at(1, {10.0, 10.1}).mean, 0.0);
}

TEST(SafetyBelief, SinglePlacePosteriorMatchesClosedForm) {
  const Site site = plain();
  const auto rows = moment({10.0, 10.0}, 0.5, 0.0, 1.0);
  std::vector<JournalRow> one(rows.begin(), rows.begin() + 1);
  one[0].place = {10.625, 10.625};  // the centre of a square
  const Departure here = Belief(site, one).at(1, one[0].place);
  const double prior = 0.05 * 0.05 + 0.05 * 0.05;
  const double seen = -site.kinds.at(1)->fresh.pull(0.5);
  const double slope = 0.5 * (site.kinds.at(1)->fresh.pull(0.53) - site.kinds.at(1)->fresh.pull(0.47));
  const double variance = 0.01 * 0.01 + 0.02 * 0.02 + slope * slope + 0.022 * 0.022;
  // Closed form: product of two Gaussians in one dimension.
  EXPECT_NEAR(here.mean, seen * prior / (prior + variance), 1e-9);
  EXPECT_NEAR(here.deviation, std::sqrt(prior * variance / (prior + variance)), 1e-9);
}

TEST(SafetyRisk, RiskIsBetweenIndependentAndFullyCorrelatedBounds) {
  // The gradient is 0.05 below the pull. The class has a standard deviation of 0.05 as a whole and 0.05
  // between places.
  const Site site = plain(0.21);
  const double reserve =
      Judge::mostPull(*Judge(site, Belief(site, {})).wheels({{10, 10.1}, 0, 0, false}, {0.21, 0.0}), 1.0) -
      0.21;
  ASSERT_GT(reserve, 0.0);
  const DrawnRisk risk = drawnRisk(site, Belief(site, {}), kEast, {.worlds = 20000, .entrapment = 1.0});
  // Closed form: the risk is at least that of one place and at most the sum over the 11 stations of the ten
  // metres.
  const double one = 0.5 * std::erfc(reserve / std::hypot(0.05, 0.05) / std::sqrt(2.0));
  EXPECT_GT(risk.immobilisation, one);
  EXPECT_LT(risk.immobilisation, 11.0 * one);
  EXPECT_LT(drawnRisk(plain(0.0), Belief(site, {}), kEast).immobilisation, 1e-3 * risk.immobilisation);
}

}  // namespace
}  // namespace safety
