#include <limits>
#include <numbers>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/planner/bound/fitted_octagon.hpp>
#include <talus/planner/route/kernels.hpp>

namespace talus::planner {

namespace {

using costmap::CellCode;
using costmap::Direction;
using costmap::TravelCurve;

constexpr int kHeadings = DirectionalCostBounds::kHeadings;
constexpr double kSector = 2.0 * std::numbers::pi / kHeadings;
constexpr double kLimitRounding = 1.0 - 1e-6;  // limits and drive costs are floats
constexpr double kLittle = 1e-3;               // smallest coefficient of a heading that is taken into account
// A refused heading's limit is at least this share of each cost within the sector.
constexpr double kFalls = 0.25;
constexpr double kLeastShare = 0.25;  // smallest limit as a share of the lowest cost of the curve
constexpr double kRefused = 300.0;    // upper limit of a refused heading, as a multiple of the highest limit

using ByHeading = std::array<double, kHeadings>;

std::array<Direction, kHeadings + 1> headingTable() noexcept {
  std::array<Direction, kHeadings + 1> table;
  for (int k = 0; k <= kHeadings; ++k)
    table[static_cast<std::size_t>(k)] = {std::cos(k * kSector), std::sin(k * kSector)};
  for (std::size_t k = 0; k <= kHeadings; k += kHeadings / 4)
    table[k] = {std::round(table[k].x), std::round(table[k].y)};
  return table;
}

const std::array<Direction, kHeadings + 1> kTable = headingTable();

double cross(const Direction& a, const Direction& b) noexcept {
  return a.x * b.y - a.y * b.x;
}

int sectorOf(const Direction& d) noexcept {
  const double angle = std::atan2(d.y, d.x);
  return std::clamp(
      static_cast<int>(std::floor((angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle) / kSector)), 0,
      kHeadings - 1);
}

// Lowers each limit that exceeds the value implied by two others. The ends (unit vector / limit) are then the
// corners of a convex polygon.
void makeConvex(ByHeading& limits) noexcept {
  const double even = 2.0 * std::cos(kSector);
  bool convex = true;
  for (std::size_t k = 0; k < kHeadings; ++k)
    convex =
        convex && limits[k] * even <= limits[(k + 1) % kHeadings] + limits[(k + kHeadings - 1) % kHeadings];
  if (convex) return;
  // Scans twice around, starting at the lowest limit, whose end is a corner of the convex hull.
  const auto first = static_cast<std::size_t>(std::ranges::min_element(limits) - limits.begin());
  std::array<Direction, kHeadings> ends;
  for (std::size_t k = 0; k < kHeadings; ++k) {
    const double length = 1.0 / limits[k];
    ends[k] = {kTable[k].x * length, kTable[k].y * length};
  }
  const auto end = [&ends](std::size_t k) { return ends[k % kHeadings]; };
  std::array<std::size_t, kHeadings + 1> hull;
  std::size_t size = 0;
  for (std::size_t k = first; k <= first + kHeadings; ++k) {
    const Direction c = end(k);
    while (size >= 2) {
      const Direction a = end(hull[size - 2]), b = end(hull[size - 1]);
      if (cross({b.x - a.x, b.y - a.y}, {c.x - b.x, c.y - b.y}) > 0.0) break;
      --size;
    }
    hull[size++] = k;
  }
  for (std::size_t i = 1; i < size; ++i) {
    const Direction a = end(hull[i - 1]), b = end(hull[i]);
    for (std::size_t k = hull[i - 1] + 1; k < hull[i]; ++k) {
      const Direction& h = kTable[k % kHeadings];
      limits[k % kHeadings] = std::min(limits[k % kHeadings], cross(h, {b.x - a.x, b.y - a.y}) / cross(a, b));
    }
  }
}

}  // namespace

Direction DirectionalCostBounds::heading(int k) noexcept {
  return kTable[static_cast<std::size_t>(k)];
}

// Directions within a quarter turn at which the gradient along or across passes a table node or reaches its
// limit.
void DirectionalCostBounds::addNodes(double steepness) {
  nodes_.clear();
  const auto other = [](double share) { return std::sqrt(std::max(1.0 - share * share, 0.0)); };
  const double limit_along = cost_.limits().max_along, limit_across = cost_.limits().max_across;
  const double most_along = std::min(steepness, limit_along), most_across = std::min(steepness, limit_across);
  // Cosines of the next node along, the next node across and the two limits. Each decreases; -1 means that no
  // node is left.
  int bin = static_cast<int>(std::floor(most_along * TravelCurve::kBinsPerUnit)), row = 1;
  const double along = limit_along < steepness ? limit_along / steepness : -1.0;
  const double across = limit_across < steepness ? other(limit_across / steepness) : -1.0;
  nodes_.push_back({1.0, 0.0});
  double by_along = along, by_across = across;
  for (;;) {
    const double by_bin = bin > 0 ? bin / (steepness * TravelCurve::kBinsPerUnit) : -1.0;
    const double sine =
        row <= most_across * TravelCurve::kRowsPerUnit ? row / (steepness * TravelCurve::kRowsPerUnit) : 2.0;
    const double by_row = sine < 1.0 ? other(sine) : -1.0;
    const double next = std::max(std::max(by_bin, by_row), std::max(by_along, by_across));
    if (next < 0.0) break;
    if (next == by_bin) {
      if (by_bin < 1.0) nodes_.push_back({by_bin, other(by_bin)});
      --bin;
    } else if (next == by_row) {
      nodes_.push_back({by_row, sine});
      ++row;
    } else if (next == by_along) {
      nodes_.push_back({along, other(along)});
      by_along = -1.0;
    } else {
      nodes_.push_back({across, limit_across / steepness});
      by_across = -1.0;
    }
  }
  nodes_.push_back({0.0, 1.0});
}

// The cost has the bilinear form of one square of the table.
DirectionalCostBounds::Piece DirectionalCostBounds::pieceOf(const TravelCurve& curve, double steepness,
                                                            const Direction& from,
                                                            const Direction& to) const {
  const Piece refused{from, to, kInfinity};
  const double along = 0.5 * steepness * (from.x + to.x), across = 0.5 * steepness * (from.y + to.y);
  const double column = along * TravelCurve::kBinsPerUnit + TravelCurve::kBins / 2;
  if (!(column >= 0.0)) return refused;
  const int bin = static_cast<int>(column), row = static_cast<int>(across * TravelCurve::kRowsPerUnit);
  if (std::abs(along) > cost_.limits().max_along || across > cost_.limits().max_across) return refused;
  if (bin + 1 >= TravelCurve::kBins) return refused;
  const float* low = curve.rows() + std::min(row, curve.lastRow()) * TravelCurve::kBins + bin;
  const float* high = curve.rows() + std::min(row + 1, curve.lastRow()) * TravelCurve::kBins + bin;
  const double a = static_cast<double>(low[0]), b = static_cast<double>(low[1]) - a,
               c = static_cast<double>(high[0]) - a, d = static_cast<double>(high[1]) - a - b - c;
  if (!std::isfinite(a + b + c + d)) return refused;
  const double x = TravelCurve::kBins / 2 - bin, y = -row;  // of level ground
  const double x_per_unit = TravelCurve::kBinsPerUnit * steepness,
               y_per_unit = TravelCurve::kRowsPerUnit * steepness;
  return {from,
          to,
          a + b * x + c * y + d * x * y,
          (b + d * y) * x_per_unit,
          (c + d * x) * y_per_unit,
          d * x_per_unit * y_per_unit};
}

// Adds a single direction at which the cost is finite although the cost is infinite on one side of the
// direction.
void DirectionalCostBounds::addRefused(const TravelCurve& curve, double steepness, const Direction& at) {
  const double along = steepness * at.x, across = steepness * at.y;
  if (std::abs(along) > cost_.limits().max_along * (1.0 + 1e-9) ||
      across > cost_.limits().max_across * (1.0 + 1e-9))
    return;
  const double price = static_cast<double>(curve.price(along, across));
  if (std::isfinite(price)) pieces_.push_back({at, at, price});
}

void DirectionalCostBounds::addPieces(const TravelCurve& curve, double steepness) {
  pieces_.clear();
  const auto add = [&](const Direction& from, const Direction& to) {
    const Piece piece = pieceOf(curve, steepness, from, to);
    if (std::isinf(piece.level_J)) {
      addRefused(curve, steepness, from);
      addRefused(curve, steepness, to);
    } else {
      pieces_.push_back(piece);
    }
  };
  for (std::size_t i = 1; i < nodes_.size(); ++i) add(nodes_[i - 1], nodes_[i]);
  for (std::size_t i = nodes_.size(); i-- > 1;)
    add({-nodes_[i].x, nodes_[i].y}, {-nodes_[i - 1].x, nodes_[i - 1].y});
}

// Calls each(sector, from, to, cost_from, cost_to, bound of f'' at f = 0), in map axes, for every piece cut
// at the sector boundaries.
template <typename Each>
void DirectionalCostBounds::forEachPart(const Direction& climb, Each each) const {
  const auto ahead = [](const Direction& d, int beyond) {
    const Direction& end = kTable[static_cast<std::size_t>(beyond) + 1];
    return cross(end, d) > 0.0 && end.x * d.x + end.y * d.y > -0.5;  // a piece spans at most a quarter turn
  };
  Direction last{-climb.x, -climb.y};
  int sector = sectorOf(last);
  const auto whole = [&](const Piece& piece, const Direction& from, const Direction& to) {
    const auto cost = [&](const Direction& d) {
      const double x = d.x * climb.x + d.y * climb.y, y = std::abs(cross(climb, d));
      return piece.level_J + piece.x_J * x + (piece.y_J + piece.both_J * x) * y;
    };
    const double bend = std::max(piece.level_J, 0.0) + 1.5 * std::abs(piece.both_J);
    // Directions between two pieces are refused.
    if (last.x * from.x + last.y * from.y < 0.99) sector = sectorOf(from);
    while (ahead(from, sector)) sector = (sector + 1) % kHeadings;
    Direction begin = from;
    double begin_J = cost(from);
    for (; ahead(to, sector); sector = (sector + 1) % kHeadings) {
      const Direction& end = kTable[static_cast<std::size_t>(sector) + 1];
      const double end_J = cost(end);
      each(sector, begin, end, begin_J, end_J, bend);
      begin = end;
      begin_J = end_J;
    }
    each(sector, begin, to, begin_J, cost(to), bend);
    last = to;
  };
  // From the steepest descent, counter-clockwise.
  const auto turned = [&](const Direction& d, double side) {
    return Direction{climb.x * d.x - side * climb.y * d.y, climb.y * d.x + side * climb.x * d.y};
  };
  for (std::size_t i = pieces_.size(); i-- > 0;)
    whole(pieces_[i], turned(pieces_[i].to, -1.0), turned(pieces_[i].from, -1.0));
  for (const Piece& piece : pieces_) whole(piece, turned(piece.from, 1.0), turned(piece.to, 1.0));
}

// Returns the cost along each heading. A refused heading has the largest value for which the gauge, linear
// between the refused heading and its allowed neighbour, stays below the cost of all allowed directions
// between the two.
DirectionalCostBounds::Gauge DirectionalCostBounds::gaugeOf(CellCode cell, const Direction& climb) const {
  Gauge gauge, most;
  most.fill(kInfinity);
  double highest = 0.0;
  for (std::size_t k = 0; k < kHeadings; ++k) {
    gauge[k] = static_cast<double>(cost_.costPerMetre(cell, kTable[k]));
    if (std::isfinite(gauge[k])) highest = std::max(highest, gauge[k]);
  }
  if (std::ranges::none_of(gauge, [](double limit) { return std::isinf(limit); })) return gauge;
  forEachPart(
      climb, [&](int sector, const Direction& from, const Direction& to, double from_J, double to_J, double) {
        const auto k = static_cast<std::size_t>(sector), next = (k + 1) % kHeadings;
        const bool low = std::isinf(gauge[k]), high = std::isinf(gauge[next]);
        const auto keepBelow = [&](const Direction& d, double cost_J) {
          highest = std::max(highest, cost_J);
          // d is a positive combination of the two headings of its sector.
          const double of_next = cross(kTable[k], d) / std::sin(kSector),
                       of_k = cross(d, kTable[k + 1]) / std::sin(kSector);
          const auto lower = [cost_J](double& limit, double share, double rest_J) {
            if (share > kLittle)
              limit = std::min(limit, std::max((cost_J - rest_J) / share, kFalls * cost_J));
          };
          if (low) lower(most[k], high ? 1.0 : of_k, high ? 0.0 : of_next * gauge[next]);
          if (high) lower(most[next], low ? 1.0 : of_next, low ? 0.0 : of_k * gauge[k]);
        };
        if (!low && !high) return;
        keepBelow(from, from_J);
        keepBelow(to, to_J);
      });
  for (std::size_t k = 0; k < kHeadings; ++k)
    if (std::isinf(gauge[k])) gauge[k] = std::min(kRefused * highest, most[k]);
  return gauge;
}

// Returns the largest excess of the gauge over the cost, by sector.
DirectionalCostBounds::Gauge DirectionalCostBounds::lackOf(const Gauge& gauge, const Direction& climb) const {
  Gauge lack{};
  const double scale = 1.0 / std::sin(kSector);
  int of = -1;  // sector of `fall`, the gauge's gradient
  Direction fall;
  forEachPart(climb, [&](int sector, const Direction& from, const Direction& to, double from_J, double to_J,
                         double bend) {
    const auto k = static_cast<std::size_t>(sector);
    if (sector != of) {
      const Direction &h = kTable[k], &next = kTable[k + 1];
      const double next_J = gauge[(k + 1) % kHeadings];
      fall = {(gauge[k] * next.y - next_J * h.y) * scale, (next_J * h.x - gauge[k] * next.x) * scale};
      of = sector;
    }
    const double f = from_J - fall.x * from.x - fall.y * from.y, g = to_J - fall.x * to.x - fall.y * to.y;
    const double dx = to.x - from.x, dy = to.y - from.y;
    // 0.126 = 1/8 plus the difference of chord and arc and the variation of f between the ends
    const double dip = 0.126 * (dx * dx + dy * dy) * (bend + std::max(std::abs(f), std::abs(g)));
    lack[k] = std::max(lack[k], dip - std::min(f, g));
  });
  return lack;
}

DirectionalCostBounds::Reflected DirectionalCostBounds::reflected(CellCode cell) noexcept {
  constexpr int kLeast = -2048;  // the gradient without an opposite
  int x = cell.stepsX(), y = cell.stepsY();
  const bool west = x < 0 && x > kLeast, south = y < 0 && y > kLeast;
  if (west) x = -x;
  if (south) y = -y;
  const bool steeper_north = y > x;
  if (steeper_north) std::swap(x, y);
  return {CellCode({.dz_dx = x * CellCode::kStep, .dz_dy = y * CellCode::kStep, .curve = cell.curve()}), west,
          south, steeper_north};
}

std::uint32_t DirectionalCostBounds::numberOf(const Reflected& reflected) {
  const double x = reflected.cell.dzDx(), y = reflected.cell.dzDy();
  const bool closed = x * x + y * y > steepest_ * steepest_;
  const std::uint32_t number = numbers_.of(closed ? CellCode({.curve = CellCode::kBlocked}) : reflected.cell);
  if (number == known_.size()) {
    asked_.push_back(0);
    if (!compute(reflected.cell, known_.emplace_back())) known_.back().fill(-1.0F);
  }
  asked_[number] |= static_cast<std::uint8_t>(1U << reflected.kind());
  return number;
}

bool DirectionalCostBounds::of(CellCode cell, Limits& limits) {
  const Reflected of = reflected(cell);
  const Limits& known = reflectedLimits(numberOf(of));
  if (known.front() < 0.0F) return false;
  limits = turned(known, of);
  return true;
}

bool DirectionalCostBounds::compute(CellCode cell, Limits& limits) {
  if (cell.curve() >= cost_.curves().size()) return false;
  const double steepness = std::hypot(cell.dzDx(), cell.dzDy());
  const Direction climb =
      steepness > 0.0 ? Direction{cell.dzDx() / steepness, cell.dzDy() / steepness} : Direction{};
  addNodes(steepness);
  addPieces(cost_.curves()[cell.curve()], steepness);
  if (pieces_.empty()) return false;
  const Gauge gauge = gaugeOf(cell, climb), lack = lackOf(gauge, climb);
  const auto kept = [&](std::size_t k) {
    return 1.0 - lack[k] / std::max(std::min(gauge[k], gauge[(k + 1) % kHeadings]), 1e-300);
  };
  Gauge lowered;
  for (std::size_t k = 0; k < kHeadings; ++k)
    lowered[k] = gauge[k] * std::clamp(std::min(kept(k), kept((k + kHeadings - 1) % kHeadings)), 0.0, 1.0);
  if (*std::ranges::min_element(lowered) > 1e-6 * *std::ranges::max_element(lowered)) makeConvex(lowered);
  // Gauges below the cost can be mixed; a share of the lowest cost of the curve keeps every limit positive.
  const auto least_J = static_cast<double>(*std::ranges::min_element(cost_.curves()[cell.curve()].level()));
  const double least = *std::ranges::min_element(lowered), missing = kLeastShare * least_J - least;
  const double share = missing > 0.0 ? missing / (least_J - least) : 0.0;
  for (std::size_t k = 0; k < kHeadings; ++k)
    limits[k] = static_cast<float>((lowered[k] + share * (least_J - lowered[k])) * kLimitRounding);
  return true;
}

namespace {

constexpr std::size_t kParts = DirectionalCostBounds::kHeadings / 8;  // limits of one sector of the octagon
constexpr int kRaises = 4, kFullRaises = 3;
constexpr float kDiagonal = static_cast<float>(std::numbers::sqrt2 / 2);
constexpr float kEven = 0.92387F;  // cos(pi/8): equal weights of this share of a limit are below the limit
constexpr float kLeastOfEven = 0.25F;      // smallest weight as a share of these equal weights
constexpr float kRounding = 1.0F - 4e-6F;  // sums of floats

float more(float a, float b) noexcept {
  return a < b ? b : a;
}

// The limits of one sector, or what belongs to each of them.
using Sector = float __attribute__((vector_size(kParts * sizeof(float))));

float leastOf(const Sector& of) noexcept {
  return less(less(less(of[0], of[4]), less(of[1], of[5])), less(less(of[2], of[6]), less(of[3], of[7])));
}

// Heading j of a sector is p[j] e + q[j] f, where e and f are the headings at the ends of the sector.
struct Mix {
  Sector p{}, q{}, inverse_p{};
  Mix() noexcept {
    constexpr double part = std::numbers::pi / 4 / kParts;
    for (std::size_t j = 0; j < kParts; ++j) {
      const double of = std::sin(static_cast<double>(kParts - j) * part) * std::numbers::sqrt2;
      p[j] = static_cast<float>(of);
      q[j] = static_cast<float>(std::sin(static_cast<double>(j) * part) * std::numbers::sqrt2);
      inverse_p[j] = static_cast<float>(1.0 / of);
    }
  }
};

const Mix kMix;  // in no function, because loops must not check that it is made

// Limits of the sectors counter-clockwise and clockwise from each heading.
struct Sectors {
  std::array<Sector, 8> left, right;
  explicit Sectors(const DirectionalCostBounds::Limits& limits) noexcept {
    for (std::size_t k = 0; k < 8; ++k) {
      const float* here = &limits[k * kParts];
      const float* before = &limits[(k * kParts + limits.size() - kParts) % limits.size()];
      left[k] = Sector{here[0], here[1], here[2], here[3], here[4], here[5], here[6], here[7]};
      right[k] = Sector{here[0], before[7], before[6], before[5], before[4], before[3], before[2], before[1]};
    }
  }
};

// Largest factor, at most 1, of the weights of a sector for which they are below its limits.
float ratioOf(const Sector& limits, float left, float right) noexcept {
  return less(1.0F, leastOf(limits / (kMix.p * left + kMix.q * right)));
}

// Largest weight of heading k that the limits, its neighbours and convexity permit.
float mostAt(std::size_t k, const Sectors& sectors, const Octagon& weights) noexcept {
  const float left = weights[(k + 1) % 8], right = weights[(k + 7) % 8];
  const Sector to_left = sectors.left[k] - kMix.q * left, to_right = sectors.right[k] - kMix.q * right;
  return less((left + right) * kDiagonal,
              leastOf((to_left < to_right ? to_left : to_right) * kMix.inverse_p));
}

// Raises each weight by half of the increase permitted, all at once, then one after the other by all of it.
void raise(const Sectors& sectors, Octagon& weights) noexcept {
  for (int round = 0; round < kRaises; ++round) {
    const Octagon before = weights;
    for (std::size_t k = 0; k < 8; ++k)
      weights[k] += 0.5F * more(0.0F, mostAt(k, sectors, before) - before[k]);
  }
  for (int round = 0; round < kFullRaises; ++round)
    for (std::size_t k = 0; k < 8; ++k) weights[k] = more(weights[k], mostAt(k, sectors, weights));
}

// Lowers weights above (sum of the neighbours) / sqrt(2) until none is left; equal weights are convex, too.
void makeConvex(Octagon& weights) noexcept {
  for (int pass = 0; pass < 16; ++pass) {
    bool lowered = false;
    for (std::size_t k = 0; k < 8; ++k) {
      const float most = (weights[(k + 7) % 8] + weights[(k + 1) % 8]) * kDiagonal;
      if (!(weights[k] > most * (1.0F + 2e-7F))) continue;
      weights[k] = most;
      lowered = true;
    }
    if (!lowered) return;
  }
  weights.fill(*std::ranges::min_element(weights));
}

__attribute__((always_inline)) inline Octagon fit(const DirectionalCostBounds::Limits& limits,
                                                  const Octagon& wanted) noexcept {
  const float even = kEven * *std::ranges::min_element(limits);
  const Sectors sectors(limits);
  Octagon weights, ratio;
  for (std::size_t k = 0; k < 8; ++k) weights[k] = more(wanted[k], kLeastOfEven * even);
  for (std::size_t k = 0; k < 8; ++k) ratio[k] = ratioOf(sectors.left[k], weights[k], weights[(k + 1) % 8]);
  for (std::size_t k = 0; k < 8; ++k) weights[k] *= less(ratio[k], ratio[(k + 7) % 8]);
  raise(sectors, weights);
  makeConvex(weights);
  // Octagons below the limits can be mixed; the share of equal weights keeps every weight positive.
  const float least = *std::ranges::min_element(weights), missing = kLeastOfEven * even - least,
              share = missing > 0.0F ? missing / (even - least) : 0.0F;
  Octagon octagon;
  for (std::size_t k = 0; k < 8; ++k) octagon[k] = (weights[k] + share * (even - weights[k])) * kRounding;
  return octagon;
}

#if defined(__x86_64__)
__attribute__((target("avx2"), flatten)) Octagon fitByVector(const DirectionalCostBounds::Limits& limits,
                                                             const Octagon& wanted) noexcept {
  return fit(limits, wanted);
}
#else
constexpr auto fitByVector = fit;
#endif

}  // namespace

Octagon fittedOctagon(const DirectionalCostBounds::Limits& limits, const Octagon& wanted) {
  static const bool vectors = vectorsRun(Kernels::Best);
  return vectors ? fitByVector(limits, wanted) : fit(limits, wanted);
}

Octagon FittedOctagons::of(costmap::CellCode cell) {
  const auto reflected = DirectionalCostBounds::reflected(cell);
  const std::uint32_t number = limits_.numberOf(reflected);
  while (known_.size() <= number)
    known_.push_back(fitted(limits_.reflectedLimits(static_cast<std::uint32_t>(known_.size()))));
  Octagon octagon;
  for (int k = 0; k < 8; ++k) octagon[static_cast<std::size_t>(k)] = known_[number][reflected.heading(k, 8)];
  return octagon;
}

Octagon FittedOctagons::fitted(const DirectionalCostBounds::Limits& limits) {
  Octagon wanted;
  wanted.fill(std::numeric_limits<float>::infinity());
  if (limits.front() < 0.0F) return wanted;
  // Refused headings have high limits, which must not lower their neighbours.
  for (std::size_t k = 0; k < 8; ++k) {
    wanted[k] = limits[k * kParts];
    for (std::size_t j = 1; j < kParts; ++j)
      for (const std::size_t i : {k * kParts + j, k * kParts + limits.size() - j})
        wanted[k] = std::min(wanted[k], kEven * limits[i % limits.size()]);
  }
  return fittedOctagon(limits, wanted);
}

}  // namespace talus::planner
