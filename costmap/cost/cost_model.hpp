#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/maps/maps.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::terramech {
class RoverStance;
}

namespace talus::costmap {

/// Permissions and cost weights of a mission. Plain data. The categories of ground are safe, marginal and
/// dangerous.
struct TravelPolicy {
  /// True if ground is allowed whose category at the slope along the heading is marginal.
  bool allow_marginal = true;
  /// True if dangerous ground is allowed where the soil supports the required pull.
  bool allow_dangerous = false;
  /// True if cells without elevation are allowed, with the slope of unseenSlope(), as ground of their terrain
  /// class or, without a class, of the model's first class. Such a cell is refused if that slope is too
  /// steep.
  bool allow_unknown = false;

  /// Margin of the category limits, which are tan(slope -+ margin); thesis 3.5: 5 deg.
  double slope_margin_rad = 5.0 * kDegree;
  /// Greatest sinkage over wheel radius z/r that does not affect the category (thesis 3.5) [-].
  double sinkage_threshold = 0.5;
  /// z/r above which ground is dangerous [-]; 0: the clearance of the rover over the wheel radius is used.
  double sinkage_critical = 0.0;
  /// Greatest allowed probability that the drawbar pull is insufficient [-]; other ground is refused.
  double max_immobilisation = 0.5;

  /// Greatest position error of the rover, which enlarges the area whose soil is evaluated for a cell.
  double pose_error_m = 0.0;

  double time_weight_W = 1.0;  ///< weight of time [J/s]
  /// Probability that insufficient drawbar pull immobilises a rover with slip monitoring, which usually stops
  /// and backs out (ours, not from the literature) [-].
  double entrapment = 0.01;
  /// Probability that insufficient drawbar pull immobilises a rover without slip monitoring [-].
  double unmonitored_entrapment = 1.0;
  bool unmonitored = false;           ///< true if this drive has no slip monitoring
  double risk_weight_J = 1e8;         ///< cost of the loss of the rover [J]
  double correlation_length_m = 5.0;  ///< correlation length of the soil within one class

  /// Returns the probability that insufficient drawbar pull immobilises the rover on this drive [-].
  double held() const noexcept { return unmonitored ? unmonitored_entrapment : entrapment; }

  bool operator==(const TravelPolicy&) const = default;
};

/// Reason for which a motion over a cell in one heading is refused, i.e. has infinite cost.
enum class Refusal : std::uint8_t {
  None,       ///< the motion is allowed
  Unknown,    ///< the cell is unobserved
  Blocked,    ///< a hazard of the cell refuses every heading; the map has the hazard
  Pitch,      ///< the gradient along the heading exceeds the pitch limit
  Roll,       ///< the gradient across the heading exceeds the roll limit
  Pull,       ///< the required drawbar pull exceeds the available drawbar pull
  SideForce,  ///< the required side force exceeds the side force that is available at the required pull
  Torque,     ///< the required torque exceeds the torque of the motors
  Sinkage,    ///< the wheels sink so deep that the belly touches the ground
  Category,   ///< the policy does not allow the category of the ground at this slope
  Tips,       ///< the rover tips: the centre of mass is beyond the line between wheel contacts
  Stated,     ///< no cost, or an infinite cost, is stated for the gradient
};

/// Returns the reason as text, e.g. "required drawbar pull above the available drawbar pull".
const char* toText(Refusal refusal) noexcept;

/// State of a rover that drives over ground of one estimated strength at one gradient: the quantities from
/// which the cost follows. Quantities are those of the rover unless marked "per wheel". Metres are
/// horizontal.
struct TravelState {
  float slip = 0.0F;            ///< slip [-]; positive for driven, negative for braked wheels
  float sinkage_m = 0.0F;       ///< sinkage, per wheel
  float torque_Nm = 0.0F;       ///< torque, per wheel
  float energy_J_per_m = 0.0F;  ///< drive and hotel energy; expected value over the strengths that hold
  float time_s_per_m = 0.0F;    ///< driving time; expected value over the strengths that hold
  /// Hazard rate of immobilisation [1/m]: the probability of immobilisation over d metres is 1 -
  /// exp(-risk_per_m d).
  float risk_per_m = 0.0F;
  float weak = 0.0F;  ///< probability that the available pull is below the required pull, 0 to 1 [-]
  /// Available drawbar pull over load DP/W at the reference slip 0.5 minus the required DP/W [-].
  float pull_margin = 0.0F;
  /// Angle from the wheel planes to the direction of travel, left positive: negative where the ground rises to
  /// the left, because the wheels are turned uphill. NaN without an equilibrium, as the next two.
  float slip_angle_rad = std::numeric_limits<float>::quiet_NaN();
  float side_force_over_load = std::numeric_limits<float>::quiet_NaN();  ///< greatest |F|/N of a wheel [-]
  /// Additional tilt until the rover tips; NaN also if the height of the centre of mass is not known.
  float stability_margin_rad = std::numeric_limits<float>::quiet_NaN();
  /// Category of the ground at this gradient along the heading.
  terramech::Category category = terramech::Category::Unknown;
  Refusal refusal = Refusal::None;
  std::uint8_t class_index = 0;  ///< index of the terrain class of the ground in the model
};

/// Returns the less favourable value of each quantity of `a` and `b`. The refusal is that of `a`, or that of
/// `b` if `a` is allowed.
TravelState worse(const TravelState& a, const TravelState& b) noexcept;

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

/// Returns the gradient of the plane of a cell in a heading.
inline terramech::Gradient gradientOf(CellCode cell, Direction heading) noexcept {
  return {cell.dzDx() * heading.x + cell.dzDy() * heading.y,
          cell.dzDy() * heading.x - cell.dzDx() * heading.y};
}

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
  /// Costs of all nodes, energy + weighted time + weighted risk [J/m]: kBins for each row, row 0 (no gradient
  /// across) first; gradients across beyond the last row use the last row. Costs must not decrease from row to
  /// row in any bin, because the lower bounds of the planners rely on this.
  std::shared_ptr<const std::vector<float>> costs;

  explicit TravelCurve(std::vector<float> costs_J_per_m)
      : costs(std::make_shared<const std::vector<float>>(std::move(costs_J_per_m))) {}

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

  /// Calls `at(row, bin, weight)` for each node of positive weight around a slope; along the heading, slopes
  /// beyond the table are those of its ends.
  template <typename At>
  static void forNodesAround(const terramech::Gradient& gradient, At at) {
    const Between bin = between(std::clamp(gradient.along * kBinsPerUnit + kBins / 2, 0.0, kLastPlace)),
                  row = between((gradient.across < 0.0 ? -gradient.across : gradient.across) * kRowsPerUnit);
    for (const int up : {0, 1})
      for (const int on : {0, 1}) {
        const float weight =
            (up == 1 ? row.share : 1.0F - row.share) * (on == 1 ? bin.share : 1.0F - bin.share);
        if (weight > 0.0F) at(row.whole + up, bin.whole + on, static_cast<double>(weight));
      }
  }

  /// rows() returns the costs of all nodes, level() those of row 0. lastRow() returns the index of the last row.
  const float* rows() const noexcept { return costs->data(); }
  std::span<const float> level() const noexcept { return {rows(), kBins}; }
  int lastRow() const noexcept { return static_cast<int>(costs->size()) / kBins - 1; }

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

/// Cost curve of ground of one estimated strength, and the travel states from which the costs follow.
struct GroundCost {
  TravelCurve curve;
  std::shared_ptr<const TravelStates> states;  ///< may be null if details are not needed (tests)
  terramech::TurnEfforts turns{};  ///< of a turn on level ground; zeros if turning is free (tests)
};

/// Energy and time per horizontal metre on ground whose strength departs from its mean by deviate(k) standard
/// deviations. A motion that fails there has the values of the least strength at which it does not.
struct TravelForecast {
  static constexpr int kDeviates = 15;
  static constexpr double deviate(int k) noexcept { return -3.5 + 0.5 * k; }
  std::array<float, kDeviates> energy_J_per_m{}, time_s_per_m{};
  double added_J_per_m = 0.0;  ///< energy that a layer adds, whatever the ground
  /// Energy and time with all axles on fresh ground, over those with later axles in ruts.
  double fresh_energy = 0.0, fresh_time = 0.0;
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
  /// Soil::rut_stiffness with its standard deviation, by class index [-].
  std::vector<terramech::Estimate> ruts{};
};

/// Cost function of a map, shared by planners, route checks and reports. It combines the cost curves with
/// limits that apply to every ground. Immutable and thread-safe.
class TravelCost {
 public:
  /// Limits that apply to every ground; gradients are rise over run.
  struct Limits {
    double max_along = 0.36;   ///< greatest gradient along the heading, tan(max pitch)
    double max_across = 0.36;  ///< greatest gradient across the heading, tan(max roll)
    bool stated = false;       ///< true: the costs and both gradients are stated, without rover and soil
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
  /// `weights` are those of the curves of `grounds`.
  TravelCost(const Limits& limits, const std::vector<GroundCost>& grounds, SoilUncertainty uncertainty = {},
             const CostWeights& weights = {});

  /// Returns the cost [J/m] of one horizontal metre over the cell in a heading; infinite for a refused
  /// motion.
  float costPerMetre(CellCode cell, Direction heading) const noexcept;

  /// Returns the travel state from which costPerMetre() follows. The cost is finite if and only if
  /// TravelState::refusal is None. For a curve without states, the quantities are 0 and the category is
  /// Unknown.
  TravelState detail(CellCode cell, Direction heading) const noexcept;

  /// Returns energy and time of a horizontal metre over the strength of the ground; zeros without states.
  TravelForecast forecast(CellCode cell, Direction heading) const noexcept;

  /// Returns TravelStates::climb() in a heading; without states the gradient along the heading.
  double climb(CellCode cell, Direction heading) const noexcept;

  /// Returns the effort of a turn by one radian at a vertex of a route on this cell; zeros on cells without a
  /// cost curve. turns() returns the efforts of turns by curve index, cost_J() the cost of an effort.
  terramech::TurnEffort turn(CellCode cell) const noexcept {
    return cell.curve() < turns_.size() ? turns_[cell.curve()].at_vertex : terramech::TurnEffort{};
  }
  const std::vector<terramech::TurnEfforts>& turns() const noexcept { return turns_; }
  double cost_J(const terramech::TurnEffort& turn) const noexcept {
    return weights_.energy * turn.energy_J + weights_.time_W * turn.time_s;
  }

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
  std::vector<terramech::TurnEfforts> turns_;
  CostWeights weights_;
  double steady_gradient_;  // gradient up to which the rover tips in no heading
  SoilUncertainty uncertainty_;
};

}  // namespace talus::costmap
namespace talus::costmap {

/// Steady motion of a rover at one pair of gradients, over the strength of the ground
/// (terramech::SlopeEquilibrium). The strengths of the entries exceed the least strength that holds by kExcess.
struct StrengthColumn {
  static constexpr int kStrengths = 12;
  static constexpr double kSpan = 3.0;  ///< excess of the last entry [-]
  enum Quantity { kEnergy, kTime, kSlip, kSinkage, kTorque, kSlipAngle, kSideForce, kQuantities };

  float least = 0.0F;  ///< least strength at which slip and slip angle stay within their limits
  /// The same whether later axles roll in ruts or on fresh ground: the strength that a decision requires, because
  /// the law of ruts is uncertain and a wheel may leave its rut.
  float required = 0.0F;
  float margin_rad = 0.0F;  ///< stability margin on ground of the class; NaN: not known
  /// Energy and time with all axles on fresh ground over those in ruts, on ground of the class or, where that
  /// fails, on the weakest ground that holds.
  float fresh_energy = 1.0F, fresh_time = 1.0F;
  /// Energy [J/m] and time [s/m] along the surface, slip, sinkage [m] and torque [N m] of the wheel with the
  /// greatest value, slip angle [rad] (negative where the ground rises to the left), side force over load.
  std::array<std::array<float, kStrengths>, kQuantities> entries{};

  /// Excess over `least` of the entries: kSpan (k/11)^2.
  static constexpr std::array<double, kStrengths> kExcess = [] {
    std::array<double, kStrengths> excess{};
    for (int k = 0; k < kStrengths; ++k)
      excess[static_cast<std::size_t>(k)] = kSpan * k * k / ((kStrengths - 1) * (kStrengths - 1));
    return excess;
  }();
  /// Entries around an excess over `least`, and the share of the second.
  struct Place {
    std::size_t low;
    double share;
  };
  static Place place(double excess) noexcept;
  /// Returns a quantity at a place: linear between entries, constant beyond.
  double at(Quantity quantity, const Place& place) const noexcept {
    const auto& values = entries[static_cast<std::size_t>(quantity)];
    const auto a = static_cast<double>(values[place.low]), b = static_cast<double>(values[place.low + 1]);
    return a + place.share * (b - a);
  }
};

/// Lattice T[strength][gradient along][gradient across] of the steady motion of one rover on the ground of one
/// class (ours), the one source of slip, slip angle, sinkage, torque, energy, time, reserve and the reason of a
/// refusal. Equilibria are solved at gradients along and across in steps of 1/32, up to
/// the limits of pitch and roll, and interpolated linearly at equal excess of strength over the least that
/// holds; the least strength is interpolated linearly as well. It is convex but for its edges between reasons,
/// so that interpolation errs towards danger. A rover with different sides has its worse side downhill.
/// Immutable.
class SlopeLattice {
 public:
  /// `across` = false: gradients across have no effect (for comparison with planners that ignore them).
  SlopeLattice(const terramech::SlopeEquilibrium& equilibrium, const TravelCost::Limits& limits,
               bool across = true);

  /// Returns the number of rows; steeper gradients across use the last row.
  int rows() const noexcept { return static_cast<int>(nodes_.size()) / bins(); }
  /// Returns true if a bin is within the limit of pitch.
  bool contains(int bin) const noexcept { return bin >= first_ && bin <= last_; }
  /// Returns the node of a row and a bin that contains() includes.
  const StrengthColumn& node(int row, int bin) const noexcept { return nodes_[index(row, bin)]; }
  /// Returns the greatest climbOf() of the nodes around a slope, at least the gradient along; 4 if any ground
  /// refuses the slope.
  double climb(const terramech::Gradient& gradient) const noexcept;
  /// Returns the maximum of climb() over all headings on a plane of this gradient; at least `gradient`.
  double steepest(double gradient) const noexcept;
  /// Returns the gradient of the straight climb that requires the same strength as the node of a row and a bin
  /// that contains() includes, where no side tips.
  double climbOf(int row, int bin) const noexcept { return static_cast<double>(climbs_[index(row, bin)]); }

 private:
  int bins() const noexcept { return last_ - first_ + 1; }
  void findClimbs();
  void findSteepest();
  std::size_t index(int row, int bin) const noexcept {
    return static_cast<std::size_t>(std::min(row, rows() - 1) * bins() + bin - first_);
  }

  int first_ = 0, last_ = 0;
  std::vector<StrengthColumn> nodes_;     // [row][bin]
  std::vector<float> climbs_, steepest_;  // of nodes; by gradient in steps of CellCode up to 1
};

/// Travel states of ground of one estimated strength at the nodes of TravelCurve. Immutable and thread-safe.
class TravelStates {
 public:
  virtual ~TravelStates() = default;

  /// Returns the state at the node in `row` (gradient across) and `bin` (gradient along the heading).
  virtual TravelState at(int row, int bin) const = 0;
  /// Returns the state on a slope, interpolated linearly between the nodes around it. The category is the worst
  /// of the nodes. The refusal is Tips if a node tips, otherwise that of the first refused node.
  TravelState state(const terramech::Gradient& gradient) const;
  /// Returns the costs of all nodes.
  TravelCurve curve(const CostWeights& weights) const;

  /// Returns the gradient of the straight climb that requires the same strength as the steepest node around a
  /// slope, by which state() judges; at least the gradient along the heading.
  virtual double climb(const terramech::Gradient& gradient) const { return gradient.along; }
  /// Returns the maximum of climb() over all headings on a plane of this gradient; at least `gradient`.
  virtual double steepest(double gradient) const { return gradient; }
  /// Returns energy and time over the strength of the ground.
  virtual TravelForecast forecast(const terramech::Gradient& gradient) const = 0;
  /// Returns the same ground with another energy added to each metre.
  virtual std::shared_ptr<const TravelStates> withAdded(double added_J_per_m) const = 0;

 protected:
  /// Energy [J/m], time [s/m] and hazard [1/m] of the cost of a node; an infinite energy refuses it.
  using Terms = std::array<float, 3>;
  /// Returns the terms of all nodes, row by row; they never decrease from row to row.
  virtual std::vector<Terms> terms() const = 0;

  TravelStates() = default;
  TravelStates(const TravelStates&) = default;
  TravelStates& operator=(const TravelStates&) = default;
};

/// States that depend on the gradients alone, and on no uncertainty.
class TabulatedStates final : public TravelStates {
 public:
  /// Takes the states at the nodes of TravelCurve, row by row; TravelCurve::kBins in each row, one row or more.
  /// Costs must not decrease from row to row.
  explicit TabulatedStates(std::vector<TravelState> states);

  TravelState at(int row, int bin) const override;
  TravelForecast forecast(const terramech::Gradient& gradient) const override;
  std::shared_ptr<const TravelStates> withAdded(double added_J_per_m) const override;

 private:
  std::vector<Terms> terms() const override;

  std::vector<TravelState> states_;
};

/// Returns the states of ground with a stated cost per horizontal metre over the gradients, as their energy, and with
/// no other quantity (NaN). The cost is sampled at the nodes of TravelCurve, in rows up to the gradient `max_across`
/// (0: gradients across have no effect), and raised to that of rows with less gradient across; infinite: refused.
std::shared_ptr<const TravelStates> statedStates(
    const std::function<double(const terramech::Gradient&)>& cost_per_m, double max_across,
    std::uint8_t class_index = 0);

/// A tile: a block of 64x64 cells of a map, row-major from the south-west corner.
template <typename T>
struct Tile {
  static constexpr int kSide = 64;
  std::array<T, kSide * kSide> cells;
};

using CostTile = Tile<CellCode>;
using HeightTile = Tile<float>;

/// Table of the tiles of a map, row-major, with copy-on-write in pages of 64 tiles. A copy of the table
/// copies pointers only; a change of one tile copies the pointers of its page.
template <typename T>
class SharedTiles {
 public:
  using Shared = std::shared_ptr<const Tile<T>>;

  SharedTiles() = default;
  /// Makes a table of `tiles` entries that all share the tile `each`.
  SharedTiles(std::size_t tiles, const Shared& each);
  explicit SharedTiles(const std::vector<Shared>& tiles);

  std::size_t size() const noexcept { return raw_.size(); }
  const Tile<T>& tile(std::size_t i) const noexcept { return *raw_[i]; }
  const Shared& operator[](std::size_t i) const noexcept { return (*pages_[i / kPage])[i % kPage]; }
  void set(std::size_t i, Shared tile);

 private:
  static constexpr std::size_t kPage = 64;
  using Page = std::array<Shared, kPage>;

  std::vector<const Tile<T>*> raw_;                 // pointers for direct access by readers
  std::vector<std::shared_ptr<const Page>> pages_;  // pages that own the tiles
};

using TileTable = SharedTiles<CellCode>;
using HeightTable = SharedTiles<float>;

/// Returns the tiles of a raster of elevations [m]; tiles beyond the eastern and northern edge are padded.
HeightTable tiled(const maps::Raster<float>& elevation_m);

/// Returns the table with new tiles for the cells of a box. All other tiles are shared with `table`.
HeightTable retiled(HeightTable table, const maps::Raster<float>& elevation_m, const maps::CellBox& box);

/// Cost grid: one version of the cost map for planners. Immutable: readers need no lock and never block the
/// writer. Versions share unchanged tiles.
class CostGrid {
 public:
  /// Content of one version.
  struct Content {
    maps::Grid grid;
    /// Codes of the cells (gradients and index of a cost curve); tiles beyond the eastern and northern edge
    /// are padded.
    TileTable tiles;
    /// Cost function with the cost curves.
    std::shared_ptr<const TravelCost> cost;
    std::uint64_t version = 0;
    /// Elevations [m], NaN for unobserved cells; a table without tiles means no elevations.
    HeightTable elevation_m{};
  };

  explicit CostGrid(Content content);

  const maps::Grid& grid() const noexcept { return content_.grid; }
  const TravelCost& cost() const noexcept { return *content_.cost; }
  const Content& content() const noexcept { return content_; }
  std::uint64_t version() const noexcept { return content_.version; }
  int tileColumns() const noexcept { return tile_columns_; }

  /// Returns the code (gradients and index of a cost curve) of a cell, which must lie inside the grid.
  CellCode at(maps::Cell c) const noexcept {
    const auto tile = static_cast<std::size_t>((c.row >> 6) * tile_columns_ + (c.column >> 6));
    return content_.tiles.tile(tile).cells[static_cast<std::size_t>((c.row & 63) << 6 | (c.column & 63))];
  }

  /// Returns the elevation of the ground at a point [m], by maps::elevationAt(); nullopt if unknown.
  std::optional<double> elevation_m(maps::Point point) const;

 private:
  Content content_;
  int tile_columns_;
};

/// Returns the first version of a cost grid, from a raster of cell codes and the cost function.
CostGrid flattened(const maps::Raster<CellCode>& cells, std::shared_ptr<const TravelCost> cost);

/// Changes from one version of a cost grid to the next.
struct Revision {
  std::vector<maps::CellBox> ranges;  ///< boxes of the changed cells, inside the grid
  /// Returns the new code of a cell in `ranges`, from its position and its old code.
  std::function<CellCode(maps::Cell, CellCode)> code;
  /// Returns the cost function of the new version. revised() calls `cost` after `code` was called for all
  /// changed cells.
  std::function<std::shared_ptr<const TravelCost>()> cost;
  std::optional<HeightTable> elevation_m{};  ///< elevations of the new version; nullopt: unchanged
};

/// Returns the next version of the grid: copies the tiles that overlap the changed cells and shares all
/// others.
CostGrid revised(const CostGrid& grid, const Revision& revision);

}  // namespace talus::costmap
