#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/sites/site_generator.hpp>
#include <talus/planner/bench/slip_world.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using costmap::TravelCurve;

constexpr double kSpeed_mps = 0.1;
constexpr int kTerrains = 10;
constexpr std::array kShares{0.4, 0.4, 0.1, 0.1};  // shares of the map's terrains

using Generator = std::mt19937_64;

double uniform(Generator& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

void validate(const SlipWorldOptions& o) {
  const auto refuse = [](const std::string& field, double value, const char* bound) {
    throw std::invalid_argument("slip world: " + field + " = " + std::to_string(value) + ", must be " +
                                bound);
  };
  if (o.side < 8) refuse("side", o.side, ">= 8");
  if (!(o.misclassification_rate >= 0.0 && o.misclassification_rate <= 1.0))
    refuse("misclassification_rate", o.misclassification_rate, "within 0 and 1");
  if (!(o.relief_m >= 0.0)) refuse("relief_m", o.relief_m, ">= 0");
  if (!(o.tail > 0.0 && o.tail <= 1.0)) refuse("tail", o.tail, "above 0 and at most 1");
}

// Steeper curves have a larger standard deviation, as in the set "ES" of the paper.
std::vector<SlipTerrain> drawnTerrains(Generator& random) {
  std::vector<SlipTerrain> terrains;
  for (int k = 0; k < kTerrains; ++k) {
    const double gain = uniform(random, 0.0, 8e-3), offset = uniform(random, 0.0, 0.1);
    terrains.push_back({.gain_deg2 = gain, .offset = offset, .noise = 0.05 + 0.15 * gain / 8e-3});
  }
  return terrains;
}

maps::Raster<float> noiseOver(const maps::Grid& grid, std::uint64_t seed, double longest_m,
                              double amplitude) {
  const maps::FractalGround ground(
      {.seed = seed, .longest_m = longest_m, .shortest_m = 2.0, .amplitude_m = amplitude});
  maps::Raster<float> field(grid);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const maps::Point p = grid.centre({column, row});
      field[{column, row}] = static_cast<float>(ground(p.x_m, p.y_m));
    }
  return field;
}

// Rank of every cell's value as a share of all cells; a threshold on the ranks selects a given share of the
// map.
maps::Raster<float> ranks(const maps::Raster<float>& field) {
  std::vector<std::size_t> order(field.values().size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return field.values()[i]; });
  maps::Raster<float> share(field.grid());
  for (std::size_t k = 0; k < order.size(); ++k)
    share.values()[order[k]] = (static_cast<float>(k) + 0.5F) / static_cast<float>(order.size());
  return share;
}

std::size_t bandOf(double share) {
  std::size_t band = 0;
  for (double upto = kShares[0]; band + 1 < kShares.size() && share >= upto; upto += kShares[++band]) {
  }
  return band;
}

struct Ground {
  std::array<std::uint8_t, kShares.size()> terrains;  // terrains of the map
  maps::Raster<std::uint8_t> truth, seen;
};

Ground drawnGround(const maps::Grid& grid, const SlipWorldOptions& options, Generator& random) {
  Ground ground{.terrains = {}, .truth = maps::Raster<std::uint8_t>(grid), .seen = {}};
  std::array<std::uint8_t, kTerrains> all{};
  for (std::uint8_t k = 0; k < kTerrains; ++k) all[k] = k;
  for (std::size_t k = 0; k < ground.terrains.size(); ++k) {
    std::swap(all[k], all[k + random() % (kTerrains - k)]);
    ground.terrains[k] = all[k];
  }
  const auto band = ranks(noiseOver(grid, random(), 32.0, 1.0));
  const auto doubt = ranks(noiseOver(grid, random(), 12.0, 1.0));
  const auto other = ranks(noiseOver(grid, random(), 12.0, 1.0));
  ground.seen = ground.truth;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const std::size_t at = bandOf(static_cast<double>(band.values()[i]));
    ground.truth.values()[i] = ground.seen.values()[i] = ground.terrains[at];
    if (static_cast<double>(doubt.values()[i]) >= options.misclassification_rate) continue;
    const auto step = 1 + static_cast<std::size_t>(3.0F * other.values()[i]);
    ground.seen.values()[i] = ground.terrains[(at + step) % ground.terrains.size()];
  }
  return ground;
}

// Component of a Gaussian mixture of slip.
struct Part {
  double weight, mean, deviation;
};

double upperTail(double z) {
  return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

// Returns the mean of the mixture over its largest values, whose probability is `tail` (conditional value at
// risk).
double tailMean(const std::vector<Part>& parts, double tail) {
  const auto above = [&](double q) {
    double sum = 0.0;
    for (const Part& p : parts) sum += p.weight * upperTail((q - p.mean) / p.deviation);
    return sum;
  };
  double low = -10.0, high = 10.0;
  for (int i = 0; i < 60; ++i) (above((low + high) / 2) > tail ? low : high) = (low + high) / 2;
  double sum = 0.0;
  for (const Part& p : parts) {
    const double z = (high - p.mean) / p.deviation;
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    sum += p.weight * (p.mean * upperTail(z) + p.deviation * density);
  }
  return sum / tail;
}

// Magnitude of slip used for planning.
double estimatedSlip(const SlipWorld& world, const Ground& ground, std::uint8_t seen, double gradient,
                     const SlipWorldOptions& options) {
  const double way = gradient >= 0.0 ? 1.0 : -1.0;  // when braking, the tail is at negative slip
  const SlipTerrain& own = world.terrains[seen];
  if (!options.risk_aware) return std::max(0.0, way * own.slip(gradient));
  std::vector<Part> parts;
  const double others = options.misclassification_rate / (kShares.size() - 1);
  for (const std::uint8_t k : ground.terrains) {
    const SlipTerrain& terrain = world.terrains[k];
    parts.push_back({k == seen ? 1.0 - options.misclassification_rate : others, way * terrain.slip(gradient),
                     terrain.noise});
  }
  return std::max(0.0, tailMean(parts, options.tail));
}

costmap::GroundCost estimatedCost(const SlipWorld& world, const Ground& ground, std::uint8_t seen,
                                  const SlipWorldOptions& options) {
  std::vector<costmap::TravelState> all;
  for (int bin = 0; bin < TravelCurve::kBins; ++bin) {
    const double gradient = TravelCurve::gradient(bin);
    const double slip = estimatedSlip(world, ground, seen, gradient, options);
    const bool stands = slip >= 1.0;
    const double seconds = std::hypot(1.0, gradient) / (kSpeed_mps * (1.0 - slip));
    all.push_back({.slip = static_cast<float>(gradient >= 0.0 ? slip : -slip),
                   .time_s_per_m = stands ? 0.0F : static_cast<float>(seconds),
                   .refusal = stands ? costmap::Refusal::Pull : costmap::Refusal::None});
  }
  auto states = std::make_shared<const costmap::TabulatedStates>(std::move(all));
  return {.curve = states->curve({.energy = 0.0, .time_W = 1.0, .risk_J = 0.0}), .states = states};
}

std::shared_ptr<const costmap::CostGrid> estimatedMap(const SlipWorld& world, const Ground& ground,
                                                      const maps::Raster<float>& heights,
                                                      const SlipWorldOptions& options) {
  std::vector<costmap::GroundCost> curves;
  for (std::uint8_t k = 0; k < kTerrains; ++k) curves.push_back(estimatedCost(world, ground, k, options));
  const maps::Grid& grid = heights.grid();
  maps::Raster<CellCode> cells(grid);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const auto height = [&](int c, int r) {
        return static_cast<double>(
            heights[{std::clamp(c, 0, grid.width - 1), std::clamp(r, 0, grid.height - 1)}]);
      };
      const double east = (height(column + 1, row) - height(column - 1, row)) / (2.0 * grid.resolution_m),
                   north = (height(column, row + 1) - height(column, row - 1)) / (2.0 * grid.resolution_m);
      cells[{column, row}] = CellCode({.dz_dx = east, .dz_dy = north, .curve = world.seen[{column, row}]});
    }
  const costmap::TravelCost::Limits limits{.max_along = 0.9, .max_across = 0.9};
  return std::make_shared<costmap::CostGrid>(
      costmap::flattened(cells, std::make_shared<costmap::TravelCost>(limits, curves)));
}

}  // namespace

double SlipTerrain::slip(double gradient) const noexcept {
  const double degrees = std::atan(gradient) / kDegree;
  return offset + std::copysign(gain_deg2 * degrees * degrees, gradient);
}

SlipWorld slipWorld(const SlipWorldOptions& options) {
  validate(options);
  Generator random(options.seed);
  const maps::Grid grid{
      .width = options.side, .height = options.side, .resolution_m = 1.0, .south_west = {0.0, 0.0}};
  SlipWorld world;
  world.terrains = drawnTerrains(random);
  const auto heights = noiseOver(grid, random(), 0.5 * options.side, options.relief_m);
  Ground ground = drawnGround(grid, options, random);
  world.truth = ground.truth;
  world.seen = ground.seen;
  world.error = maps::Raster<float>(grid);
  std::normal_distribution<double> gauss;
  for (std::size_t i = 0; i < grid.size(); ++i)
    world.error.values()[i] =
        static_cast<float>(world.terrains[world.truth.values()[i]].noise * gauss(random));
  world.map = estimatedMap(world, ground, heights, options);
  return world;
}

SlipTraverse driven(const SlipWorld& world, const std::vector<maps::Point>& route) {
  constexpr double kStep_cells = 0.1;
  const maps::Grid& grid = world.map->grid();
  SlipTraverse drive{.reached = true};
  const auto points = subdivided(route, kStep_cells * grid.resolution_m);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double dx = points[i].x_m - points[i - 1].x_m, dy = points[i].y_m - points[i - 1].y_m;
    const double metres = std::hypot(dx, dy);
    const auto cell = grid.cellAt({points[i - 1].x_m + dx / 2, points[i - 1].y_m + dy / 2});
    if (!cell || !(metres > 0.0)) continue;
    const CellCode ground = world.map->at(*cell);
    const double gradient = (ground.dzDx() * dx + ground.dzDy() * dy) / metres;
    const double slip =
        world.terrains[world.truth[*cell]].slip(gradient) + static_cast<double>(world.error[*cell]);
    drive.max_slip = std::min(1.0, std::max(drive.max_slip, std::abs(slip)));
    drive.reached = std::abs(slip) < 1.0;
    if (!drive.reached) return drive;
    // Driving: 1 - v / (r omega) = slip. Braking: r omega / v - 1 = slip.
    const double speed_mps = slip >= 0.0 ? kSpeed_mps * (1.0 - slip) : kSpeed_mps / (1.0 + slip);
    drive.time_s += metres * std::hypot(1.0, gradient) / speed_mps;
  }
  return drive;
}

}  // namespace talus::planner
