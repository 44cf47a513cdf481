#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "damage.hpp"

namespace safety {

/// A site with every file that can be damaged, and the undamaged data by which its routes are judged.
class DamagedSite {
 public:
  /// Makes site number n. Throws std::runtime_error if the program fails.
  DamagedSite(const Places& places, std::uint64_t number);

  /// Content of the undamaged file of that name in folder(); empty if the site has no such file, for example
  /// no drive.
  std::string whole(const std::string& file) const;

  /// Replaces the file by the given bytes, plans a route, and judges the route on the undamaged files.
  DamageResult tried(const std::string& file, const std::string& bytes, std::size_t pair);

  const std::filesystem::path& folder() const { return ground_.folder; }

 private:
  int call(const std::string& words, std::string& complaint) const;
  int run(const std::string& words, std::string& complaint) const;
  std::string ground(const std::string& dem, const std::string& classes,
                     const std::string& areas = "keep_out.geojson") const;
  std::string errand(std::size_t pair) const;
  void judgeOn(const std::string& file, const std::vector<const Belief*>& beliefs,
               DamageResult& result) const;
  void scoreWhole(const std::string& more, const std::string& path, DamageResult& result) const;
  void plan(const std::string& file, std::size_t pair, DamageResult& result) const;
  void planLearned(const std::string& file, std::size_t pair, DamageResult& result) const;
  void score(const std::string& file, DamageResult& result) const;
  void patch(const std::string& file, std::size_t pair, DamageResult& result) const;
  void writeUnseen();

  Places places_;
  ProvingGround ground_;
  std::string window_;  ///< window patched in by the C program: west, south, width, height, resolution
  std::vector<JournalRow> none_;
  std::unique_ptr<Belief> prior_, learned_;
};

}  // namespace safety
