#pragma once

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>

/// The reference cases of the linear estimators, made by an independent implementation; only read by tests.
namespace talus::terramech {

/// All cases; empty when the folder in TALUS_REFERENCE is not given.
inline std::vector<nlohmann::json> estimatorCases() {
  const char* folder = std::getenv("TALUS_REFERENCE");
  if (folder == nullptr) return {};
  return nlohmann::json::parse(std::ifstream(std::string(folder) + "/estimator_cases.json"));
}

inline Wheel wheelOf(const nlohmann::json& c) {
  return {.radius_m = c["r_m"], .width_m = c["b_m"]};
}

inline std::vector<WheelSample> samplesOf(const nlohmann::json& c) {
  std::vector<WheelSample> samples;
  for (std::size_t i = 0; i < c["slip"].size(); ++i) {
    samples.push_back({.load_N = c["load_N"][i],
                       .torque_Nm = c["torque_Nm"][i],
                       .sinkage_m = c["sinkage_m"][i],
                       .slip = c["slip"][i]});
  }
  return samples;
}

}  // namespace talus::terramech

/// Skips the test, saying why, where there are no reference cases.
#define TALUS_REQUIRE_CASES(cases) \
  if ((cases).empty()) GTEST_SKIP() << "TALUS_REFERENCE is not set"
