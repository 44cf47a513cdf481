#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

/// Wheel data from made-up worlds with effects that nobody declares, and a judge of what a tracer says of
/// them. Independent of the library on purpose: own stress integrals (plain midpoint rule, bisection), own
/// formulas, own random numbers; neither includes anything of it.
namespace talus::blind {

/// A true soil, SI.
struct Ground {
  double cohesion, phi, n, k, shear_k, c1, c2, density;
};

/// One hidden effect.
struct Hidden {
  std::string kind;    ///< "slip_sinkage_ding", ..., or "form:..." for forms that no library holds
  std::string family;  ///< that a library form belongs to; "empirical" for other forms
  std::vector<std::string> covariates;  ///< columns that a right answer may name
  std::vector<std::string> channels;    ///< scaled channels that a right answer may name
  double size = 0.0;                    ///< the main number of the effect
};

/// A table with answers, and the truth behind it.
struct World {
  std::uint64_t seed = 0;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  ///< training rows, noisy
  std::vector<std::vector<double>> held;  ///< rows of conditions that training has too, noisy
  std::vector<double> floor_pull,
      floor_z;                    ///< noise-free truth less measured of held rows: what nobody can predict
  std::vector<int> run;           ///< number of the run of each training row; empty: there are no runs
  std::vector<std::string> site;  ///< of each training row; empty: they are not recorded
  std::vector<Hidden> hidden;
  Ground ground{};
  double noise = 0.03;

  std::string csv(bool held_rows) const;
  std::string yaml() const;  ///< the base soil, without effects
};

/// An independent random source, the same everywhere.
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

/// What to make.
struct WorldPlan {
  std::uint64_t seed = 1;
  int effects = 1;      ///< 0, 1 or 2
  bool library = true;  ///< forms that the literature names, or others
  /// 12 to 25 runs whose wheel, load, speed, pass and slope are fixed within the run; in place of wide
  bool campaign = false;
  bool wide =
      false;  ///< designs and noise of many kinds: one slip level, a rim speed tied to slip, runs with
              ///< offsets of their own, columns that mean nothing, drifting or heavy-tailed noise
  double scatter = 0.0;  ///< standard deviation by which tan phi and c differ from run to run, relative
  /// What nobody can tell: "tied", the column of each effect goes with another; "few", eight rows; "patch", the last third
  /// of the runs on another soil, not recorded.
  std::string untold{};
  bool product = false;  ///< in place of other effects: a product of two columns
  bool sites =
      false;  ///< runs at three sites, the soil of the third weaker by a fifth and softer by two fifths
};
World makeWorld(const WorldPlan& plan);

/// What a tracer said, reduced to words.
struct Claim {
  std::string name, covariate, channel;
};

/// Points of one world.
struct Marks {
  int hidden = 0, claimed = 0;
  int located = 0;  ///< hidden effects with covariate and channel right
  int family = 0;   ///< hidden effects with their family named too (curves: called empirical)
};
Marks judge(const World& world, const std::vector<Claim>& claims);

}  // namespace talus::blind
