// Strength that one drive teaches of soils drawn from the prior of a class, by the fault of its slip sensor, with one
// slip and with two: learned_strength SOIL ROVER DRIVES. 160 m over waves, sensor noise 0.01, second slip 0.02.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/telemetry/drive_posterior.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace {

using namespace talus;
using namespace talus::costmap;

GroundModel modelOf(const terramech::Rover& rover, const GroundClass& ground) {
  return GroundModel({.rover = rover, .classes = {ground}, .policy = {}});
}

// A soil of the class: each parameter within two deviations.
GroundClass drawn(GroundClass ground, const terramech::SoilDeviation& std, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto draw = [&](double& value, double deviation) {
    value = std::max(value + deviation * std::clamp(normal(random), -2.0, 2.0), 0.3 * value);
  };
  draw(ground.soil.cohesion_Pa, std.cohesion_Pa);
  draw(ground.soil.friction_angle_rad, std.friction_angle_rad);
  draw(ground.soil.sinkage_exponent, std.sinkage_exponent);
  draw(ground.soil.frictional_modulus, std.frictional_modulus);
  draw(ground.soil.shear_modulus_m, std.shear_modulus_m);
  draw(ground.soil.rut_stiffness, std.rut_stiffness);
  return ground;
}

// Mean slip of all wheels on a gradient, the first axle on fresh ground; at most 0.9.
class Slip {
 public:
  explicit Slip(const GroundModel& ground) {
    const int axles = ground.rover().wheel_count / 2;
    for (int i = 0; i <= kSteps; ++i) {
      const SteadyWheel fresh = ground.steady(0, {.slip = at(i)}),
                        rut = ground.steady(0, {.slip = at(i), .in_rut = true});
      pull_.push_back((fresh.drawbar_pull_over_load + (axles - 1) * rut.drawbar_pull_over_load) / axles);
    }
  }
  double on(double gradient) const {
    const auto reached = std::ranges::find_if(pull_, [&](double pull) { return pull >= gradient; });
    return at(static_cast<int>(reached - pull_.begin()));
  }

 private:
  static constexpr int kSteps = 1400;
  static double at(int i) { return std::min(-0.5 + 0.001 * i, 0.9); }
  std::vector<double> pull_;
};

// Reading of the slip sensor for a slip, the slip of the class, the gradient and the number of the moment.
using Read = std::function<double(double slip, double of_class, double gradient, int moment)>;

DriveEstimate drive(const GroundModel& of_class, const GroundModel& truth, const Read& read, bool twice,
                    std::mt19937_64& random) {
  std::normal_distribution<double> noise;
  DrivePosterior posterior(of_class);
  const Slip of_truth(truth), of_prior(of_class);
  const int wheels = truth.rover().wheel_count;
  const double phase = 3.0 * noise(random);
  for (int i = 0; i < 400; ++i) {
    const double x_m = 0.4 * i,
                 gradient = 0.13 * std::sin(0.35 * x_m + phase) + 0.09 * std::sin(0.11 * x_m + 1.0),
                 slip = of_truth.on(gradient);
    if (slip > 0.7) continue;
    posterior.take(
        {.rutted = wheels - 2,
         .wheels = wheels,
         .place = {x_m, 0.0},
         .gradient = gradient + 0.005 * noise(random),
         .map_gradient = gradient,
         .slip = read(slip, of_prior.on(gradient), gradient, i) + 0.01 * noise(random),
         .second_slip = twice ? slip + 0.02 * noise(random) : std::numeric_limits<double>::quiet_NaN()});
  }
  return posterior.fitted();
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return std::fprintf(stderr, "learned_strength SOIL ROVER DRIVES\n"), 1;
  const terramech::Rover rover = terramech::loadRover(arguments[2]);
  const terramech::SoilPrior prior = terramech::loadSoilPrior(arguments[1]);
  const GroundClass ground = groundClass(1, prior, rover);
  const GroundModel of_class = modelOf(rover, ground);
  const std::pair<const char*, Read> sensors[] = {
      {"as it is", [](double slip, double, double, int) { return slip; }},
      {"+ 0.08", [](double slip, double, double, int) { return slip + 0.08; }},
      {"x 0.8", [](double slip, double, double, int) { return 0.8 * slip; }},
      {"x 0.5", [](double slip, double, double, int) { return 0.5 * slip; }},
      {"at most 0.15", [](double slip, double, double, int) { return std::min(slip, 0.15); }},
      {"uphill x 0.4", [](double slip, double, double g, int) { return g > 0.0 ? 0.4 * slip : slip; }},
      {"step of 0.08", [](double slip, double, double, int i) { return i > 200 ? slip + 0.08 : slip; }},
      {"of the class", [](double, double slip, double, int) { return slip; }}};
  std::printf("| slip | slips | bias | rms error | std | within one, two std |\n|---|---|---|---|---|---|\n");
  for (const auto& [name, read] : sensors)
    for (const bool twice : {false, true}) {
      double bias = 0.0, square = 0.0, std = 0.0, one = 0.0, two = 0.0;
      const int drives = std::atoi(arguments[3]);
      for (int i = 0; i < drives; ++i) {
        std::mt19937_64 random(1000U + static_cast<unsigned>(i));
        const GroundModel truth = modelOf(rover, drawn(ground, prior.deviation, random));
        const Estimate found = drive(of_class, truth, read, twice, random).classes[0].departure;
        const double off = found.value - truth.reference(0, false).drawbar_pull_over_load +
                           of_class.reference(0, false).drawbar_pull_over_load;
        bias += off / drives;
        square += off * off / drives;
        std += found.std / drives;
        one += std::abs(off) < found.std ? 1.0 / drives : 0.0;
        two += std::abs(off) < 2.0 * found.std ? 1.0 / drives : 0.0;
      }
      std::printf("| %s | %s | %+.3f | %.3f | %.3f | %.2f, %.2f |\n", name, twice ? "two" : "one", bias,
                  std::sqrt(square), std, one, two);
    }
}
