#include "campaign.hpp"

#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>

#include "risk.hpp"

namespace safety {
namespace {

// Format of a line: number;kind;rover;learned;planner;exit;length;risk;drawn
// risk;cause,x,y,heading,amount|...
std::string line(const Result& r) {
  std::ostringstream out;
  out.precision(9);
  out << r.number << ';' << r.kind << ';' << r.rover << ';' << r.learned << ';' << r.planner << ';' << r.exit
      << ';' << r.length_m << ';' << r.risk << ';' << r.drawn_risk << ';';
  for (const Violation& v : r.violations)
    out << v.cause << ',' << v.place.x_m << ',' << v.place.y_m << ',' << v.heading_rad << ',' << v.amount
        << '|';
  return out.str();
}

std::vector<std::string> cut(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

// Returns nullopt for a line that is incomplete because the campaign was stopped.
std::optional<Result> parsed(const std::string& text) {
  auto parts = cut(text, ';');
  if (parts.size() == 9 && text.back() == ';') parts.emplace_back();
  if (parts.size() != 10 || (!parts[9].empty() && parts[9].back() != '|')) return std::nullopt;
  Result r{.number = std::stoull(parts[0]),
           .kind = parts[1],
           .rover = parts[2],
           .planner = parts[4],
           .learned = parts[3] == "1",
           .exit = std::stoi(parts[5]),
           .length_m = std::stod(parts[6]),
           .risk = std::stod(parts[7]),
           .drawn_risk = std::stod(parts[8]),
           .violations = {}};
  for (const std::string& violation : cut(parts[9], '|')) {
    const auto fields = cut(violation, ',');
    r.violations.push_back({fields.at(0),
                            {std::stod(fields.at(1)), std::stod(fields.at(2))},
                            std::stod(fields.at(3)),
                            std::stod(fields.at(4))});
  }
  return r;
}

constexpr int kWeakWorlds = 20;  // fewer worlds do not allow an estimate of the risk

// The printed risk may be lower than the drawn risk, less three standard errors, by a factor of 2. The
// amount of the violation is the ratio of drawn to printed risk.
std::optional<Violation> understatedRisk(const DrawnRisk& drawn, const Route& route) {
  constexpr double kFactor = 2.0, kErrors = 3.0;
  const double least = (drawn.immobilisation - kErrors * drawn.standard_error) / kFactor;
  if (drawn.weak_worlds < kWeakWorlds || route.immobilisation_risk >= least) return std::nullopt;
  return Violation{"risk understated", route.vertices.front(), 0.0,
                   drawn.immobilisation / std::max(route.immobilisation_risk, 1e-12)};
}

}  // namespace

std::vector<Result> Campaign::results() const {
  std::vector<Result> all;
  std::ifstream in(results_);
  for (std::string text; std::getline(in, text);)
    if (auto result = parsed(text)) all.push_back(std::move(*result));
  return all;
}

std::uint64_t Campaign::missing(std::uint64_t first, std::uint64_t count) const {
  std::set<std::uint64_t> done;
  for (const Result& result : results())
    if (result.number >= first && result.number < first + count) done.insert(result.number);
  return count - done.size();
}

Result Campaign::judged(const ProvingGround& ground, const Belief& belief, std::uint64_t number) {
  const Errand wanted = errand(ground, number % routesPerSite());
  Result result{.number = number,
                .kind = name(ground.kind),
                .rover = ground.rover,
                .planner = wanted.planner,
                .learned = ground.learned};
  const std::string file = "route" + std::to_string(number) + ".geojson";
  result.exit = planCall(ground, wanted, file).run(places_, ground.folder);
  if (result.exit != 0) return result;
  const Route route = readRoute(ground.folder / file);
  result.length_m = route.length_m();
  result.risk = route.immobilisation_risk;
  result.violations = Judge(ground.site, belief).judge(route);
  const DrawnRisk drawn = drawnRisk(ground.site, belief, route);
  if (drawn.weak_worlds >= kWeakWorlds) result.drawn_risk = drawn.immobilisation;
  if (const auto understated = understatedRisk(drawn, route)) result.violations.push_back(*understated);
  if (result.violations.empty()) std::filesystem::remove(ground.folder / file);
  return result;
}

void Campaign::run(std::uint64_t first, std::uint64_t count,
                   const std::function<void(const std::string&)>& report) {
  std::set<std::uint64_t> done;
  for (const Result& result : results()) done.insert(result.number);
  std::ofstream out(results_, std::ios::app);
  std::optional<std::uint64_t> at;
  std::unique_ptr<ProvingGround> ground;
  std::unique_ptr<Belief> belief;
  for (std::uint64_t number = first; number < first + count; ++number) {
    if (done.contains(number)) continue;
    if (const std::uint64_t site = number / routesPerSite(); at != site) {
      at = site;
      ground.reset();
      try {
        ground = std::make_unique<ProvingGround>(provingGround(places_, site));
        belief = std::make_unique<Belief>(ground->site, ground->journal);
      } catch (const std::exception& failure) {
        report(failure.what());
      }
    }
    if (!ground) continue;
    out << '\n' << line(judged(*ground, *belief, number)) << std::flush;
  }
}

std::string table(const std::vector<Result>& results) {
  struct Cause {
    std::size_t routes = 0;
    double worst = 0.0;
    std::uint64_t number = 0;
    std::set<std::string> planners;
  };
  std::map<std::string, Cause> causes;
  std::size_t routes = 0, none = 0, refused = 0, failed = 0, bad = 0;
  double metres = 0.0;
  std::vector<double> ratios;
  for (const Result& r : results) {
    ++(r.exit == 0 ? routes : r.exit == 1 ? none : r.exit == 2 ? refused : failed);
    metres += r.length_m;
    if (r.drawn_risk > 0.0) ratios.push_back(r.risk / r.drawn_risk);
    bad += r.violations.empty() ? 0U : 1U;
    for (const Violation& v : r.violations) {
      Cause& cause = causes[v.cause];
      ++cause.routes;
      cause.planners.insert(r.planner);
      if (v.amount > cause.worst) {
        cause.worst = v.amount;
        cause.number = r.number;
      }
    }
    if (r.exit > 2) causes["exit " + std::to_string(r.exit)].number = r.number;
  }
  std::ostringstream out;
  out << results.size() << " errands: " << routes << " routes of " << metres / 1000.0 << " km, " << none
      << " without a route, " << refused << " with start or goal refused, " << failed << " failed\n"
      << bad << " routes with a violation\n";
  std::sort(ratios.begin(), ratios.end());
  if (!ratios.empty())
    out << "risk, printed over drawn: " << ratios.front() << " to " << ratios.back() << ", median "
        << ratios[ratios.size() / 2] << ", of " << ratios.size() << " routes\n";
  for (const auto& [cause, c] : causes) {
    out << "  " << cause << ": " << c.routes << " routes, worst " << c.worst << " in number " << c.number
        << ", by";
    for (const std::string& planner : c.planners) out << ' ' << planner;
    out << '\n';
  }
  return out.str();
}

}  // namespace safety
