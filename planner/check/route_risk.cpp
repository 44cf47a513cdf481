#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>

#include <talus/planner/check/route_risk.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::planner {
namespace {

// Largest magnitude of the reliability index; a stretch with this index fails in no simulated world.
constexpr double kSafe = 8.0;

// Stretch of the route between two vertices.
struct Stretch {
  std::size_t vertex;  // vertex at the end of the stretch
  double metres;
  double weak;    // probability that the soil is too weak
  double beta;    // reliability index: P(u < -beta) = weak
  double shared;  // share of the variance common to the soil class
  // Class number in order of first occurrence on the route, so that other declared classes do not change the
  // draws.
  std::size_t soil;
  int soil_class;
  double correlation;  // of the remaining variance with that of the previous stretch
};

double reliabilityIndex(double weak) {
  return weak > 0.0 ? std::clamp(-terramech::normalQuantile(weak), -kSafe, kSafe) : kSafe;
}

double weakOf(double hazard_per_m, const RouteRiskOptions& options) {
  const double held = -std::expm1(-hazard_per_m * options.correlation_length_m);
  const double weak = options.entrapment > 0.0 ? held / options.entrapment : 0.0;
  return weak < 1e-15 ? 0.0 : std::min(weak, 1.0 - 1e-12);
}

std::vector<Stretch> stretches(const Route& route, const RouteRiskOptions& options) {
  std::vector<Stretch> made;
  std::map<int, std::size_t> met;
  double middle_m = 0.0, at_m = 0.0;
  for (std::size_t i = 1; i < route.vertices.size(); ++i) {
    const RouteVertex& a = route.vertices[i - 1];
    const RouteVertex& b = route.vertices[i];
    const double metres = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    if (!(metres > 0)) continue;
    const double weak = weakOf(a.hazard_per_m, options);
    const double here_m = at_m + 0.5 * metres;
    const std::size_t soil = met.try_emplace(a.soil_class, met.size()).first->second;
    const bool follows = !made.empty() && made.back().soil == soil;
    made.push_back({.vertex = i,
                    .metres = metres,
                    .weak = weak,
                    .beta = reliabilityIndex(weak),
                    .shared = a.shared_variance_share,
                    .soil = soil,
                    .soil_class = a.soil_class,
                    .correlation = follows ? std::exp(-std::max(here_m - middle_m, options.cell_m) /
                                                      options.correlation_length_m)
                                           : 0.0});
    middle_m = here_m;
    at_m += metres;
  }
  return made;
}

void validate(const RouteRiskOptions& options) {
  if (!(options.correlation_length_m > 0))
    throw std::invalid_argument("route risk: correlation_length_m must be > 0");
  if (!(options.entrapment >= 0 && options.entrapment <= 1))
    throw std::invalid_argument("route risk: entrapment must be in [0, 1]");
  if (!(options.tail > 0 && options.tail <= 1))
    throw std::invalid_argument("route risk: tail must be in (0, 1]");
  if (!(options.cell_m >= 0)) throw std::invalid_argument("route risk: cell_m must be >= 0");
  if (options.worlds < 1) throw std::invalid_argument("route risk: worlds must be > 0");
}

// Draws u of every stretch of a route.
class Worlds {
 public:
  Worlds(const std::vector<Stretch>& route, std::uint64_t seed)
      : route_(route), random_(seed), u_(route.size()) {
    for (const Stretch& s : route) common_.resize(std::max(common_.size(), s.soil + 1));
  }

  // Draws an unconditional world.
  const std::vector<double>& any() { return around(0, gauss_(random_)); }

  // Draws a world in which the soil of stretch i is too weak.
  const std::vector<double>& weakAt(std::size_t i) {
    const double share = std::uniform_real_distribution<double>(1e-9, 1.0)(random_);
    return around(i, terramech::normalQuantile(share * route_[i].weak));
  }

  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

 private:
  // Draws a world with a given u of stretch i: first its shared and local components, then the other stretches
  // in both directions.
  const std::vector<double>& around(std::size_t i, double u) {
    const double shared = std::sqrt(route_[i].shared), own = std::sqrt(1.0 - route_[i].shared);
    for (double& common : common_) common = gauss_(random_);
    const double e = common_[route_[i].soil];
    common_[route_[i].soil] = shared * u + own * e;
    const double place = own * u - shared * e;
    u_[i] = u;
    double at = place;
    for (std::size_t k = i + 1; k < route_.size(); ++k)
      u_[k] = combined(k, at = next(at, route_[k].correlation));
    at = place;
    for (std::size_t k = i; k-- > 0;) u_[k] = combined(k, at = next(at, route_[k + 1].correlation));
    return u_;
  }

  double next(double place, double correlation) {
    return correlation * place + std::sqrt(1.0 - correlation * correlation) * gauss_(random_);
  }

  double combined(std::size_t k, double place) const {
    return std::sqrt(route_[k].shared) * common_[route_[k].soil] + std::sqrt(1.0 - route_[k].shared) * place;
  }

  const std::vector<Stretch>& route_;
  std::mt19937_64 random_;
  std::normal_distribution<double> gauss_;
  std::vector<double> common_;  // by soil class
  std::vector<double> u_;
};

// Energy and time of a stretch by the map; zeros outside of it.
costmap::TravelForecast forecastOn(const Stretch& stretch, const Route& route, const costmap::CostGrid& map) {
  const RouteVertex &to = route.vertices[stretch.vertex], &from = route.vertices[stretch.vertex - 1];
  const auto cell = map.grid().cellAt({0.5 * (from.x_m + to.x_m), 0.5 * (from.y_m + to.y_m)});
  if (!cell) return {};
  costmap::TravelForecast forecast = map.cost().forecast(
      map.at(*cell), {(to.x_m - from.x_m) / stretch.metres, (to.y_m - from.y_m) / stretch.metres});
  for (auto* values : {&forecast.energy_J_per_m, &forecast.time_s_per_m})
    for (float& value : *values)
      value = std::isfinite(value) ? value * static_cast<float>(stretch.metres) : 0.0F;
  forecast.added_J_per_m *= stretch.metres;
  return forecast;
}

// Value at u standard deviations: linear between the deviates, constant beyond.
double valueAt(const std::array<float, costmap::TravelForecast::kDeviates>& values, double u) {
  using costmap::TravelForecast;
  constexpr double kStep = TravelForecast::deviate(1) - TravelForecast::deviate(0);
  const double place =
      std::clamp((u - TravelForecast::deviate(0)) / kStep, 0.0, TravelForecast::kDeviates - 1.0);
  const auto k = std::min(static_cast<std::size_t>(place), values.size() - 2);
  const auto low = static_cast<double>(values[k]), high = static_cast<double>(values[k + 1]);
  return low + (place - static_cast<double>(k)) * (high - low);
}

DriveEffort effortOf(std::vector<double> values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(values.size()));
  std::ranges::nth_element(values, nth);
  return {mean, *nth};
}

// Probability of immobilisation after a length of too weak soil.
double heldAfter(double metres, const RouteRiskOptions& options) {
  if (options.entrapment >= 1.0) return metres > 0.0 ? 1.0 : 0.0;
  return -std::expm1(metres / options.correlation_length_m * std::log1p(-options.entrapment));
}

// Mean over worlds at each stretch, and the variance of the mean at the last stretch.
struct Drawn {
  std::vector<double> risk;
  double variance = 0.0;
};

// Returns true if a stop ends the simulation after this many worlds. The first four million stretches are
// always simulated.
bool endsAfter(int worlds, const std::vector<Stretch>& route, const ProgressMonitor& watch) {
  constexpr std::size_t kBrief = 4'000'000;
  return static_cast<std::size_t>(worlds) * route.size() > kBrief && watch.stopped();
}

// Empty when stopped.
Drawn drawn(const std::vector<Stretch>& route, const RouteRiskOptions& options,
            const ProgressMonitor& watch) {
  Drawn out{.risk = std::vector<double>(route.size(), 0.0)};
  std::vector<double> share;  // expected length of too weak soil up to each stretch
  for (const Stretch& s : route) share.push_back((share.empty() ? 0.0 : share.back()) + s.weak * s.metres);
  if (share.empty() || !(share.back() > 0.0)) return out;
  Worlds worlds(route, options.seed);
  const auto n = static_cast<double>(options.worlds);
  double squares = 0.0;
  std::vector<double> weak_m(route.size());
  for (int world = 0; world < options.worlds; ++world) {
    if (endsAfter(world, route, watch)) return {};
    const double pick = (world + worlds.uniform()) / n * share.back();
    const auto found = std::ranges::upper_bound(share, pick) - share.begin();
    const auto at = std::min(static_cast<std::size_t>(found), route.size() - 1);
    const std::vector<double>& u = worlds.weakAt(at);
    double sum_m = 0.0;
    for (std::size_t k = 0; k < route.size(); ++k)
      weak_m[k] = sum_m += k == at || u[k] < -route[k].beta ? route[k].metres : 0.0;
    const double scale = share.back() / sum_m;
    double held = 0.0;
    for (std::size_t k = 0; k < route.size(); ++k) {
      if (k == 0 || weak_m[k] > weak_m[k - 1]) held = heldAfter(weak_m[k], options) * scale;
      out.risk[k] += held / n;
    }
    squares += held * held / n;
  }
  out.variance = std::max(squares - out.risk.back() * out.risk.back(), 0.0) / n;
  for (double& risk : out.risk) risk = std::min(risk, 1.0);
  return out;
}

// Assigns the values of stretches to their end vertices; the result never decreases.
std::vector<double> alongVertices(const Route& route, const std::vector<Stretch>& way,
                                  const std::vector<double>& risk) {
  std::vector<double> along(route.vertices.size(), 0.0);
  for (std::size_t k = 0; k < way.size(); ++k) along[way[k].vertex] = risk[k];
  for (std::size_t i = 1; i < along.size(); ++i) along[i] = std::max(along[i], along[i - 1]);
  return along;
}

struct Least {
  double reserve = kSafe;
  std::size_t where = 0;
};

Least leastReserve(const std::vector<Stretch>& route, const std::vector<double>& u) {
  Least least;
  for (std::size_t i = 0; i < route.size(); ++i)
    if (route[i].beta + u[i] < least.reserve) least = {route[i].beta + u[i], i};
  return least;
}

// Computes the conditional value at risk, and the vertex before the stretch that most often has the smallest
// reserve. Returns false when stopped.
bool drawTail(const std::vector<Stretch>& way, const Route& route, const RouteRiskOptions& options,
              const ProgressMonitor& watch, RouteRisk& risk) {
  Worlds worlds(way, options.seed);
  std::vector<double> reserves;
  std::vector<int> worst_at(way.size());
  for (int world = 0; world < options.worlds; ++world) {
    if (endsAfter(world, way, watch)) return false;
    const Least least = leastReserve(way, worlds.any());
    reserves.push_back(least.reserve);
    ++worst_at[least.where];
  }
  std::ranges::sort(reserves);
  const auto tail = std::max<std::ptrdiff_t>(1, std::lround(options.tail * options.worlds));
  risk.cvar = std::accumulate(reserves.begin(), reserves.begin() + tail, 0.0) / static_cast<double>(tail);
  const auto worst = std::ranges::max_element(worst_at) - worst_at.begin();
  const RouteVertex& place = route.vertices[way[static_cast<std::size_t>(worst)].vertex - 1];
  risk.worst_x_m = place.x_m;
  risk.worst_y_m = place.y_m;
  return true;
}

}  // namespace

RouteRiskOptions riskOptions(const costmap::CostGrid& map) {
  RouteRiskOptions options{.cell_m = map.grid().resolution_m};
  const costmap::SoilUncertainty& uncertainty = map.cost().uncertainty();
  if (!(uncertainty.correlation_length_m > 0.0)) return options;
  options.correlation_length_m = uncertainty.correlation_length_m;
  options.entrapment = uncertainty.entrapment;
  return options;
}

namespace {

// Share of the difference between fresh ground and ruts of the mean stiffness that ruts of the stiffness r make, u
// standard deviations from the mean: (1/sqrt(r) - 1/sqrt(mean)) / (1 - 1/sqrt(mean)), because resistance falls as
// 1/sqrt(r) (terramech::rutted()).
double freshShare(const terramech::Estimate& stiffness, double u) {
  if (!(stiffness.value > 1.0)) return 0.0;
  const double mean = 1.0 / std::sqrt(stiffness.value);
  return (1.0 / std::sqrt(std::max(1.0, stiffness.value + u * stiffness.std)) - mean) / (1.0 - mean);
}

}  // namespace

// Drives in pairs of opposite departures, whose errors cancel in the mean.
RouteForecast routeForecast(const Route& route, const costmap::CostGrid& map,
                            const RouteRiskOptions& options) {
  const std::vector<Stretch> way = stretches(route, options);
  if (way.empty()) return {};
  std::vector<costmap::TravelForecast> along;
  for (const Stretch& stretch : way) along.push_back(forecastOn(stretch, route, map));
  Worlds worlds(way, options.seed);
  const std::vector<terramech::Estimate>& ruts = map.cost().uncertainty().ruts;
  std::mt19937_64 random(options.seed + 1);
  std::normal_distribution<double> gauss;
  std::vector<double> rut_departure(ruts.size()), fresh(ruts.size() + 1);  // by class; the last: without ruts
  std::array<std::vector<double>, 2> energy_J, time_s;  // of drives that arrive, and that fail
  const auto pairs = std::clamp<std::size_t>(4'000'000 / way.size(), 50, 500);
  for (std::size_t pair = 0; pair < pairs; ++pair) {
    const std::vector<double>& departure = worlds.any();
    for (double& u : rut_departure) u = gauss(random);
    for (const double sign : {1.0, -1.0}) {
      double energy = 0.0, time = 0.0;
      bool fails = false;
      for (std::size_t c = 0; c < ruts.size(); ++c) fresh[c] = freshShare(ruts[c], sign * rut_departure[c]);
      for (std::size_t k = 0; k < way.size(); ++k) {
        const double u = sign * departure[k],
                     rut = fresh[std::min(static_cast<std::size_t>(way[k].soil_class), ruts.size())];
        energy += along[k].added_J_per_m +
                  valueAt(along[k].energy_J_per_m, u) * (1.0 + rut * (along[k].fresh_energy - 1.0));
        time += valueAt(along[k].time_s_per_m, u) * (1.0 + rut * (along[k].fresh_time - 1.0));
        fails = fails || u < along[k].fails_below;
      }
      energy_J[fails ? 1 : 0].push_back(energy);
      time_s[fails ? 1 : 0].push_back(time);
    }
  }
  const std::size_t which = energy_J[0].empty() ? 1 : 0;
  return {effortOf(std::move(energy_J[which])), effortOf(std::move(time_s[which]))};
}

std::vector<double> riskAlong(const Route& route, const RouteRiskOptions& options,
                              const ProgressMonitor& watch) {
  validate(options);
  const std::vector<Stretch> way = stretches(route, options);
  const Drawn risk = drawn(way, options, watch);
  if (risk.risk.size() < way.size()) return {};
  return alongVertices(route, way, risk.risk);
}

// 1 - prod(1 - h) <= sum(h), and the mean of a sum is the sum of the means for any correlation.
std::vector<double> riskBoundAlong(const Route& route, const RouteRiskOptions& options) {
  validate(options);
  const std::vector<Stretch> way = stretches(route, options);
  std::vector<double> bound;
  double sum = 0.0;
  for (const Stretch& s : way) bound.push_back(std::min(sum += s.weak * heldAfter(s.metres, options), 1.0));
  return alongVertices(route, way, bound);
}

RouteRisk routeRisk(const Route& route, const RouteRiskOptions& options, const ProgressMonitor& watch) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr RouteRisk kStopped{kNan, kNan, kNan, kNan, kNan};
  validate(options);
  const std::vector<Stretch> way = stretches(route, options);
  RouteRisk risk;
  risk.cvar = kSafe;
  if (way.empty()) return risk;
  const Drawn all = drawn(way, options, watch);
  if (all.risk.empty()) return kStopped;
  risk.immobilisation = all.risk.back();
  risk.standard_error = std::sqrt(all.variance);
  return drawTail(way, route, options, watch, risk) ? risk : kStopped;
}

}  // namespace talus::planner
