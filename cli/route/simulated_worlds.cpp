#include <nlohmann/json.hpp>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/context.hpp>
#include <talus/cli/route/simulated_worlds.hpp>
#include <talus/cli/route/traverse_report.hpp>

namespace talus::cli {

SimulatedWorlds simulatedWorlds(const WorldCount& count, const World& world, const Campaign& campaign,
                                const ProgressMonitor& watch) {
  const auto outcomes = campaign.run(
      count.beliefs * count.worlds,
      [&](std::size_t job) { return jsonText(asJson(world(job / count.worlds, job % count.worlds))); }, watch,
      count.workers);
  SimulatedWorlds out{.results = std::vector<std::vector<planner::WorldResult>>(count.beliefs),
                      .failures = {}};
  for (std::size_t i = 0; i < count.worlds && !outcomes.empty(); ++i) {
    const JobOutcome* failed = nullptr;
    for (std::size_t b = 0; b < count.beliefs && !failed; ++b)
      if (outcomes[b * count.worlds + i].failed) failed = &outcomes[b * count.worlds + i];
    if (failed) {
      out.failures.push_back({i, failed->text});
      continue;
    }
    for (std::size_t b = 0; b < count.beliefs; ++b)
      out.results[b].push_back(
          worldResult(nlohmann::ordered_json::parse(outcomes[b * count.worlds + i].text)));
  }
  return out;
}

}  // namespace talus::cli
