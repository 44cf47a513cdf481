// Spatial inference on ground of known strength.
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include <talus/costmap/evidence/class_evidence.hpp>

namespace talus::costmap {
namespace spreading_truth_test {

constexpr Variation kVariation{.pull_std = 0.05, .sinkage_std = 0.1, .correlation_length_m = 5.0};

// A field that no kernel generated: 60 waves of random direction, phase and length around 10 m; standard
// deviation 0.05.
class Waves {
 public:
  explicit Waves(std::mt19937_64& random) {
    std::uniform_real_distribution<double> turn(0.0, 2.0 * std::numbers::pi);
    std::normal_distribution<double> length(10.0, 2.0);
    for (int i = 0; i < 60; ++i) {
      const double heading = turn(random), k = 2.0 * std::numbers::pi / std::max(length(random), 4.0);
      waves_.push_back({k * std::cos(heading), k * std::sin(heading), turn(random)});
    }
  }
  double at(const maps::Point& p) const {
    double sum = 0.0;
    for (const auto& [kx, ky, phase] : waves_) sum += std::cos(kx * p.x_m + ky * p.y_m + phase);
    return 0.05 * std::sqrt(2.0 / 60.0) * sum;
  }

 private:
  struct Wave {
    double kx, ky, phase;
  };
  std::vector<Wave> waves_;
};

struct Score {
  double squares = 0.0, surprise = 0.0;
  int within = 0, count = 0;

  void add(double truth, const Estimate& estimate) {
    const double z = (truth - estimate.value) / estimate.std;
    squares += (truth - estimate.value) * (truth - estimate.value);
    surprise += 0.5 * z * z + std::log(estimate.std);
    within += std::abs(z) < 1.0 ? 1 : 0;
    ++count;
  }
  double rms() const { return std::sqrt(squares / count); }
  double share() const { return static_cast<double>(within) / count; }
};

TEST(Spreading, GaussianProcessIsMoreAccurateThanThePriorAndCalibrated) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::uniform_real_distribution<double> place(0.0, 20.0);
  Score process, prior;
  for (int world = 0; world < 60; ++world) {
    const Waves truth(random);
    // A straight drive with a block every 1.25 m; estimates are evaluated at places up to the correlation
    // length beside the drive.
    std::vector<PlaceEvidence> drive;
    for (double x = 0.0; x <= 20.0; x += 1.25)
      drive.push_back({.place = {x, 0.0},
                       .pull = truth.at({x, 0.0}) + noise(random),
                       .sinkage = 0.0,
                       .variance = 0.0004});
    const GaussianProcess gaussian(drive, kVariation);
    for (int i = 0; i < 50; ++i) {
      const maps::Point p{place(random), 0.25 * (place(random) - 10.0)};
      process.add(truth.at(p), gaussian.learned(p).departure.pull);
      prior.add(truth.at(p), {0.0, kVariation.pull_std});
    }
  }
  std::printf("rms error: process %.4f, prior %.4f; truth within one std (0.683 is right): %.3f\n",
              process.rms(), prior.rms(), process.share());
  // Pinned: RMS error 0.0343, without the exclusion of negative weights 0.0335.
  EXPECT_LT(process.rms(), 0.0347);
  EXPECT_LT(process.rms(), prior.rms());
  EXPECT_LT(process.surprise, prior.surprise);
  EXPECT_NEAR(process.share(), 0.683, 0.1);  // Property: calibrated; tolerance for a field that does not
                                             // follow the kernel
}

// Compares the predicted probability of weak ground with the observed share of weak ground.
class Reliability {
 public:
  void add(const Estimate& said, double truth) {
    const double probability =
        0.5 * std::erfc((said.value - kWeak) / said.std / std::numbers::sqrt2);  // P(pull < kWeak)
    Bin& bin = bins_[std::min(static_cast<std::size_t>(probability * 5.0), std::size_t{4})];
    bin.said += probability;
    bin.were += truth < kWeak ? 1.0 : 0.0;
    bin.count += 1.0;
  }

  // Largest excess of the observed share above the predicted one, and below it. Predicting sound ground as
  // weak is the less harmful error.
  struct Tolerance {
    double above, below;
  };
  // Prints the table and expects each observed share within the tolerance.
  void expectWithin(const Tolerance& tolerance, const char* field) const {
    for (const Bin& bin : bins_) {
      const double said = bin.said / bin.count, were = bin.were / bin.count;
      std::printf("%-28s said %.3f, were %.3f of %.0f\n", field, said, were, bin.count);
      EXPECT_LE(were, said + tolerance.above) << field;
      EXPECT_GE(were, said - tolerance.below) << field;
    }
  }

 private:
  static constexpr double kWeak = -0.03;
  struct Bin {
    double said = 0.0, were = 0.0, count = 0.0;
  };
  std::array<Bin, 5> bins_{};
};

// Places of a straight drive, a block every 1.25 m.
std::vector<maps::Point> track() {
  std::vector<maps::Point> places;
  for (double x = 0.0; x <= 20.0; x += 1.25) places.push_back({x, 0.0});
  return places;
}

constexpr double kNoise = 0.02;

// Draws values at the places from the Gaussian process by the Cholesky factor of its covariance.
std::vector<double> drawnFrom(const std::vector<maps::Point>& places, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const std::size_t n = places.size();
  std::vector<double> l(n * n), values(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum =
          i == j ? 1.0 + 1e-9
                 : sparseKernel(std::hypot(places[i].x_m - places[j].x_m, places[i].y_m - places[j].y_m),
                                kVariation.correlation_length_m);
      for (std::size_t k = 0; k < j; ++k) sum -= l[i * n + k] * l[j * n + k];
      l[i * n + j] = i == j ? std::sqrt(sum) : sum / l[j * n + j];
    }
  std::vector<double> z(n);
  for (double& value : z) value = normal(random);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k <= i; ++k) values[i] += kVariation.pull_std * l[i * n + k] * z[k];
  return values;
}

TEST(Spreading, WeakPlaceProbabilitiesAreCalibrated) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, kNoise);
  std::uniform_real_distribution<double> along(0.0, 20.0), beside(-2.5, 2.5);
  Reliability own;
  for (int world = 0; world < 20000; ++world) {
    std::vector<maps::Point> places = track();
    places.push_back({along(random), beside(random)});
    const std::vector<double> truth = drawnFrom(places, random);
    std::vector<PlaceEvidence> drive;
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
      drive.push_back({places[i], truth[i] + noise(random), 0.0, kNoise * kNoise});
    own.add(GaussianProcess(drive, kVariation).learned(places.back()).departure.pull, truth.back());
  }
  // Property: on ground drawn from the assumed kernel the prediction is calibrated, and optimistic by at
  // most 0.02. The standard error of the smallest bin is 0.014.
  own.expectWithin({0.02, 0.05}, "ground of the kernel");
}

TEST(Spreading, WeakPlaceProbabilitiesAreConservativeForOtherCovariance) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, kNoise);
  std::uniform_real_distribution<double> along(0.0, 20.0), beside(-2.5, 2.5);
  Reliability waves, fitted;
  for (int world = 0; world < 200; ++world) {
    const Waves truth(random);
    std::vector<PlaceEvidence> drive;
    for (const maps::Point& p : track())
      drive.push_back({p, truth.at(p) + noise(random), 0.0, kNoise * kNoise});
    Variation longer = kVariation;
    longer.correlation_length_m = 7.5;
    const GaussianProcess process(drive, kVariation), matched(drive, longer);
    for (int i = 0; i < 50; ++i) {
      const maps::Point p{along(random), beside(random)};
      waves.add(process.learned(p).departure.pull, truth.at(p));
      fitted.add(matched.learned(p).departure.pull, truth.at(p));
    }
  }
  // The waves have the correlation J0(2 pi d/10 m), 0.47 at 2.5 m, where the kernel has 0.17. The
  // predictions are therefore too close to the mean, by up to 0.1. With a length of 7.5 m both correlations
  // agree at 2.5 m and the predictions are calibrated.
  waves.expectWithin({0.12, 0.12}, "waves, 5 m");
  fitted.expectWithin({0.02, 0.1}, "waves, 7.5 m");
}

}  // namespace spreading_truth_test
}  // namespace talus::costmap
