#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::costmap {

/// Travel states of ground of one estimated strength at the nodes of TravelCurve. Immutable and thread-safe.
class TravelStates {
 public:
  virtual ~TravelStates() = default;

  /// Returns the state at the node in `row` (gradient across) and `bin` (gradient along the heading).
  virtual TravelState at(int row, int bin) const = 0;
  /// Returns the costs of all nodes. Costs never decrease from row to row.
  virtual TravelCurve curve(const CostWeights& weights) const = 0;

  /// Returns slip angle, side force and stability margin on a slope.
  virtual SlopeHold hold(const terramech::Gradient&) const { return {}; }
  /// Returns the gradient of the straight climb that requires the same strength as a slope; at
  /// least the gradient along the heading.
  virtual double climb(const terramech::Gradient& gradient) const { return gradient.along; }
  /// Returns the maximum of climb() over all headings on a plane of this gradient; at least `gradient`.
  virtual double steepest(double gradient) const { return gradient; }
  /// Returns energy and time over the strength of the ground.
  virtual TravelForecast forecast(const terramech::Gradient& gradient) const = 0;
  /// Returns the same ground with another energy added to each metre.
  virtual std::shared_ptr<const TravelStates> withAdded(double added_J_per_m) const = 0;

 protected:
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
  TravelCurve curve(const CostWeights& weights) const override;
  TravelForecast forecast(const terramech::Gradient& gradient) const override;
  std::shared_ptr<const TravelStates> withAdded(double added_J_per_m) const override;

 private:
  std::vector<TravelState> states_;
};

/// Returns the states of ground with a stated cost per horizontal metre over the gradients, as their energy, and with
/// no other quantity (NaN). The cost is sampled at the nodes of TravelCurve, in rows up to the gradient `max_across`
/// (0: gradients across have no effect), and raised to that of rows with less gradient across; infinite: refused.
std::shared_ptr<const TravelStates> statedStates(
    const std::function<double(const terramech::Gradient&)>& cost_per_m, double max_across,
    std::uint8_t class_index = 0);

}  // namespace talus::costmap
