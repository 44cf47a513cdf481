#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "judge.hpp"
#include "proving_ground.hpp"

namespace safety {

/// Names of the files that are damaged: elevation and classes in several formats, rocks, keep-out areas,
/// telemetry, journal, map, model, route, and the arrays of heights and classes that a C program patches
/// into a map.
const std::vector<std::string>& damagedFiles();

/// Returns the damaged bytes of a file and a short description of the damage. A part of the file is removed,
/// truncated, or overwritten by zeros, random bytes, one repeated byte or another part of the file. A part
/// is one byte, a few bytes, a sector of 512 bytes or a page of 4096 bytes.
std::pair<std::string, std::string> damaged(const std::string& bytes, std::mt19937_64& random);

/// Result for one damaged file.
struct DamageResult {
  std::uint64_t number = 0;
  std::string file, damage;
  int exit = 0;  ///< exit code of the last call: 0 route, 1 no route, 2 refused; 128 + signal
  std::vector<std::string> causes;  ///< causes by which a route is less safe than on the undamaged file
  std::string complaint;            ///< output of a call that is not a regular message of the program
};

/// Tries damaged files by number; number / kPerSite is the site. Results are appended to a file. Numbers
/// already in the file are skipped, so that a stopped campaign can be resumed.
class DamageCampaign {
 public:
  static constexpr std::uint64_t kPerSite = 100;

  DamageCampaign(Places places, std::string results)
      : places_(std::move(places)), results_(std::move(results)) {}

  void run(std::uint64_t first, std::uint64_t count, const std::function<void(const std::string&)>& report);
  std::uint64_t missing(std::uint64_t first, std::uint64_t count) const;
  std::vector<DamageResult> results() const;

 private:
  Places places_;
  std::string results_;
};

/// Table of files and damages: refused, with and without a route, and each cause with its first number.
std::string table(const std::vector<DamageResult>& results);

}  // namespace safety
