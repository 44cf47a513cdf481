// Computes the estimate of a cell and of a class from docs/belief.md alone: equations (B1) and (B11) to
// (B15), for observations of one drive that may raise an estimate.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <site_map.hpp>

namespace talus::costmap {
namespace belief_page_test {

constexpr int kSide = 64;            // side of the map, in cells of one metre
constexpr double kPrecision = 1e-7;  // the map stores the sums of a block as floats

struct Read {
  double pull, std, shared;
};
using Block =
    std::pair<int, int>;  // column and row of a block, or of a square of blocks, from the south-west
using World = std::map<Block, std::vector<Read>>;

// P0 (prior), p, q, l (length) and the side of a block, as in docs/belief.md.
struct Given {
  double prior, p, q, length, side;

  int reach() const { return static_cast<int>(std::ceil(length / side)); }
};

// Correlation of two places at distance d (B1).
double correlation(double d, double length) {
  if (d >= length) return 0.0;
  const double turn = 2.0 * std::numbers::pi * d / length;
  return (2.0 + std::cos(turn)) / 3.0 * (1.0 - d / length) + std::sin(turn) / (2.0 * std::numbers::pi);
}

// C of (B11) at a power of two; Phi^-1 is found by bisection.
double tailAt(double u) {
  if (u >= 1.0) return 0.0;
  double low = -40.0, high = 40.0;
  for (int i = 0; i < 200; ++i) {
    const double z = 0.5 * (low + high);
    (0.5 * std::erfc(-z / std::numbers::sqrt2) < u ? low : high) = z;
  }
  return std::exp(-0.5 * low * low) / std::sqrt(2.0 * std::numbers::pi) / u;
}

double tail(double u) {
  const double below = std::exp2(std::floor(std::log2(u))), share = std::log2(u / below);
  return (1.0 - share) * tailAt(below) + share * tailAt(2.0 * below);
}

double leastOf(std::vector<double> values, double sigma) {
  std::ranges::sort(values);
  const double n = static_cast<double>(values.size());
  double sum = 0.0, least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k <= values.size(); ++k) {
    sum += values[k - 1];
    least = std::min(least, sum / static_cast<double>(k) + sigma * tail(static_cast<double>(k) / n));
  }
  return least;
}

struct Place {
  double y = 0.0, variance = 0.0, shared = 0.0;  // y: departure from P0
};

// Evidence of one block from its readings (B11).
Place placeOf(const std::vector<Read>& reads, const Given& given) {
  std::map<double, std::vector<double>> grades;
  double weight = 0.0;
  Place place;
  for (const Read& read : reads) {
    double sigma = 0.025, shared = read.shared > 0.0 ? 0.02 : 0.0;
    while (sigma < read.std) sigma *= std::numbers::sqrt2;
    while (shared < read.shared) shared *= 1.5;
    grades[sigma].push_back(0.01 * std::round(read.pull / 0.01));
    weight += 1.0 / (sigma * sigma);
    place.shared += shared / (sigma * sigma);
  }
  for (const auto& [sigma, values] : grades) {
    const double n = static_cast<double>(values.size()), pull = leastOf(values, sigma);
    place.y += n / (sigma * sigma) / weight * (pull - given.prior);
    EXPECT_GT(pull - given.prior, -2.0 * std::hypot(given.p, 0.02, sigma / std::sqrt(n))) << "no weak place";
  }
  place.shared /= weight;
  place.variance = 0.02 * 0.02 + 1.0 / weight;
  return place;
}

// The variance of (B13) from e^2, c and q^2, or from the corresponding terms of (B15).
double withShared(double e2, double c, double v) {
  const double g = 1.0 - e2 / v;
  return g > 0.0 ? (e2 * g + c * c) / (g + c * c / v) : v;
}

// Number of places driven, and the third largest value among the places that may raise the estimate.
struct Agreed {
  double driven = 0.0, rise = 0.0;
  bool may_raise = false;
};

Agreed agreedOf(const World& world, const Given& given) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  struct Square {
    bool known = false;
    double least = std::numeric_limits<double>::infinity();
  };
  std::map<Block, Square> squares;
  for (const auto& [block, reads] : world) {
    const Place place = placeOf(reads, given);
    Square& square = squares[{block.first / given.reach(), block.second / given.reach()}];
    const bool known = place.variance <= 0.06 * 0.06;
    square.known |= known;
    if (known || place.y < -std::sqrt(place.variance)) square.least = std::min(square.least, place.y);
  }
  std::array<std::vector<double>, 4> colourings;
  for (const auto& [at, square] : squares)
    colourings[static_cast<std::size_t>(2 * (at.second % 2) + at.first % 2)].push_back(
        square.known ? square.least : kNone);
  Agreed agreed{.rise = kNone};
  for (auto& shown : colourings) {
    agreed.driven = std::max(agreed.driven, static_cast<double>(shown.size()));
    std::ranges::sort(shown, std::greater<>());
    if (shown.size() > 2) agreed.rise = std::max(agreed.rise, shown[2]);
  }
  agreed.may_raise = agreed.rise > kNone;
  agreed.rise = std::max(agreed.rise, 0.0);
  return agreed;
}

struct Class {
  Agreed agreed;
  double mean = 0.0, e2 = 0.0, shared = 0.0, variance = 0.0;
};

double inSteps(double value) {
  return std::round(value * 0x1p20) * 0x1p-20;
}

// Mean and variance of the class (B12), (B13).
Class classOf(const World& world, const Given& given) {
  const double p2 = given.p * given.p, q2 = given.q * given.q;
  double weight = 0.0, sum = 0.0, shared = 0.0;
  for (const auto& [block, reads] : world) {
    const Place place = placeOf(reads, given);
    const double h = std::min(1.0, 1.5 * given.side / given.length) * p2 / (p2 + place.variance);
    const double most = 2.0 * std::sqrt(p2 + q2 + place.variance);
    weight += inSteps(h);
    sum += inSteps(h * std::clamp(place.y, -most, most));
    shared += inSteps(h * place.shared);
  }
  Class of{.agreed = agreedOf(world, given), .e2 = q2, .variance = q2};
  of.mean =
      std::min(q2 * sum / (q2 * weight + p2) * std::min(0.5 * (of.agreed.driven - 1.0), 1.0), of.agreed.rise);
  if (!of.agreed.may_raise) return of;
  const double g = q2 * weight / (q2 * weight + p2);
  of.shared = g * shared / weight;
  of.e2 = q2 * (1.0 - g);
  of.variance = withShared(of.e2, of.shared, q2);
  return of;
}

// Solves a linear system by Gaussian elimination.
std::vector<double> solved(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t row = i + 1; row < n; ++row) {
      const double factor = a[row][i] / a[i][i];
      for (std::size_t column = i; column < n; ++column) a[row][column] -= factor * a[i][column];
      b[row] -= factor * b[i];
    }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t column = i + 1; column < n; ++column) b[i] -= a[i][column] * b[column];
    b[i] /= a[i][i];
  }
  return b;
}

double alike(const Block& a, const Block& b, const Given& given) {
  return correlation(given.side * std::hypot(a.first - b.first, a.second - b.second), given.length);
}

bool isNearPatch(const Block& block, const Block& at, const Given& given) {
  const auto near = [&](int one, int other) {
    return one >= other / 8 * 8 - given.reach() && one < other / 8 * 8 + 8 + given.reach();
  };
  return near(block.first, at.first) && near(block.second, at.second);
}

// Estimate of a cell (B14), (B15).
Estimate cellOf(const World& world, const Class& all, const Given& given, const Block& at) {
  const double p2 = given.p * given.p, q2 = given.q * given.q;
  const Estimate away{given.prior + all.mean, std::sqrt(p2 + all.variance)};
  std::vector<Place> places;
  std::vector<double> k;
  std::vector<std::vector<double>> matrix;
  for (const auto& [block, reads] : world) {
    if (!isNearPatch(block, at, given)) continue;
    places.push_back(placeOf(reads, given));
    k.push_back(alike(block, at, given));
    matrix.emplace_back();
    for (const auto& [other, unused] : world)
      if (isNearPatch(other, at, given))
        matrix.back().push_back(alike(block, other, given) +
                                (block == other ? places.back().variance / p2 : 0.0));
  }
  if (std::ranges::all_of(k, [](double alike) { return alike == 0.0; })) return away;
  const std::vector<double> a = solved(matrix, k);
  const double s = std::clamp(std::accumulate(a.begin(), a.end(), 0.0), 0.0, 1.0);
  double positive = 0.0, explained = 0.0, d = 0.0, shared = 0.0;
  for (const double share : a) positive += std::max(share, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double share = std::max(a[i], 0.0);
    const double y = std::min(places[i].y - all.mean, 2.0 * std::sqrt(p2 + places[i].variance));
    d += share * y * (y > 0.0 ? s / positive : 1.0);
    shared += s / positive * share * places[i].shared;
    explained += a[i] * k[i];
  }
  const double own = p2 * (1.0 - explained), o = std::min(std::sqrt(own) / given.p, 1.0);
  const double variance = withShared(own + o * o * all.e2, shared + (1.0 - s) * all.shared, p2 + q2);
  const Estimate cell{away.value + d, std::min(std::sqrt(variance), away.std)};
  if (all.agreed.may_raise) return {std::min(cell.value, given.prior + all.agreed.rise), cell.std};
  const double mean = std::min(cell.value, away.value);
  return {mean, (mean - std::min(cell.value - 6.0 * cell.std, away.value - 6.0 * away.std)) / 6.0};
}

struct Case {
  std::size_t places;
  double length, stronger, extent;
};

// A world of places on a square of a given extent, with strengths about P0 + stronger. Every sixth place
// deviates by more than the class variation explains; no place is weaker by two standard deviations.
World drivenWorld(std::mt19937_64& random, const Given& given, const Case& one) {
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const std::array<double, 2> std{uniform(0.03, 0.06), uniform(0.06, 0.25)};
  const std::array<double, 2> shared{std::max(uniform(-0.03, 0.03), 0.0), uniform(0.03, 0.06)};
  const double extent = one.extent / given.side;
  World world;
  while (world.size() < one.places) {
    auto& reads = world[{static_cast<int>(uniform(0.0, extent)), static_cast<int>(uniform(0.0, extent))}];
    if (!reads.empty()) continue;
    const double pull =
        given.prior + one.stronger + uniform(-0.05, 0.05) + (world.size() % 6 == 0 ? 0.25 : 0.0);
    for (int n = static_cast<int>(uniform(1.0, world.size() % 2 == 0 ? 31.0 : 5.0)); n > 0; --n)
      reads.push_back({pull + uniform(-0.03, 0.03), std[random() % 2], shared[random() % 2]});
  }
  return world;
}

struct Site {
  TraversabilityMap map;
  Given given;
};

Site siteOf(double length) {
  TraversabilityMap map =
      mapOf(std::vector<std::string>(kSide, std::string(kSide, '1')), 0.0, {.correlation_length_m = length});
  const GroundClass& sand = map.model().parts().classes[0];
  const Given given{.prior = map.model().prior(0).pull.value,
                    .p = sand.pull_std,
                    .q = sand.mean_std,
                    .length = length,
                    .side = 1.0 * map.evidence().blockCells()};
  return {std::move(map), given};
}

void learn(TraversabilityMap& map, const World& world) {
  const int cells = map.evidence().blockCells();
  for (const auto& [block, reads] : world)
    for (const Read& read : reads)
      map.learn({.time_s = 1.0,
                 .place = map.grid().centre({block.first * cells, block.second * cells}),
                 .pull = {read.pull, read.std},
                 .sinkage = {0.0, std::numeric_limits<double>::infinity()},
                 .shared_std = read.shared,
                 .pull_may_raise = true});
}

// Compares the class, each driven cell and every third column of every third row. Returns the number of
// cells whose estimate is neither the mean of their class nor the highest value that they may reach.
int expectAsPage(Site& site, const World& world) {
  const Given& given = site.given;
  learn(site.map, world);
  const Class all = classOf(world, given);
  const Estimate away = site.map.evidence().classBelief(0).pull;
  EXPECT_NEAR(given.prior + all.mean, away.value, kPrecision);
  EXPECT_NEAR(std::sqrt(given.p * given.p + all.variance), away.std, kPrecision);
  const int cells = site.map.evidence().blockCells();
  int between = 0;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const Block block{column / cells, row / cells};
      if (!world.contains(block) && (row % 3 > 0 || column % 3 > 0)) continue;
      const Estimate page = cellOf(world, all, given, block), is = site.map.ground({column, row})->pull;
      EXPECT_NEAR(page.value, is.value, kPrecision) << column << ' ' << row;
      EXPECT_NEAR(page.std, is.std, kPrecision) << column << ' ' << row;
      between += page.value != away.value && page.value < given.prior + all.agreed.rise ? 1 : 0;
    }
  return between;
}

// Closed form: equations of docs/belief.md, for driven cells, cells nearby and cells far away, before and
// after three places may raise the estimate.
TEST(BeliefPage, EstimateMatchesThePublishedPage) {
  std::mt19937_64 random(2);
  for (const Case& one : {Case{3, 5.0, -0.03, 20.0},
                          {5, 9.0, 0.03, 40.0},
                          {9, 5.0, 0.05, 40.0},
                          {16, 9.0, 0.02, 60.0},
                          {28, 5.0, -0.02, 28.0},
                          {40, 5.0, 0.03, 60.0}}) {
    SCOPED_TRACE(one.places);
    Site site = siteOf(one.length);
    EXPECT_GT(expectAsPage(site, drivenWorld(random, site.given, one)), 10);
  }
}

// Closed form: equations of docs/belief.md for three places. One place has a standard deviation of 0.061 or
// 0.054; another has a single reading below the class by 1.2 or 0.9 of its standard deviation.
TEST(BeliefPage, RaisingConditionMatchesThePublishedPage) {
  for (const std::size_t readings : {3U, 4U})
    for (const double single : {-0.12, -0.09}) {
      SCOPED_TRACE(readings);
      SCOPED_TRACE(single);
      Site site = siteOf(5.0);
      const double prior = site.given.prior;
      const World world{{{2, 2}, std::vector<Read>(20, {prior + 0.08, 0.05, 0.02})},
                        {{3, 4}, {{prior + single, 0.1, 0.02}}},
                        {{12, 2}, std::vector<Read>(20, {prior + 0.08, 0.05, 0.02})},
                        {{22, 2}, std::vector<Read>(readings, {prior + 0.08, 0.1, 0.02})}};
      expectAsPage(site, world);
      EXPECT_EQ(agreedOf(world, site.given).may_raise, readings == 4);
      EXPECT_EQ(agreedOf(world, site.given).rise > 0.0, readings == 4 && single > -0.1);
    }
}

}  // namespace belief_page_test
}  // namespace talus::costmap
