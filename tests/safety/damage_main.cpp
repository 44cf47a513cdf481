// damage_campaign PROGRAM LIBRARY FOLDER COUNT [FIRST]: plans routes over damaged files and judges them on
// the undamaged files. Keeps finished results and prints a table. Exit code 1: a route less safe than on the
// undamaged file, a crash, or a file that was not judged.
#include <cstdlib>
#include <iostream>
#include <string>

#include "damage.hpp"

int main(int count, char** words) {
  if (count < 5) {
    std::cerr << "damage_campaign PROGRAM LIBRARY FOLDER COUNT [FIRST]; real maps: TALUS_REAL_MAPS\n";
    return 2;
  }
  const char* maps = std::getenv("TALUS_REAL_MAPS");
  const safety::Places places{words[1], words[2], maps ? maps : "", words[3]};
  std::filesystem::create_directories(places.folder);
  safety::DamageCampaign campaign(places, (places.folder / "damage.csv").string());
  const std::uint64_t first = count > 5 ? std::stoull(words[5]) : 0, files = std::stoull(words[4]);
  campaign.run(first, files, [](const std::string& text) { std::cerr << text << '\n'; });
  const auto results = campaign.results();
  std::cout << table(results);
  if (const auto missing = campaign.missing(first, files); missing > 0) {
    std::cout << missing << " files were not judged\n";
    return 1;
  }
  for (const safety::DamageResult& result : results)
    if (!result.causes.empty() || result.exit > 2 || !result.complaint.empty()) return 1;
  return 0;
}
