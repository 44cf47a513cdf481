// Time per sample of the recursive estimators; goal: 10 us.
// Measures adding one sample and computing the estimate.
#include <benchmark/benchmark.h>
#include <thesis_runs.hpp>

#include <talus/terramech/strength/shear_modulus.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {
namespace {

const std::vector<WheelSample>& samples() {
  static const std::vector<WheelSample> all = ThesisRuns(4).next({.noise = 0.05, .samples = 240}).samples;
  return all;
}

void known(benchmark::State& state, PairOf pair) {
  std::size_t k = 0;
  MohrCoulombLine line;
  line.add(pair(kThesisWheel, samples()[0], 0.02));
  for (auto _ : state) {
    k = (k + 1) % samples().size();
    line.add(pair(kThesisWheel, samples()[k], 0.02));
    benchmark::DoNotOptimize(line.estimate());
  }
}
BENCHMARK_CAPTURE(known, linear_offset, linearOffsetPair);
BENCHMARK_CAPTURE(known, iagnemma, iagnemmaPair);

void ladder(benchmark::State& state, ModulusCriterion criterion) {
  std::size_t k = 0;
  ShearModulusGrid rungs(kThesisWheel, {.criterion = criterion});
  for (; k < 4; ++k) rungs.add(samples()[k]);
  for (auto _ : state) {
    k = (k + 1) % samples().size();
    rungs.add(samples()[k]);
    benchmark::DoNotOptimize(rungs.modulus());
    benchmark::DoNotOptimize(rungs.strength());
  }
}
BENCHMARK_CAPTURE(ladder, joint, ModulusCriterion::Joint);
BENCHMARK_CAPTURE(ladder, error_minimisation, ModulusCriterion::ErrorMinimisation);
BENCHMARK_CAPTURE(ladder, torque_ratio, ModulusCriterion::TorqueRatio);
BENCHMARK_CAPTURE(ladder, effective_torque_as_printed, ModulusCriterion::EffectiveTorque);

}  // namespace
}  // namespace talus::terramech
