#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "damage.hpp"

namespace safety {

/// A site with every file that a damaged one can stand in for, and what routes over it are judged by.
class DamagedSite {
 public:
  /// Site number n. Throws std::runtime_error where the program fails.
  DamagedSite(const Places& places, std::uint64_t number);

  /// The file of that name in folder(), whole; empty where the site has none, as without a drive.
  std::string whole(const std::string& file) const;

  /// Puts bytes in the place of the file, plans, and judges the route on what is whole.
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
  std::string window_;  ///< what a program in C sees later: west, south, width, height, resolution
  std::vector<JournalRow> none_;
  std::unique_ptr<Belief> prior_, learned_;
};

}  // namespace safety
