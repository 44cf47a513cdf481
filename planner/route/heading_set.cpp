#include <numbers>
#include <utility>

#include <talus/planner/route/heading_set.hpp>

namespace talus::planner {

namespace {

using std::numbers::pi;

double wrapped(double angle_rad) noexcept {
  const double turned = std::fmod(angle_rad, HeadingSet::kTurn);
  return turned < 0.0 ? turned + HeadingSet::kTurn : turned;
}

using costmap::TravelCurve;

// Gradients along the heading at which the cost becomes finite or infinite in some row: adjacent nodes, and
// the limits.
std::vector<double> limitsAlong(const costmap::TravelCost& cost, const TravelCurve& curve) {
  std::vector<double> limits{cost.limits().max_along, -cost.limits().max_along, TravelCurve::gradient(0),
                             TravelCurve::gradient(TravelCurve::kBins - 1)};
  const auto finite = [&](int row, int bin) {
    return std::isfinite(curve.rows()[static_cast<std::size_t>(row * TravelCurve::kBins + bin)]);
  };
  for (int bin = 1; bin < TravelCurve::kBins; ++bin) {
    bool changes = false;
    for (int row = 0; row <= curve.lastRow(); ++row)
      changes = changes || finite(row, bin) != finite(row, bin - 1);
    if (!changes) continue;
    limits.push_back(TravelCurve::gradient(bin - 1));
    limits.push_back(TravelCurve::gradient(bin));
  }
  return limits;
}

// Magnitudes of gradients across the heading at which the permitted gradients along the heading change, and
// the limit.
std::vector<double> limitsAcross(const costmap::TravelCost& cost, const TravelCurve& curve) {
  std::vector<double> limits{cost.limits().max_across};
  const auto finite = [](float value) { return std::isfinite(value); };
  for (int row = 0; row < curve.lastRow(); ++row) {
    const float* here = curve.rows() + row * TravelCurve::kBins;
    if (std::equal(here, here + TravelCurve::kBins, here + TravelCurve::kBins,
                   [&](float a, float b) { return finite(a) == finite(b); }))
      continue;
    limits.push_back(static_cast<double>(row) / TravelCurve::kRowsPerUnit);
    limits.push_back((row + 1.0) / TravelCurve::kRowsPerUnit);
  }
  return limits;
}

// Headings at which the gradient along or across equals one of the limits.
std::vector<double> turningPoints(const HeadingSets::Limits& limits, costmap::CellCode cell) {
  const double steepest = std::hypot(cell.dzDx(), cell.dzDy()), up = std::atan2(cell.dzDy(), cell.dzDx());
  std::vector<double> angles;
  for (const double along : limits.along) {
    if (!(std::abs(along) <= steepest)) continue;
    const double off = std::acos(along / steepest);
    angles.push_back(wrapped(up + off));
    angles.push_back(wrapped(up - off));
  }
  for (const double across : limits.across) {
    if (!(across <= steepest)) continue;
    const double off = std::asin(across / steepest);
    for (const double side : {off, -off}) {
      angles.push_back(wrapped(up + side));
      angles.push_back(wrapped(up + pi + side));
    }
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

constexpr double kRounding = 1e-7;  // rad

}  // namespace

// A refused node refuses all combinations within the distance of one node; the limits and the end of the
// table refuse all combinations beyond them.
double gentleGradient(const costmap::TravelCost& cost, const TravelCurve& curve) {
  constexpr double kBin = 1.0 / TravelCurve::kBinsPerUnit, kRow = 1.0 / TravelCurve::kRowsPerUnit;
  double least = std::min({cost.limits().max_along, cost.limits().max_across,
                           TravelCurve::gradient(TravelCurve::kBins - 1) - kBin});
  for (int row = 0; row <= curve.lastRow(); ++row)
    for (int bin = 0; bin < TravelCurve::kBins; ++bin) {
      if (std::isfinite(curve.rows()[row * TravelCurve::kBins + bin])) continue;
      least = std::min(least, std::hypot(std::max(0.0, std::abs(TravelCurve::gradient(bin)) - kBin),
                                         std::max(0.0, (row - 1) * kRow)));
    }
  return least;
}

HeadingSet::HeadingSet(std::vector<HeadingArc> arcs) {
  std::sort(arcs.begin(), arcs.end(), [](const auto& a, const auto& b) { return a.from_rad < b.from_rad; });
  for (const HeadingArc& arc : arcs) {
    if (!arcs_.empty() && arc.from_rad <= arcs_.back().from_rad + arcs_.back().width_rad)
      arcs_.back().width_rad =
          std::max(arcs_.back().width_rad, arc.from_rad + arc.width_rad - arcs_.back().from_rad);
    else
      arcs_.push_back(arc);
  }
  // The last arc may overlap the first arcs across 2 pi.
  while (arcs_.size() > 1 &&
         arcs_.back().from_rad + arcs_.back().width_rad >= arcs_.front().from_rad + kTurn) {
    const double end = arcs_.front().from_rad + arcs_.front().width_rad + kTurn;
    arcs_.back().width_rad = std::max(arcs_.back().width_rad, end - arcs_.back().from_rad);
    arcs_.erase(arcs_.begin());
  }
  if (arcs_.size() == 1 && arcs_[0].width_rad >= kTurn) arcs_[0] = {0.0, kTurn};
}

HeadingSet::Gap HeadingSet::widestGap() const noexcept {
  Gap widest{0.0, -1.0};
  for (std::size_t k = 0; k < arcs_.size(); ++k) {
    const double end = arcs_[k].from_rad + arcs_[k].width_rad;
    const double next = k + 1 < arcs_.size() ? arcs_[k + 1].from_rad : arcs_[0].from_rad + kTurn;
    if (next - end > widest.width_rad) widest = {wrapped(end), next - end};
  }
  return widest;
}

HeadingSet HeadingSet::shared(const HeadingSet& other) const {
  std::vector<HeadingArc> both;
  for (const HeadingArc& a : arcs_)
    for (const HeadingArc& b : other.arcs_)
      for (const double turns : {-kTurn, 0.0, kTurn}) {
        const double from = std::max(a.from_rad, b.from_rad + turns);
        const double to = std::min(a.from_rad + a.width_rad, b.from_rad + turns + b.width_rad);
        if (from <= to) both.push_back({wrapped(from), to - from});
      }
  return HeadingSet(std::move(both));
}

double HeadingSet::nearest(double heading_rad) const noexcept {
  double best = heading_rad, best_off = 2.0 * kTurn;
  for (const HeadingArc& arc : arcs_) {
    const double ahead = wrapped(heading_rad - arc.from_rad);
    // Inside the arc, or its end that is nearer on the circle.
    double at = std::min(ahead, arc.width_rad);
    if (ahead > arc.width_rad && kTurn - ahead < ahead - arc.width_rad) at = 0.0;
    const double off = std::abs(std::remainder(arc.from_rad + at - heading_rad, kTurn));
    if (off < best_off) {
      best_off = off;
      best = wrapped(arc.from_rad + at);
    }
  }
  return best;
}

HeadingSet HeadingSet::reversed() const {
  std::vector<HeadingArc> opposite;
  for (const HeadingArc& arc : arcs_) opposite.push_back({wrapped(arc.from_rad + pi), arc.width_rad});
  return HeadingSet(std::move(opposite));
}

HeadingSets::Limits::Limits(const costmap::TravelCost& cost, const costmap::TravelCurve& curve)
    : along(limitsAlong(cost, curve)),
      across(limitsAcross(cost, curve)),
      gentle(gentleGradient(cost, curve)) {
  for (std::vector<double>* limits : {&along, &across}) {
    std::ranges::sort(*limits);
    limits->erase(std::unique(limits->begin(), limits->end()), limits->end());
  }
}

HeadingSet allowedHeadings(const costmap::TravelCost& cost, costmap::CellCode cell) {
  if (cell.curve() >= cost.curves().size()) return {};
  return allowedHeadings(cost, cell, {cost, cost.curves()[cell.curve()]});
}

HeadingSet allowedHeadings(const costmap::TravelCost& cost, costmap::CellCode cell,
                           const HeadingSets::Limits& limits) {
  const auto finite = [&](double heading) {
    return std::isfinite(cost.costPerMetre(cell, {std::cos(heading), std::sin(heading)}));
  };
  const std::vector<double> turns = turningPoints(limits, cell);
  if (turns.empty()) return finite(0.0) ? HeadingSet({{0.0, HeadingSet::kTurn}}) : HeadingSet();
  std::vector<HeadingArc> arcs;
  const auto add = [&](double from, double width) {
    arcs.push_back({wrapped(from - kRounding), std::min(HeadingSet::kTurn, width + 2.0 * kRounding)});
  };
  bool before = finite(0.5 * (turns.back() + turns[0] + HeadingSet::kTurn));
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const double next = k + 1 < turns.size() ? turns[k + 1] : turns[0] + HeadingSet::kTurn;
    const bool after = finite(0.5 * (turns[k] + next));
    if (after) add(turns[k], next - turns[k]);
    if (!before && !after && finite(turns[k])) add(turns[k], 0.0);
    before = after;
  }
  return HeadingSet(std::move(arcs));
}

const HeadingSet& HeadingSets::known(costmap::CellCode cell) {
  const auto found = sets_.find(cell.number());
  if (found != sets_.end()) return found->second;
  HeadingSet set;
  if (cell.curve() == free_) {
    set = HeadingSet({{0.0, HeadingSet::kTurn}});
  } else if (cell.curve() < cost_.curves().size()) {
    auto& limits = limits_[cell.curve()];
    if (!limits) {
      limits.emplace(cost_, cost_.curves()[cell.curve()]);
      gentle_[cell.curve()] = limits->gentle * limits->gentle;
    }
    set = allowedHeadings(cost_, cell, *limits);
  }
  return sets_.try_emplace(cell.number(), set, &arena_).first->second;
}

}  // namespace talus::planner
