#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <talus/costmap/cost/travel_state.hpp>

namespace talus::terramech {
class RoverStance;
}

namespace talus::costmap {

/// A heading (horizontal direction of travel) as a unit vector in the map frame (x east, y north).
struct Direction {
  double x = 1.0;
  double y = 0.0;
};

/// Cell code: planner data of one cell in 6 bytes. It contains the gradient of the fitted plane under the
/// rover and the index of a cost curve (TravelCurve). dz/dx and dz/dy are stored in steps of 1/1024 (rise
/// over run, error at most half a step), clamped to [-2, 2).
class CellCode {
 public:
  using Curve = std::uint16_t;              ///< index of a cost curve
  static constexpr Curve kUnknown = 65534;  ///< curve index of an unobserved cell
  static constexpr Curve kBlocked = 65535;  ///< curve index of a cell that no heading may enter

  /// The values of a cell code.
  struct Parts {
    double dz_dx = 0.0;  ///< gradient eastward, rise over run [-]
    double dz_dy = 0.0;  ///< gradient northward, rise over run [-]
    /// Index of the cost curve, kUnknown or kBlocked.
    Curve curve = kUnknown;
  };

  CellCode() : CellCode(Parts{}) {}
  explicit CellCode(const Parts& parts)
      : steps_x_(quantised(parts.dz_dx)), steps_y_(quantised(parts.dz_dy)), curve_(parts.curve) {}

  /// Gradients of the plane eastward and northward [-].
  double dzDx() const noexcept { return static_cast<double>(stepsX()) * kStep; }
  double dzDy() const noexcept { return static_cast<double>(stepsY()) * kStep; }
  /// Gradients of the plane eastward and northward, in steps of kStep.
  int stepsX() const noexcept { return steps_x_; }
  int stepsY() const noexcept { return steps_y_; }
  /// Returns the code with an unchanged gradient and another curve index.
  CellCode withCurve(Curve curve) const noexcept {
    CellCode code = *this;
    code.curve_ = curve;
    return code;
  }
  Curve curve() const noexcept { return curve_; }
  /// Returns the code as a number. recentSlot() returns a hash value of `bits` bits, for caches of recent codes.
  std::uint64_t number() const noexcept {
    const auto of = [](std::int16_t steps) { return std::uint64_t{static_cast<std::uint16_t>(steps)}; };
    return of(steps_x_) << 32 | of(steps_y_) << 16 | curve_;
  }
  std::size_t recentSlot(int bits) const noexcept {
    return static_cast<std::size_t>((number() * 0x9e3779b97f4a7c15U) >> (64 - bits));
  }

  friend bool operator==(CellCode, CellCode) = default;

  /// Step of the gradients [-].
  static constexpr double kStep = 1.0 / 1024.0;

 private:
  static std::int16_t quantised(double gradient) noexcept;

  std::int16_t steps_x_, steps_y_;
  Curve curve_;
};

/// Cost curve: cost per horizontal metre on ground of one estimated strength, tabulated over two gradients.
/// The gradient along the heading (rise over run, climbing > 0) has kBins nodes at k/256, k = -256..255. The
/// magnitude of the gradient across the heading has rows at multiples of 1/64. Costs are interpolated
/// bilinearly between nodes, and are infinite for a refused motion: price() is finite only if every node of
/// positive weight is finite.
struct TravelCurve {
  static constexpr int kBins = 512;
  static constexpr int kBinsPerUnit = 256;
  static constexpr int kRowsPerUnit = 64;
  static constexpr double kSame = 1e-9;  ///< tolerance for positions on a node [bins or rows]
  /// Upper bound of positions along the heading, exclusive [bins].
  static constexpr double kLastPlace = kBins - 1 - kSame;
  /// Row 0, i.e. costs without a gradient across: energy + weighted time + weighted risk [J/m].
  std::array<float, kBins> cost_J_per_m;
  /// Costs of all rows, row 0 first; gradients across beyond the last row use the last row. Null: a gradient
  /// across adds no cost. Costs must not decrease from row to row in any bin, because the lower bounds of the
  /// planners rely on this.
  std::shared_ptr<const std::vector<float>> crossing{};

  /// Returns the bin of the node nearest to a gradient along the heading; outside 0..kBins-1 for a gradient
  /// outside the table.
  static int bin(double gradient) noexcept;
  /// Returns the gradient at a node, or at a position between nodes [bins].
  static constexpr double gradient(double bin) noexcept { return (bin - 0.5 * kBins) / kBinsPerUnit; }
  /// Returns the first row whose gradient is at least |across|.
  static int row(double across) noexcept {
    const Between at = between((across < 0.0 ? -across : across) * kRowsPerUnit);
    return at.whole + static_cast<int>(at.share > 0.0F);
  }

  /// A position between two nodes: `whole` is the index of the node at or before the position, and `share` is
  /// the fraction of the distance to the next node.
  struct Between {
    int whole;
    float share;  ///< 0 to 1 [-]
  };
  static Between between(double place) noexcept {
    const int whole = static_cast<int>(place + kSame);
    const double rest = place - whole;
    return {whole, rest > kSame ? static_cast<float>(rest) : 0.0F};
  }

  /// rows() returns the costs [J/m] of all nodes, row by row, with kBins costs per row. lastRow() returns the
  /// index of the last row.
  const float* rows() const noexcept { return crossing ? crossing->data() : cost_J_per_m.data(); }
  int lastRow() const noexcept { return crossing ? static_cast<int>(crossing->size()) / kBins - 1 : 0; }

  /// Returns the cost [J/m] at the gradients `along` and `across` the heading, both |g| <= 2; infinite
  /// outside the table.
  float price(double along, double across) const noexcept {
    constexpr float blocked = std::numeric_limits<float>::infinity();
    const double place = along * kBinsPerUnit + kBins / 2;
    if (!(place >= 0.0 && place < kLastPlace)) return blocked;
    const Between bin = between(place), row = between((across < 0.0 ? -across : across) * kRowsPerUnit);
    const int last = lastRow(), next_bin = bin.share > 0.0F ? 1 : 0,
              next_row = row.whole + (row.share > 0.0F ? 1 : 0);
    const float* low = rows() + (row.whole < last ? row.whole : last) * kBins + bin.whole;
    const float* high = rows() + (next_row < last ? next_row : last) * kBins + bin.whole;
    const float a = low[0], b = low[next_bin], c = high[0], d = high[next_bin];
    if (!(a < blocked && b < blocked && c < blocked && d < blocked)) return blocked;
    const float below = a + bin.share * (b - a), above = c + bin.share * (d - c);
    return below + row.share * (above - below);
  }
};

class TravelStates;

/// Weights of the cost function: cost = energy * energy_J + time_W * time_s + risk_J * hazard, where `hazard`
/// is TravelState::risk_per_m.
struct CostWeights {
  double energy = 1.0;  ///< weight of energy, >= 0 [-]
  double time_W = 1.0;  ///< weight of time, >= 0 [J/s]
  double risk_J = 1e7;  ///< cost of the loss of the rover, >= 0 [J]
};

/// Cost of a turn by one radian, or of a change of direction, in addition to the cost of the path length.
struct TurnCost {
  double cost_J = 0.0;    ///< weighted cost by the cost function, >= 0
  double energy_J = 0.0;  ///< energy of the turn, >= 0
  double time_s = 0.0;    ///< >= 0
};

/// Costs of a turn by one radian on ground of one estimated strength, for three ways to turn.
struct TurnCosts {
  /// Turn while driving on an arc.
  TurnCost on_arc;
  /// Turn on the spot.
  TurnCost in_place;
  /// Change of direction at a vertex of a polyline: in place if the rover can turn in place, otherwise on an
  /// arc.
  TurnCost at_vertex;
};

/// Cost curve of ground of one estimated strength, and the travel states from which the costs follow.
struct GroundCost {
  TravelCurve curve;
  std::shared_ptr<const TravelStates> states;  ///< may be null if details are not needed (tests)
  TurnCosts turns{};  ///< costs of a turn by one radian on level ground; zeros if turning is free (tests)
};

/// Slip angle, side force and stability margin of a rover on a slope, on the soil of the terrain class.
/// Values are NaN on a slope without an equilibrium.
struct SlopeHold {
  /// Slip angle: angle from the wheel planes to the direction of travel, left positive, as in
  /// terramech::SlopeState. It is negative where the ground rises to the left, because the wheels are turned
  /// uphill.
  double slip_angle_rad = std::numeric_limits<double>::quiet_NaN();
  /// Greatest side force over load |F|/N of a wheel [-].
  double side_force_over_load = std::numeric_limits<double>::quiet_NaN();
  /// Additional tilt until the rover tips; NaN also for a rover whose height of the centre of mass is
  /// unknown.
  double stability_margin_rad = std::numeric_limits<double>::quiet_NaN();
};

/// Energy and time per horizontal metre on ground whose strength departs from its mean by deviate(k) standard
/// deviations. A motion that fails there has the values of the least strength at which it does not.
struct TravelForecast {
  static constexpr int kDeviates = 9;
  static constexpr double deviate(int k) noexcept { return -2.0 + 0.5 * k; }
  std::array<float, kDeviates> energy_J_per_m{}, time_s_per_m{};
  double fails_below = -10.0;  ///< departure below which the motion fails, in standard deviations
};

/// Correlation of the soil uncertainty between places of a route, and the consequence of insufficient drawbar
/// pull.
struct SoilUncertainty {
  /// Correlation length of the soil; 0: unknown, the metres of a route count as independent.
  double correlation_length_m = 0.0;
  /// Probability that a place with insufficient drawbar pull immobilises the rover [-].
  double entrapment = 1.0;
  /// Fraction of the variance of the drawbar pull that all places of a class share, by class index [-].
  std::vector<double> shared{};
};

/// Cost function of a map, shared by planners, route checks and reports. It combines the cost curves with
/// limits that apply to every ground. Immutable and thread-safe.
class TravelCost {
 public:
  /// Limits that apply to every ground; gradients are rise over run.
  struct Limits {
    double max_along = 0.36;   ///< greatest gradient along the heading, tan(max pitch)
    double max_across = 0.36;  ///< greatest gradient across the heading, tan(max roll)
    /// Geometry for the tipping limit; null: the rover never tips.
    std::shared_ptr<const terramech::RoverStance> stance{};
    /// Dimensions of the rover in the map plane; zeros: not known.
    struct Outline {
      double wheelbase_m = 0.0, track_m = 0.0;  ///< distances of the outermost wheels
      double width_m = 0.0;                     ///< width over the wheels
    } outline{};
  };

  /// Makes the cost function from cost curves in the order of their indices, at most 65534. Throws
  /// std::invalid_argument for more curves.
  TravelCost(const Limits& limits, std::vector<TravelCurve> curves);
  TravelCost(const Limits& limits, const std::vector<GroundCost>& grounds, SoilUncertainty uncertainty = {});

  /// Returns the cost [J/m] of one horizontal metre over the cell in a heading; infinite for a refused
  /// motion.
  float costPerMetre(CellCode cell, Direction heading) const noexcept;

  /// Returns the travel state from which costPerMetre() follows. The cost is finite if and only if
  /// TravelState::refusal is None. For a curve without states, the quantities are 0 and the category is
  /// Unknown.
  TravelState detail(CellCode cell, Direction heading) const noexcept;

  /// Returns slip angle, side force and stability margin on the cell in a heading.
  SlopeHold hold(CellCode cell, Direction heading) const noexcept;

  /// Returns energy and time of a horizontal metre over the strength of the ground; zeros without states.
  TravelForecast forecast(CellCode cell, Direction heading) const noexcept;

  /// Returns the gradient of the straight climb that requires the same strength as the plane of the cell in a
  /// heading; without states the gradient along the heading.
  double climb(CellCode cell, Direction heading) const noexcept;

  /// Returns the cost of a turn by one radian at a vertex of a route on this cell; 0 on cells without a cost
  /// curve. turns() returns the costs of turns by curve index.
  TurnCost turn(CellCode cell) const noexcept {
    return cell.curve() < turns_.size() ? turns_[cell.curve()].at_vertex : TurnCost{};
  }
  const std::vector<TurnCosts>& turns() const noexcept { return turns_; }

  /// Returns true if the rover tips on the cell with this heading, standing or turning in place, on any soil.
  bool tips(CellCode cell, Direction heading) const noexcept;
  /// Returns true if the cell is so steep that the rover may tip in some heading.
  bool mayTip(CellCode cell) const noexcept;

  const Limits& limits() const noexcept { return limits_; }
  /// Returns the correlation of the soil uncertainty, for the risk of a whole route.
  const SoilUncertainty& uncertainty() const noexcept { return uncertainty_; }
  const std::vector<TravelCurve>& curves() const noexcept { return curves_; }
  /// Returns the travel states by curve index; null for a curve without states.
  const std::vector<std::shared_ptr<const TravelStates>>& states() const noexcept { return states_; }

 private:
  const TravelStates* statesOf(CellCode cell) const noexcept {
    return cell.curve() < states_.size() ? states_[cell.curve()].get() : nullptr;
  }

  Limits limits_;
  std::vector<TravelCurve> curves_;
  std::vector<std::shared_ptr<const TravelStates>> states_;
  std::vector<TurnCosts> turns_;
  double steady_gradient_;  // gradient up to which the rover tips in no heading
  SoilUncertainty uncertainty_;
};

}  // namespace talus::costmap
