#pragma once

#include <cstdlib>
#include <sstream>

namespace talus {

/// Range of seeds of a test that can be extended to a campaign.
struct CampaignPart {
  unsigned first = 1, count = 0;
  unsigned end() const { return first + count; }
};

/// The range that an environment variable "FIRST COUNT" specifies; without the variable the seeds 1 to
/// `count`.
inline CampaignPart campaignPart(const char* variable, unsigned count) {
  CampaignPart part{1, count};
  if (const char* const text = std::getenv(variable)) std::istringstream(text) >> part.first >> part.count;
  return part;
}

}  // namespace talus
