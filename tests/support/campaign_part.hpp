#pragma once

#include <cstdlib>
#include <sstream>

namespace talus {

/// Seeds of a test that is a part of a campaign.
struct CampaignPart {
  unsigned first = 1, count = 0;
  unsigned end() const { return first + count; }
};

/// The part that an environment variable "FIRST COUNT" names; without it the seeds of each run, 1 to `count`.
inline CampaignPart campaignPart(const char* variable, unsigned count) {
  CampaignPart part{1, count};
  if (const char* const text = std::getenv(variable)) std::istringstream(text) >> part.first >> part.count;
  return part;
}

}  // namespace talus
