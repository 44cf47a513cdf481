// Blind trials of residual tracing: blind_trials FIRST_SEED COUNT
// [library|other|double|none|scatter10|scatter20|site|tied|few|patch|product] [wide|campaign] [scan|renamed].
// Prints one line for each world and the rates. The option scan judges the plain scan (plain_scan.hpp) by
// columns alone; renamed tests whether other column names change the result. Seeds 1 to 9999 are for
// development; seeds from 100000 on are for the final evaluation and are reported once.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "calibration/traced_world.hpp"
#include "plain_scan.hpp"

using namespace talus;
using namespace talus::terramech;

namespace {

double rms(const std::vector<double>& v) {
  double s = 0.0;
  for (double x : v) s += x * x;
  return std::sqrt(s / static_cast<double>(v.size()));
}

/// Number of hidden effects whose column is named, and whether a column without an effect is named.
struct Named {
  int found = 0;
  bool extra = false;
};
Named named(const blind::World& world, const std::vector<std::string>& columns) {
  const auto is = [](const blind::Hidden& h, const std::string& column) {
    return std::find(h.covariates.begin(), h.covariates.end(),
                     column == "rim_speed_mps" ? "speed_mps" : column) != h.covariates.end();
  };
  Named n;
  for (const blind::Hidden& h : world.hidden)
    n.found += std::any_of(columns.begin(), columns.end(), [&](const auto& c) { return is(h, c); });
  for (const std::string& c : columns)
    n.extra |=
        std::none_of(world.hidden.begin(), world.hidden.end(), [&](const auto& h) { return is(h, c); });
  return n;
}

/// Names that a trace returns; the world's own columns are replaced by their number.
std::string answerWith(blind::World world, const std::vector<std::string>& names) {
  const std::vector<std::string> own{"temperature_C", "dust_index", "battery_V"};
  for (std::string& column : world.columns)
    for (std::size_t k = 0; k < own.size(); ++k)
      if (column == own[k]) column = names[k];
  const RefinedModel base = baseOf(world.ground);
  std::string answer;
  for (const TracedEffect& e :
       traceResiduals(base, makeTrial(telemetryOf(world, world.rows), base)).effects) {
    std::string column = e.chosen.candidate.covariate();
    for (std::size_t k = 0; k < own.size(); ++k)
      if (const auto at = column.find(names[k]); at != std::string::npos)
        column.replace(at, names[k].size(), std::to_string(k));
    answer += e.chosen.candidate.parts.front().name + '(' + column + ") ";
  }
  return answer;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 3 ? argv[3] : "library";
  const int first = argc > 1 ? std::atoi(argv[1]) : 1, count = argc > 2 ? std::atoi(argv[2]) : 10;
  const auto cpu = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  int sure = 0, equal_said = 0, claimed = 0;
  int located = 0, family = 0, hidden = 0, all_found = 0, alarms = 0;
  double slowest = 0.0;
  std::vector<double> pull_ratio, z_ratio;
  for (int seed = first; seed < first + count; ++seed) {
    blind::WorldPlan plan{.seed = static_cast<std::uint64_t>(seed)};
    plan.product = mode == "product";
    plan.unresolvable = mode == "tied" || mode == "few" || mode == "patch" ? mode : "";
    plan.effects = mode == "none" || mode.starts_with("scatter") || mode == "site" || mode == "patch" ? 0
                   : mode == "double"                                                                 ? 2
                                                                                                      : 1;
    plan.scatter = mode == "scatter10" ? 0.1 : mode == "scatter20" ? 0.2 : 0.0;
    plan.sites = mode == "site";
    plan.library = mode != "other";
    plan.wide = argc > 4 && std::string(argv[4]) == "wide";
    plan.campaign = argc > 4 && std::string(argv[4]) == "campaign";
    const blind::World world = blind::makeWorld(plan);
    const double start = cpu();
    const RefinedModel base = baseOf(world.ground);
    if (argc > 5 && std::string(argv[5]) == "renamed") {
      const std::string a = answerWith(world, {"temperature_C", "dust_index", "battery_V"}),
                        b = answerWith(world, {"operator_id", "hours_since_rain", "moisture_pct"});
      std::printf("%6d %s: %s| %s\n", seed, a == b ? "same" : "DIFFERS", a.c_str(), b.c_str());
      std::fflush(stdout);
      alarms += a != b;
      continue;
    }
    if (argc > 5) {
      const Named n = named(world, plainScan(base, makeTrial(telemetryOf(world, world.rows), base)));
      hidden += static_cast<int>(world.hidden.size());
      located += n.found;
      all_found += n.found == static_cast<int>(world.hidden.size());
      alarms += n.extra;
      continue;
    }
    const TraceResult result = traceResiduals(base, makeTrial(telemetryOf(world, world.rows), base));
    const double seconds = cpu() - start;
    slowest = std::max(slowest, seconds);
    std::vector<blind::Claim> claims;
    for (const TracedEffect& e : result.effects)
      claims.push_back(
          {e.chosen.candidate.parts.front().name, e.chosen.candidate.covariate(), name(e.channel)});
    const blind::Marks marks = blind::judge(world, claims);
    for (const TracedEffect& e : result.effects) {
      std::vector<std::string> columns{e.chosen.candidate.covariate()};
      for (const Explanation& other : e.equal) columns.push_back(other.candidate.covariate());
      sure += named(world, columns).found == 0 && e.equal.empty();
      equal_said += !e.equal.empty();
      ++claimed;
    }
    const ChannelErrors held = rmseOf(result.refined, makeTrial(telemetryOf(world, world.held), base));
    pull_ratio.push_back(held[0] / rms(world.floor_pull));
    z_ratio.push_back(held[1] / rms(world.floor_z));
    hidden += marks.hidden;
    located += marks.located;
    family += marks.family;
    all_found += marks.located == marks.hidden;
    alarms += marks.claimed > marks.located;
    std::printf("%6d n=%3zu noise=%.3f %4.1fs  ratio %.2f %.2f  p=%.4f |", seed, world.rows.size(),
                world.noise, seconds, pull_ratio.back(), z_ratio.back(),
                result.first_promises.empty() ? 1.0 : result.first_promises[0].p_value);
    for (const auto& h : world.hidden) std::printf(" %s(%.3g)", h.kind.c_str(), h.size);
    std::printf(" =>");
    for (const TracedEffect& e : result.effects) {
      std::printf(" %s[%s %s", e.chosen.candidate.parts.front().name.c_str(),
                  e.chosen.candidate.covariate().c_str(), name(e.channel));
      for (double p : e.chosen.candidate.parts.front().parameters) std::printf(" %.3g", p);
      std::printf("] %.2f", e.chosen.chi2_gain / (3.0 * static_cast<double>(world.rows.size())));
      for (const Explanation& other : e.equal)
        std::printf(" = %s(%s)", other.candidate.parts.front().name.c_str(),
                    other.candidate.covariate().c_str());
    }
    std::printf(" %s%s\n", marks.located == marks.hidden ? "" : "MISSED ",
                marks.claimed > marks.located ? "EXTRA" : "");
    std::fflush(stdout);
  }
  const auto show = [](std::vector<double> v) {
    std::sort(v.begin(), v.end());
    std::printf(" median %.3f worst %.3f", v[v.size() / 2], v.back());
  };
  std::printf(
      "located %d/%d, family %d/%d, all found %d/%d, sets with an extra %d/%d, slowest %.1f s of one core\n",
      located, hidden, family, hidden, all_found, count, alarms, count, slowest);
  if (pull_ratio.empty()) return 0;
  std::printf("of %d causes named %d with others equal; wrong and without any: %d\n", claimed, equal_said,
              sure);
  std::printf("held-out rmse over floor: pull");
  show(pull_ratio);
  std::printf(", sinkage");
  show(z_ratio);
  std::printf("\n");
}
