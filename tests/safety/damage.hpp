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

/// Files that are damaged: elevation and classes in several formats, rocks, areas to keep out of, telemetry, journal, map, model, route, and
/// the arrays of heights and classes that a program in C puts into a map.
const std::vector<std::string>& damagedFiles();

/// The bytes of a file with a part removed, cut off, or overwritten by zeros, by other bytes, by a single byte or by another part of
/// the file, and what was done in a word or two. Parts are a byte, a few, a sector of 512 or a page of 4096 bytes.
std::pair<std::string, std::string> damaged(const std::string& bytes, std::mt19937_64& random);

/// What came of one damaged file.
struct DamageResult {
  std::uint64_t number = 0;
  std::string file, damage;
  int exit = 0;                     ///< of the last call: 0 a route, 1 none, 2 refused; 128 a signal
  std::vector<std::string> causes;  ///< by which a route is less safe than on the whole file
  std::string complaint;            ///< what a call printed that is no line of the program's
};

/// Damaged files by number: number / kPerSite is the site. Results are appended to a file as they come; numbers that it holds are left
/// out, so that a campaign that was stopped goes on.
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

/// Files and damages, refused, with a route and without, and each cause with its first number.
std::string table(const std::vector<DamageResult>& results);

}  // namespace safety
