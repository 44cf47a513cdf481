#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <talus/costmap/cost/drive_state.hpp>

namespace talus::terramech {
class RoverStance;
}

namespace talus::costmap {

/// A heading as a unit vector in the map frame (x east, y north).
struct Direction {
  double x = 1.0;
  double y = 0.0;
};

/// One cell as planners read it, in 4 bytes: the gradient of the plane under the rover and the number of a
/// drive curve. dz/dx and dz/dy are stored in steps of 1/1024 (rise over run, at most half a step off),
/// clamped to [-2, 2).
class CellCode {
 public:
  static constexpr std::uint8_t kUnknown = 254;  ///< curve number of an unobserved cell
  static constexpr std::uint8_t kBlocked = 255;  ///< curve number of a cell no heading may enter

  /// The parts that are packed.
  struct Parts {
    double dz_dx = 0.0;  ///< rise over run eastwards [-]
    double dz_dy = 0.0;  ///< rise over run northwards [-]
    std::uint8_t curve = kUnknown;
  };

  CellCode() : CellCode(Parts{}) {}
  explicit CellCode(const Parts& parts)
      : bits_(quantised(parts.dz_dx) << 20 | quantised(parts.dz_dy) << 8 | parts.curve) {}

  double dzDx() const noexcept { return static_cast<double>(stepsX()) * kStep; }
  double dzDy() const noexcept { return static_cast<double>(stepsY()) * kStep; }
  int stepsX() const noexcept { return static_cast<std::int32_t>(bits_) >> 20; }
  int stepsY() const noexcept { return static_cast<std::int32_t>(bits_ << 12) >> 20; }
  /// The same ground under another curve number.
  CellCode withCurve(std::uint8_t curve) const noexcept {
    CellCode code = *this;
    code.bits_ = (bits_ & 0xffffff00U) | curve;
    return code;
  }
  std::uint8_t curve() const noexcept { return static_cast<std::uint8_t>(bits_); }
  std::uint32_t bits() const noexcept { return bits_; }

  friend bool operator==(CellCode, CellCode) = default;

  static constexpr double kStep = 1.0 / 1024.0;

 private:
  static std::uint32_t quantised(double gradient) noexcept;

  std::uint32_t bits_;
};

/// What one horizontal metre costs on one kind of ground, at nodes over the gradient along the heading (rise over run,
/// climbing > 0), kBins of them at k/256, k = -256..255, and over the size of the gradient across, in rows at every
/// 1/64; between them linear in both. Infinite where the motion is not allowed. Nothing is allowed that one of the nodes
/// about it refuses: price() is finite only where every node of positive weight is.
struct DriveCurve {
  static constexpr int kBins = 512;
  static constexpr int kBinsPerUnit = 256;
  static constexpr int kRowsPerUnit = 64;
  static constexpr double kSame = 1e-9;  ///< of a bin or row: nearer to a node is on it
  static constexpr double kLastPlace =
      kBins - 1 - kSame;  ///< along, counted in bins; what is read ends before it
  /// Row 0, nothing across: energy + weighted time + weighted risk, in joules.
  std::array<float, kBins> cost_J_per_m;
  /// All rows, row 0 first; the last stands for all beyond. None: crossing costs nothing more. In no bin may
  /// costs fall from row to row: lower bounds rely on it.
  std::shared_ptr<const std::vector<float>> crossing{};

  /// The bin whose node is nearest to a gradient; outside 0..kBins-1 when the gradient leaves the table.
  static int bin(double gradient) noexcept;
  /// The gradient at a node, or at a place between nodes.
  static constexpr double gradient(double bin) noexcept { return (bin - 0.5 * kBins) / kBinsPerUnit; }
  /// The first row that is not gentler than a gradient across.
  static int row(double across) noexcept {
    const Between at = between((across < 0.0 ? -across : across) * kRowsPerUnit);
    return at.whole + static_cast<int>(at.share > 0.0F);
  }

  /// The node at or before a place that is counted in nodes, >= 0, and how far the place is on its way to the next.
  struct Between {
    int whole;
    float share;  ///< [0, 1]
  };
  static Between between(double place) noexcept {
    const int whole = static_cast<int>(place + kSame);
    const double rest = place - whole;
    return {whole, rest > kSame ? static_cast<float>(rest) : 0.0F};
  }

  /// Costs of all rows, and the number of the last.
  const float* rows() const noexcept { return crossing ? crossing->data() : cost_J_per_m.data(); }
  int lastRow() const noexcept { return crossing ? static_cast<int>(crossing->size()) / kBins - 1 : 0; }

  /// The cost at gradients along and across, both |g| <= 2; infinite outside the table.
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

class CrossSlope;

/// What a radian of heading, or a change of direction, takes beside the path's own length.
struct TurnPrice {
  double cost_J = 0.0;    ///< under the one cost function, >= 0
  double energy_J = 0.0;  ///< >= 0
  double time_s = 0.0;    ///< >= 0
};

/// A radian of heading on one ground.
struct TurnPrices {
  TurnPrice on_arc;
  TurnPrice in_place;
  TurnPrice at_vertex;  ///< of a polyline: in place for a rover that turns in place, else on an arc
};

/// One kind of ground: what a metre costs for the hot loop, and the numbers behind it.
struct DriveGround {
  DriveCurve curve;
  std::shared_ptr<const DriveTable> states;  ///< may be null where details are not needed (tests)
  std::shared_ptr<const CrossSlope>
      crossing{};      ///< what the curve's rows are made by; null where it has none
  TurnPrices turns{};  ///< a radian on the flat; zeros where turning is free (tests)
};

/// How a rover holds a slope on the soil of its class, by the row and bin of the cost; NaN where nothing holds or is
/// known.
struct SlopeHold {
  double slip_angle_rad = std::numeric_limits<double>::quiet_NaN();  ///< to the way made good, left positive
  double side_force_over_load = std::numeric_limits<double>::quiet_NaN();  ///< greatest |F|/N of a wheel
  double stability_margin_rad =
      std::numeric_limits<double>::quiet_NaN();  ///< further tilt until it tips; NaN, too,
                                                 ///< of a rover without a height
};

/// How the doubts about the soil of two places hang together, and what a place does whose soil is too weak.
struct SoilDoubt {
  double correlation_length_m = 0.0;  ///< over which soil stays alike; 0: not known, each metre by itself
  double entrapment = 1.0;            ///< share of the places with too weak soil that hold the rover [-]
  std::vector<double> shared{};       ///< by class: share of the pull's variance that all of it has in common
};

/// The one cost function: what grid search, sampling planners, the final check and the reports all call.
/// Immutable; safe to share between threads.
class DriveCost {
 public:
  /// Limits that hold on every ground, as rise over run.
  struct Limits {
    double max_along = 0.36;   ///< steepest gradient along the heading, tan(max pitch)
    double max_across = 0.36;  ///< steepest gradient across the heading, tan(max roll)
    std::shared_ptr<const terramech::RoverStance>
        stance{};  ///< beyond which the rover tips; none: it never does
  };

  /// Throws std::invalid_argument for more than 254 curves.
  DriveCost(const Limits& limits, std::vector<DriveCurve> curves);
  DriveCost(const Limits& limits, const std::vector<DriveGround>& grounds, SoilDoubt doubt = {});

  /// Cost of driving one horizontal metre over the cell in a direction, in joules; infinite when not allowed.
  float costPerMetre(CellCode cell, Direction heading) const noexcept;

  /// The numbers behind costPerMetre: finite cost exactly where refusal is None. Zeros, with the category
  /// Unknown, where the curve has no table.
  DriveState detail(CellCode cell, Direction heading) const noexcept;

  /// How the rover holds the slope there.
  SlopeHold hold(CellCode cell, Direction heading) const noexcept;

  /// What a radian of heading takes at a vertex on this cell, and of each curve; free on cells without a curve.
  TurnPrice turn(CellCode cell) const noexcept {
    return cell.curve() < turns_.size() ? turns_[cell.curve()].at_vertex : TurnPrice{};
  }
  const std::vector<TurnPrices>& turns() const noexcept { return turns_; }

  /// Whether a rover whose body points this way tips on the cell, standing or turning in place, on any soil.
  bool tips(CellCode cell, Direction heading) const noexcept;
  /// Whether it does in some heading.
  bool mayTip(CellCode cell) const noexcept;

  const Limits& limits() const noexcept { return limits_; }
  /// What the risk of a whole route follows from, beside the hazard of each metre.
  const SoilDoubt& doubt() const noexcept { return doubt_; }
  const std::vector<DriveCurve>& curves() const noexcept { return curves_; }
  /// The numbers behind each curve; null where a curve was made without.
  const std::vector<std::shared_ptr<const DriveTable>>& states() const noexcept { return states_; }
  const std::vector<std::shared_ptr<const CrossSlope>>& crossings() const noexcept { return crossings_; }

 private:
  DriveState detailAt(std::size_t curve, double place, double across) const noexcept;

  Limits limits_;
  std::vector<DriveCurve> curves_;
  std::vector<std::shared_ptr<const DriveTable>> states_;
  std::vector<std::shared_ptr<const CrossSlope>> crossings_;
  std::vector<TurnPrices> turns_;
  double steady_gradient_;  // the steepest plane on which no heading tips
  SoilDoubt doubt_;
};

}  // namespace talus::costmap
