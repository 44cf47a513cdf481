// Every reader on its seeds and on random changes of them: what refuses a file does it by an error of input. The number
// of changes is TALUS_FUZZ_CHANGES, 100 if not set; ./dev fuzz sets more, under sanitizers.
#include <cstdlib>
#include <random>
#include <utility>

#include "targets.hpp"

#ifdef __SANITIZE_ADDRESS__
// GDAL keeps its drivers until the process ends.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgdal\n";
}
#endif

namespace talus::fuzz {
namespace {

std::vector<Target> targets() {
  limitMemory();
  std::vector<Target> all;
  for (const auto& module : {terramechTargets, mapsTargets, costmapTargets, plannerTargets, cliTargets})
    for (Target& target : module()) all.push_back(std::move(target));
  return all;
}

class Fuzz : public testing::TestWithParam<Target> {};

// One to eight bytes changed, taken out, doubled, or replaced by what tends to hurt.
std::string changed(std::string bytes, std::mt19937& random) {
  static const std::string_view kWords[] = {"nan",      "-1", "1e308", "0", "99999999999", "\xFF\xFF\xFF\xFF",
                                            "[[[[[[[[", "\"", "\n",    ",", "{",           "../",
                                            "inf"};
  const auto at = [&](std::size_t size) {
    return std::uniform_int_distribution<std::size_t>(0, size)(random);
  };
  for (std::size_t k = 0; k <= at(7); ++k) {
    const std::size_t place = at(bytes.size());
    switch (at(5)) {
      case 0:
        if (place < bytes.size()) bytes[place] = static_cast<char>(bytes[place] ^ (1 << at(7)));
        break;
      case 1:
        if (place < bytes.size()) bytes[place] = static_cast<char>(at(255));
        break;
      case 2:
        bytes.erase(place, at(16));
        break;
      case 3:
        bytes.insert(place, bytes.substr(at(bytes.size()), at(64)));
        break;
      case 4:
        bytes.insert(place, kWords[at(std::size(kWords) - 1)]);
        break;
      default:
        bytes.resize(at(20) == 0 ? place : bytes.size());
    }
  }
  return bytes;
}

TEST_P(Fuzz, SeedsAreAccepted) {
  for (const std::string& seed : GetParam().seeds)
    EXPECT_TRUE(accepts(GetParam(), seed)) << seed.substr(0, 200);
}

// Property: no bytes end the reader by anything but an error of input.
TEST_P(Fuzz, MutatedFilesAreReadOrRejected) {
  const char* more = std::getenv("TALUS_FUZZ_CHANGES");
  const int changes = more ? std::atoi(more) : 100;
  std::mt19937 random(7);
  std::vector<std::string> seeds = GetParam().seeds;
  seeds.insert(seeds.end(), GetParam().refused_seeds.begin(), GetParam().refused_seeds.end());
  seeds.emplace_back();
  for (int k = 0; k < changes; ++k) {
    const std::string bytes = changed(seeds[static_cast<std::size_t>(k) % seeds.size()], random);
    EXPECT_NO_THROW(accepts(GetParam(), bytes)) << GetParam().name << ", change " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, Fuzz, testing::ValuesIn(targets()),
                         [](const auto& entry) { return entry.param.name; });

}  // namespace
}  // namespace talus::fuzz
