#include <cmath>
#include <random>
#include <stdexcept>

#include <Eigen/LU>
#include <refused.hpp>

#include <talus/terramech/strength/strength_lines.hpp>

#include "linear_world.hpp"

namespace talus::terramech {

namespace strength_lines_test {

std::vector<StressPair> noisyLine(int count, double spread) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<StressPair> pairs;
  for (int i = 0; i < count; ++i) {
    const double x = 15000.0 * (1.0 + spread * normal(random));
    pairs.push_back({.normal_Pa = x, .shear_Pa = 2000.0 + 0.6 * x + 100.0 * normal(random)});
  }
  return pairs;
}

ShearStrength fitOf(const std::vector<StressPair>& pairs) {
  MohrCoulombLine line;
  for (const StressPair& p : pairs) line.add(p);
  return line.estimate();
}

TEST(MohrCoulombLine, RecursionEqualsTheBatchNormalEquations) {
  // Closed form: Eqs. 2.16 / B.10, (K1' K1)^-1 K1' K2, and s^2 (K1' K1)^-1.
  const auto pairs = noisyLine(40, 0.2);
  Eigen::MatrixX2d k1(pairs.size(), 2);
  Eigen::VectorXd k2(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    k1.row(static_cast<Eigen::Index>(i)) << 1.0, pairs[i].normal_Pa;
    k2[static_cast<Eigen::Index>(i)] = pairs[i].shear_Pa;
  }
  const Eigen::Matrix2d inverse = (k1.transpose() * k1).inverse();
  const Eigen::Vector2d solution = inverse * (k1.transpose() * k2);
  const double variance = (k2 - k1 * solution).squaredNorm() / (static_cast<double>(pairs.size()) - 2.0);
  const ShearStrength fit = fitOf(pairs);
  // Tolerance: the normal equations lose about half the digits, 1e-8 relative.
  EXPECT_NEAR(fit.cohesion_Pa, solution[0], 1e-8 * std::abs(solution[0]));
  EXPECT_NEAR(fit.tan_friction, solution[1], 1e-8);
  EXPECT_LT((fit.covariance - variance * inverse).norm(), 1e-8 * fit.covariance.norm());
  EXPECT_TRUE(fit.unseen.empty());
}

TEST(MohrCoulombLine, CovarianceIsCalibrated) {
  // Property: over repeated noise the error, scaled by its standard deviation, has unit variance (400
  // repeats: +- 10 %).
  double square_c = 0.0;
  double square_t = 0.0;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  constexpr int kRepeats = 400;
  for (int k = 0; k < kRepeats; ++k) {
    MohrCoulombLine line;
    for (int i = 0; i < 30; ++i) {
      const double x = 10000.0 + 300.0 * i;
      line.add({.normal_Pa = x, .shear_Pa = 1000.0 + 0.5 * x + 200.0 * normal(random)});
    }
    const ShearStrength fit = line.estimate();
    square_c += std::pow(fit.cohesion_Pa - 1000.0, 2) / fit.covariance(0, 0);
    square_t += std::pow(fit.tan_friction - 0.5, 2) / fit.covariance(1, 1);
  }
  // The ratio follows Student's t with 28 degrees of freedom, whose variance is 28/26.
  EXPECT_NEAR(square_c / kRepeats, 28.0 / 26.0, 0.2);
  EXPECT_NEAR(square_t / kRepeats, 28.0 / 26.0, 0.2);
}

TEST(MohrCoulombLine, WeightTwoEqualsARepeatedSample) {
  // Property: a sample of weight 2 equals two samples.
  MohrCoulombLine weighted;
  MohrCoulombLine repeated;
  for (const StressPair& p : noisyLine(10, 0.1)) {
    weighted.add(p, 2.0);
    repeated.add(p);
    repeated.add(p);
  }
  EXPECT_NEAR(weighted.estimate().cohesion_Pa, repeated.estimate().cohesion_Pa, 1e-6);
  EXPECT_NEAR(weighted.estimate().condition, repeated.estimate().condition, 1e-6);
}

TEST(MohrCoulombLine, ConditionIsThatOfTheScaledMatrix) {
  // Closed form: singular values of [1, x] with unit columns.
  const auto pairs = noisyLine(20, 0.1);
  Eigen::MatrixX2d k1(pairs.size(), 2);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    k1.row(static_cast<Eigen::Index>(i)) << 1.0, pairs[i].normal_Pa;
  }
  k1.col(0).normalize();
  k1.col(1).normalize();
  const double q = k1.col(0).dot(k1.col(1));
  EXPECT_NEAR(fitOf(pairs).condition, std::sqrt((1.0 + q) / (1.0 - q)), 1e-6);
}

TEST(MohrCoulombLine, SimilarSamplesLeaveFrictionAndCohesionUnidentifiable) {
  const ShearStrength fit = fitOf(noisyLine(10, 0.001));
  ASSERT_EQ(fit.unseen.size(), 2u);
  EXPECT_THAT(fit.unseen[0], testing::StartsWith("friction_angle_rad: "));
  EXPECT_THAT(fit.unseen[1], testing::StartsWith("cohesion_Pa: "));
}

TEST(MohrCoulombLine, SingleSampleAndEqualStressesAreRejected) {
  MohrCoulombLine line;
  line.add({.normal_Pa = 1e4, .shear_Pa = 6e3});
  EXPECT_REFUSED(line.estimate(), std::domain_error, "at least two samples are required, got 1");
  line.add({.normal_Pa = 1e4, .shear_Pa = 7e3});
  EXPECT_REFUSED(line.estimate(), std::domain_error, "all samples have the same normal stress");
}

const Wheel kWheel{.radius_m = 0.12, .width_m = 0.09};

ShearStrength estimated(const LinearWorld& world) {
  MohrCoulombLine line;
  for (const WheelSample& s : linearSamples(kWheel, world))
    line.add(iagnemmaPair(kWheel, s, world.shear_modulus_m));
  return line.estimate();
}

TEST(Iagnemma, IsExactIfShearVanishesAtTheBottom) {
  // Property: exact under the method's own assumption, Eq. B.2.
  const ShearStrength fit = estimated({.cohesion_Pa = 1000.0, .tan_friction = 0.6, .offset = false});
  EXPECT_NEAR(fit.cohesion_Pa, 1000.0, 1.0);
  EXPECT_NEAR(fit.tan_friction, 0.6, 1e-4);
}

TEST(Iagnemma, OverestimatesCohesionIfShearActsAtTheBottom) {
  // Property: in a world with shear at the bottom the method overestimates cohesion, the reason for the
  // linear-offset method (thesis Fig. 2.3).
  EXPECT_GT(estimated({.cohesion_Pa = 6000.0, .tan_friction = 0.4}).cohesion_Pa, 7500.0);
}

TEST(Iagnemma, BrakedWheelIsRejected) {
  EXPECT_REFUSED(iagnemmaPair(kWheel, {.load_N = 80, .torque_Nm = -1, .sinkage_m = 0.01, .slip = -0.4}, 0.02),
                 std::domain_error, "no shear mobilised at theta_m; it needs a driven, slipping wheel");
}

TEST(Sojourner, UniformStressesOverTheChordRecoverTheSoil) {
  // Closed form: W = sigma A, T = r A (c + sigma tan phi) with A = 2 b r sin(theta_1).
  const Wheel wheel{.radius_m = 0.065, .width_m = 0.08};
  MohrCoulombLine line;
  for (const double sigma : {3000.0, 5000.0, 9000.0}) {
    const double z = 0.01;
    const double area = wheel.width_m * 2.0 * wheel.radius_m * std::sin(std::acos(1.0 - z / wheel.radius_m));
    line.add(sojournerPair(wheel, {.load_N = sigma * area,
                                   .torque_Nm = wheel.radius_m * area * (500.0 + 0.7 * sigma),
                                   .sinkage_m = z,
                                   .slip = 1.0}));
  }
  EXPECT_NEAR(line.estimate().cohesion_Pa, 500.0, 1e-9);
  EXPECT_NEAR(line.estimate().tan_friction, 0.7, 1e-12);
}

}  // namespace strength_lines_test

namespace linear_offset_test {

const Wheel kWheel{.radius_m = 0.1, .width_m = 0.08};

TEST(LinearOffset, WholeEquationIsExactForLinearStresses) {
  // Property: Eq. 2.9 follows from Eqs. 2.1 to 2.8 without further approximation (only with 2.3 corrected).
  const LinearWorld world{.cohesion_Pa = 5000.0, .tan_friction = 0.45};
  for (const WheelSample& s : linearSamples(kWheel, world)) {
    const LinearOffsetCoefficients m = linearOffset(kWheel, s, world.shear_modulus_m);
    const double left = m.m1 * 5000.0 * 0.45 + 5000.0 + m.m3_Pa * 0.45;
    EXPECT_NEAR(left, m.m4_Pa, 1e-5 * m.m4_Pa);  // tolerance: midpoint rule of the samples
  }
}

TEST(LinearOffset, StressesAreRecoveredFromLoadAndTorque) {
  // Property: the estimated stresses equal those of the world.
  const LinearWorld world;
  const WheelSample s = sampleOf(kWheel, world, {.sinkage_m = 0.02, .slip = 0.5});
  const ShearSoil soil{.cohesion_Pa = world.cohesion_Pa, .shear_modulus_m = world.shear_modulus_m};
  const LinearOffsetStresses stress = linearOffsetStresses(kWheel, s, soil);
  EXPECT_NEAR(stress.sigma_m_Pa, world.sigma_m_Pa, 1e-5 * world.sigma_m_Pa);
  const double a = mobilisation(kWheel, s, world.shear_modulus_m).peak;
  EXPECT_NEAR(stress.tau_m_Pa, (world.cohesion_Pa + world.sigma_m_Pa * world.tan_friction) * a, 0.5);
}

TEST(LinearOffset, M1MatchesItsSmallAngleLimit) {
  // Closed form: M1 ~ (theta_1/6) B / (1 + B/2A) > 0 at small contact.
  const WheelSample s{.load_N = 10.0, .torque_Nm = 0.2, .sinkage_m = 1e-6, .slip = 0.5};
  const auto [a, b] = mobilisation(kWheel, s, 1e-4);
  const double theta_1 = entryAngle_rad(kWheel, s.sinkage_m);
  EXPECT_NEAR(linearOffset(kWheel, s, 1e-4).m1 / (theta_1 / 6.0 * b / (1.0 + b / (2.0 * a))), 1.0, 1e-5);
}

TEST(LinearOffset, WheelWithoutMobilisedShearIsRejected) {
  EXPECT_REFUSED(linearOffset(kWheel, {.load_N = 80, .torque_Nm = 1, .sinkage_m = 0.01, .slip = -0.5}, 0.02),
                 std::domain_error, "no shear mobilised at theta_m; it needs a driven, slipping wheel");
  EXPECT_REFUSED(linearOffset(kWheel, {.load_N = 80, .torque_Nm = 1, .sinkage_m = 0.0, .slip = 0.5}, 0.02),
                 std::invalid_argument, "sinkage_m = 0, must be > 0");
}

}  // namespace linear_offset_test

}  // namespace talus::terramech
