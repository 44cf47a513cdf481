#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "judge.hpp"
#include "proving_ground.hpp"

namespace safety {

/// Result of one errand.
struct Result {
  std::uint64_t number = 0;
  std::string kind, rover, planner;
  bool learned = false;
  int exit = 0;  ///< exit code of the program: 0 route, 1 no route, 2 start or goal refused
  double length_m = 0.0;
  double risk = 0.0;  ///< immobilisation risk that the program printed
  double drawn_risk =
      0.0;  ///< immobilisation risk drawn by the checker; 0: too few weak worlds for an estimate
  std::vector<Violation> violations;
};

/// Judges errands by number; number / routesPerSite() is the site. Each result is appended to a file as one
/// line. Numbers already in the file are skipped, so that a stopped campaign can be resumed.
class Campaign {
 public:
  Campaign(Places places, std::string results) : places_(std::move(places)), results_(std::move(results)) {}

  static std::uint64_t routesPerSite() { return kPairs * planners().size(); }

  /// Runs the errands first .. first + count - 1 that are missing in the file. Reports and skips sites that
  /// fail.
  void run(std::uint64_t first, std::uint64_t count, const std::function<void(const std::string&)>& report);

  /// Number of errands of a run() without a result, because their site failed.
  std::uint64_t missing(std::uint64_t first, std::uint64_t count) const;

  /// All results of the file.
  std::vector<Result> results() const;

 private:
  Result judged(const ProvingGround& ground, const Belief& belief, std::uint64_t number);

  Places places_;
  std::string results_;
};

/// Table of errands, routes and violations by cause, with the first errand number of each cause.
std::string table(const std::vector<Result>& results);

}  // namespace safety
