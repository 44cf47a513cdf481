#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

/// Wheel data from synthetic worlds with hidden effects, and a judge of the result of a trace. Independent
/// of the library: own stress integrals (midpoint rule, bisection), own formulas and own random numbers;
/// neither side includes the other.
namespace talus::blind {

/// True parameters of a soil, in SI units.
struct Ground {
  double cohesion, phi, n, k, shear_k, c1, c2, density;
};

/// One hidden effect.
struct Hidden {
  std::string kind;    ///< "slip_sinkage_ding", ..., or "form:..." for forms outside the library
  std::string family;  ///< family of the library form; "empirical" for other forms
  std::vector<std::string> covariates;  ///< columns accepted as a correct result
  std::vector<std::string> channels;    ///< scaled channels accepted as a correct result
  double size = 0.0;                    ///< main parameter of the effect
};

/// A table of measurements, and the true effects behind it.
struct World {
  std::uint64_t seed = 0;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  ///< training rows, noisy
  std::vector<std::vector<double>>
      held;  ///< held-out rows under conditions that also occur in training, noisy
  std::vector<double> floor_pull,
      floor_z;                    ///< noise-free value minus measured value of held-out rows: the
                                  ///< unpredictable error
  std::vector<int> run;           ///< run number of each training row; empty: no runs
  std::vector<std::string> site;  ///< site of each training row; empty: not recorded
  std::vector<Hidden> hidden;
  Ground ground{};
  double noise = 0.03;

  std::string csv(bool held_rows) const;
  std::string yaml() const;  ///< the base soil, without effects
};

/// A random source whose numbers are the same on every platform.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed * 0x9E3779B97F4A7C15ULL + 77) {}
  double uniform(double a, double b) {
    return a + (b - a) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  double normal() {
    return std::sqrt(-2.0 * std::log(uniform(1e-12, 1.0))) * std::cos(6.28318530717958 * uniform(0.0, 1.0));
  }
  int below(int n) { return static_cast<int>(uniform(0.0, n * (1.0 - 1e-12))); }

 private:
  std::mt19937_64 engine_;
};

/// Specification of a world.
struct WorldPlan {
  std::uint64_t seed = 1;
  int effects = 1;      ///< 0, 1 or 2
  bool library = true;  ///< forms of the library, or other forms
  /// 12 to 25 runs with fixed wheel, load, speed, pass and slope; replaces `wide`
  bool campaign = false;
  bool wide =
      false;  ///< many kinds of designs and noise: one slip level, a rim speed tied to slip, runs with
              ///< different offsets, columns without an effect, drifting or heavy-tailed noise
  double scatter = 0.0;  ///< relative standard deviation of tan phi and c between runs
  /// Cases that cannot be resolved: "tied", the column of each effect is correlated with another; "few",
  /// eight rows; "patch", the last third of the runs is on another soil, not recorded.
  std::string unresolvable{};
  bool product = false;  ///< the only effect is a product of two columns
  bool sites =
      false;  ///< runs at three sites, the soil of the third weaker by a fifth and softer by two fifths
};
World makeWorld(const WorldPlan& plan);

/// One result of a trace: effect, covariate and channel.
struct Claim {
  std::string name, covariate, channel;
};

/// Score of one world.
struct Marks {
  int hidden = 0, claimed = 0;
  int located = 0;  ///< hidden effects with correct covariate and channel
  int family = 0;   ///< hidden effects with correct family as well (curves: "empirical")
};
Marks judge(const World& world, const std::vector<Claim>& claims);

}  // namespace talus::blind
