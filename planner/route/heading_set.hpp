#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <new>
#include <optional>
#include <unordered_map>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>

namespace talus::planner {

/// Returns the signed smaller angle from heading `from` to heading `to`, (-pi, pi]; left > 0.
inline double turnBetween_rad(costmap::Direction from, costmap::Direction to) noexcept {
  return std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y);
}

/// Returns true if `holds`(heading) is true at all sampled headings between two headings, on the side of the
/// smaller angle. The samples are at most `apart_rad` > 0 apart; `from` and `to` themselves are excluded.
template <typename Holds>
bool holdsBetween(costmap::Direction from, costmap::Direction to, double apart_rad, Holds holds) {
  const double turn_rad = turnBetween_rad(from, to);
  const int parts = static_cast<int>(std::ceil(std::abs(turn_rad) / apart_rad));
  for (int k = 1; k < parts; ++k) {
    const double by = turn_rad * k / parts, c = std::cos(by), s = std::sin(by);
    if (!holds(costmap::Direction{from.x * c - from.y * s, from.x * s + from.y * c})) return false;
  }
  return true;
}

/// Cost per metre for a fixed heading, for loops over many cells. The values are bit-identical to those of
/// TravelCost::costPerMetre(). The TravelCost must outlive the object.
class HeadingCost {
 public:
  HeadingCost(const costmap::TravelCost& cost, costmap::Direction heading) noexcept
      : HeadingCost(cost, heading.x * costmap::CellCode::kStep, heading.y * costmap::CellCode::kStep) {}

  /// (x, y) is the unit vector of the heading times CellCode::kStep.
  HeadingCost(const costmap::TravelCost& cost, double x, double y) noexcept
      : curves_(cost.curves().data()),
        curve_count_(cost.curves().size()),
        max_along_(cost.limits().max_along),
        max_across_(cost.limits().max_across),
        x_(x),
        y_(y) {}

  /// Returns the cost per horizontal metre [J/m] on a cell; infinite if the cell does not permit the heading.
  float operator()(costmap::CellCode cell) const noexcept {
    if (cell.curve() >= curve_count_) return kBlocked;
    const double along = cell.stepsX() * x_ + cell.stepsY() * y_;
    const double across = cell.stepsY() * x_ - cell.stepsX() * y_;
    if (!(std::abs(along) <= max_along_ && std::abs(across) <= max_across_)) return kBlocked;
    return curves_[cell.curve()].price(along, across);
  }

 private:
  static constexpr float kBlocked = std::numeric_limits<float>::infinity();

  const costmap::TravelCurve* curves_;
  std::size_t curve_count_;
  double max_along_, max_across_;
  double x_, y_;  // unit vector of the heading times CellCode::kStep
};

/// Closed interval of headings, from `from_rad` counter-clockwise over `width_rad`.
struct HeadingArc {
  double from_rad = 0.0;   ///< first heading, counter-clockwise from x (east), [0, 2 pi)
  double width_rad = 0.0;  ///< width of the interval, [0, 2 pi]
};

/// Set of headings, stored as closed, disjoint arcs (intervals of headings) in order of their first headings.
class HeadingSet {
 public:
  HeadingSet() = default;
  /// `arcs` may have any order and may overlap; each arc must be in the ranges of HeadingArc.
  explicit HeadingSet(std::vector<HeadingArc> arcs);
  /// Copies a set; the memory of the copy is allocated from `memory`, which must outlive the copy.
  HeadingSet(const HeadingSet& other, std::pmr::memory_resource* memory) : arcs_(other.arcs_, memory) {}

  const std::pmr::vector<HeadingArc>& arcs() const noexcept { return arcs_; }
  bool empty() const noexcept { return arcs_.empty(); }
  /// Returns true if the set contains every heading.
  bool all() const noexcept { return arcs_.size() == 1 && arcs_[0].width_rad >= kTurn; }

  /// Widest gap between two arcs of a set: its width, and the last heading of the arc clockwise of the gap. A
  /// rover that alternates between headings of the set can move in every direction if the gap is narrower
  /// than pi. Otherwise it can move in the directions from `end_rad + width_rad` counter-clockwise to
  /// `end_rad`.
  struct Gap {
    double end_rad;
    double width_rad;
  };
  /// Returns the widest gap. The set must not be empty.
  Gap widestGap() const noexcept;

  /// Returns the intersection of this set and `other`.
  HeadingSet shared(const HeadingSet& other) const;

  /// Returns the heading of the set that is nearest to `heading_rad`. The set must not be empty.
  double nearest(double heading_rad) const noexcept;

  /// Returns the set of the opposite headings.
  HeadingSet reversed() const;

  /// Full turn [rad].
  static constexpr double kTurn = 6.283185307179586;

 private:
  std::pmr::vector<HeadingArc> arcs_;
};

/// Returns the gradient below which a cell with this cost curve permits all headings; 0: no such gradient.
double gentleGradient(const costmap::TravelCost& cost, const costmap::TravelCurve& curve);

/// Cache of allowedHeadings() by cell code. A cell code contains the gradient of a cell and the index of its
/// cost curve (costmap::TravelCurve: cost per metre on one kind of ground over the gradients along and across
/// the heading). Cells with the cost-curve index `free`, if given, permit every heading. Large maps have
/// millions of different codes; therefore the sets are allocated in an arena, which is released as a whole.
/// Not thread-safe; the TravelCost must outlive the object.
class HeadingSets {
 public:
  explicit HeadingSets(const costmap::TravelCost& cost, std::optional<costmap::CellCode::Curve> free = {})
      : cost_(cost),
        free_(free),
        sets_(*new (arena_.allocate(sizeof(Sets), alignof(Sets))) Sets(&arena_)),
        limits_(cost.curves().size()),
        gentle_(cost.curves().size()),
        recent_(std::size_t{1} << kRecentBits) {}
  HeadingSets(const HeadingSets&) = delete;
  HeadingSets& operator=(const HeadingSets&) = delete;
  /// Returns the allowed headings of a cell with the given code.
  const HeadingSet& of(costmap::CellCode cell) {
    if (cell.curve() < gentle_.size() &&
        cell.dzDx() * cell.dzDx() + cell.dzDy() * cell.dzDy() < gentle_[cell.curve()])
      return all_;
    Recent& recent = recent_[cell.recentSlot(kRecentBits)];
    if (recent.set != nullptr && recent.code == cell.number()) return *recent.set;
    const HeadingSet& set = known(cell);
    recent = {cell.number(), &set};
    return set;
  }

  /// Gradients at which the cost of a cost curve may change between finite and infinite: signed gradients
  /// along the heading, and magnitudes of gradients across the heading.
  struct Limits {
    Limits(const costmap::TravelCost& cost, const costmap::TravelCurve& curve);
    std::vector<double> along, across;
    double gentle;  ///< gentleGradient()
  };

 private:
  // Cell code and heading set of a recent call of of(), because neighbouring cells have equal codes. Sets in
  // sets_ keep their address.
  struct Recent {
    std::uint64_t code = 0;
    const HeadingSet* set = nullptr;
  };
  static constexpr int kRecentBits = 12;

  const HeadingSet& known(costmap::CellCode cell);

  using Sets = std::pmr::unordered_map<std::uint64_t, HeadingSet>;

  const costmap::TravelCost& cost_;
  std::optional<costmap::CellCode::Curve> free_;
  std::pmr::monotonic_buffer_resource arena_;
  Sets& sets_;  // in the arena, never destroyed: destruction delayed a stopped plan by 0.5 s
  std::vector<std::optional<Limits>> limits_;
  std::vector<double> gentle_;  // squared Limits::gentle of each cost curve; 0 until computed
  const HeadingSet all_{{{0.0, HeadingSet::kTurn}}};
  std::vector<Recent> recent_;
};

/// Returns the headings for which the cost of a cell is finite. When the heading turns, the gradients along
/// and across the heading pass nodes of the cost table. Between two consecutive such headings the cost is
/// either finite everywhere or infinite everywhere. Therefore one evaluation between each pair and one at
/// each heading are sufficient. Arcs are widened by 1e-7 rad, so that rounding excludes no permitted heading.
/// `limits` are the gradients of the cost curve of the cell.
HeadingSet allowedHeadings(const costmap::TravelCost& cost, costmap::CellCode cell);
HeadingSet allowedHeadings(const costmap::TravelCost& cost, costmap::CellCode cell,
                           const HeadingSets::Limits& limits);

}  // namespace talus::planner
