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

/// What came of one errand.
struct Result {
  std::uint64_t number = 0;
  std::string kind, rover, planner;
  bool learned = false;
  int exit = 0;  ///< of the program: 0 a route, 1 none, 2 start or goal refused
  double length_m = 0.0;
  double risk = 0.0;        ///< printed
  double drawn_risk = 0.0;  ///< by the checker; 0: too few worlds were weak to tell
  std::vector<Violation> violations;
};

/// Errands by number: number / routesPerSite() is the site. The results are appended to a file as they come,
/// a line each; numbers that it holds are left out, so that a campaign that was stopped goes on.
class Campaign {
 public:
  Campaign(Places places, std::string results) : places_(std::move(places)), results_(std::move(results)) {}

  static std::uint64_t routesPerSite() { return kPairs * planners().size(); }

  /// Runs the errands first .. first + count - 1 that the file does not hold. Sites that fail are named in
  /// `report` and left out.
  void run(std::uint64_t first, std::uint64_t count, const std::function<void(const std::string&)>& report);

  /// Errands of a run() that have no result: their site failed.
  std::uint64_t missing(std::uint64_t first, std::uint64_t count) const;

  /// All results of the file.
  std::vector<Result> results() const;

 private:
  Result judged(const ProvingGround& ground, const Belief& belief, std::uint64_t number);

  Places places_;
  std::string results_;
};

/// Errands, routes and violations by cause, with the first number of each cause.
std::string table(const std::vector<Result>& results);

}  // namespace safety
