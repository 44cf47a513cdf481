// safety_campaign PROGRAM LIBRARY FOLDER COUNT [FIRST]: judges routes, keeps finished results, prints a
// table. Exit code 1: a violation was found, or an errand was not judged.
#include <cstdlib>
#include <iostream>
#include <string>

#include "campaign.hpp"

int main(int count, char** words) {
  if (count < 5) {
    std::cerr << "safety_campaign PROGRAM LIBRARY FOLDER COUNT [FIRST]; real maps: TALUS_REAL_MAPS\n";
    return 2;
  }
  const char* maps = std::getenv("TALUS_REAL_MAPS");
  const safety::Places places{words[1], words[2], maps ? maps : "", words[3]};
  std::filesystem::create_directories(places.folder);
  safety::Campaign campaign(places, (places.folder / "results.csv").string());
  const std::uint64_t first = count > 5 ? std::stoull(words[5]) : 0, errands = std::stoull(words[4]);
  campaign.run(first, errands, [](const std::string& text) { std::cerr << text << '\n'; });
  const auto results = campaign.results();
  std::cout << table(results);
  if (const auto missing = campaign.missing(first, errands); missing > 0) {
    std::cout << missing << " errands were not judged\n";
    return 1;
  }
  for (const safety::Result& result : results)
    if (!result.violations.empty() || result.exit > 2) return 1;
  return 0;
}
