#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <talus/cli/ground/cost_curve_file.hpp>
#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/costmap/cost/travel_states.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/io/field_text.hpp>

namespace talus::cli {
namespace {

using costmap::TravelCurve;

constexpr double kMostCost = 1e9, kMostGradient = 2.0;
constexpr int kMostClass = 254;

// Costs of one class by gradient across, then by gradient along.
using Rows = std::map<double, std::map<double, double>>;

std::map<int, Rows> readRows(const std::string& path, bool& classed) {
  terramech::CsvReader reader(path);
  const std::vector<std::string> known{"gradient_along", "cost_per_m", "gradient_across", "class"};
  std::vector<std::optional<std::size_t>> columns(known.size());
  for (std::size_t k = 0; k < reader.header().size(); ++k) {
    const auto found = std::ranges::find(known, reader.header()[k]);
    if (found == known.end())
      throw InputError({path + ":1", "has the unknown column '" + reader.header()[k] + "'",
                        "name the columns gradient_along, gradient_across, class, cost_per_m"});
    columns[static_cast<std::size_t>(found - known.begin())] = k;
  }
  if (!columns[0] || !columns[1])
    throw InputError({path + ":1", std::string("has no column ") + known[columns[0] ? 1 : 0],
                      "give gradient_along and cost_per_m"});
  classed = columns[3].has_value();
  std::map<int, Rows> classes;
  for (terramech::CsvRow row; reader.next(row);) {
    const auto refuse = [&](const std::string& reason) {
      throw InputError({fmt::format("{}:{}", path, row.line), reason, "fix the row"});
    };
    if (!row.fault.empty()) refuse(row.fault);
    const auto number = [&](std::size_t k, double low, double high) {
      double value = 0.0;
      if (columns[k] &&
          !(terramech::parseNumber(row.fields[*columns[k]], value) && value >= low && value <= high))
        refuse(fmt::format("{} = '{}', must be {:g} to {:g}", known[k], row.fields[*columns[k]], low, high));
      return value;
    };
    const double along = number(0, -1.0, 1.0), across = number(2, 0.0, kMostGradient),
                 of = number(3, 0.0, kMostClass);
    if (of != std::floor(of)) refuse("class must be a whole number");
    const std::string& text = row.fields[*columns[1]];
    const double cost = text.empty() || text == "inf" ? kInfinity : number(1, 1e-9, kMostCost);
    if (!classes[static_cast<int>(of)][across].emplace(along, cost).second)
      refuse("has the gradients of an earlier row");
  }
  return classes;
}

void requireWhole(const Rows& rows, const std::string& where) {
  if (rows.begin()->first != 0.0 || rows.begin()->second.size() < 2)
    throw InputError(
        {where, "needs two gradients along or more, and gradients across from 0", "add the rows"});
  const std::map<double, double>* last = nullptr;
  for (const auto& [across, row] : rows) {
    if (last != nullptr)
      for (auto a = last->begin(), b = row.begin(); a != last->end() || b != row.end(); ++a, ++b) {
        if (a == last->end() || b == row.end() || a->first != b->first)
          throw InputError(
              {where,
               fmt::format("gradient_across {:g}: has other gradients along than the row before", across),
               "give every pair of gradients"});
        if (b->second < a->second)
          throw InputError(
              {where,
               fmt::format("the cost at gradient_along {:g} falls with gradient_across to {:g}, from "
                           "{:g} to {:g}",
                           b->first, across, a->second, b->second),
               "costs must not decrease across the slope"});
      }
    last = &row;
  }
}

// Linear between the entries of a table, and on from its last two up to `beyond` past an end; else infinite.
double between(const std::map<double, double>& table, double at, double beyond) {
  if (at < table.begin()->first - beyond || at > table.rbegin()->first + beyond) return kInfinity;
  auto high = table.lower_bound(at);
  if (high != table.end() && high->first == at) return high->second;
  if (high == table.begin()) ++high;
  if (high == table.end()) --high;
  const auto low = std::prev(high);
  if (std::isinf(low->second) || std::isinf(high->second)) return kInfinity;
  const double share = (at - low->first) / (high->first - low->first);
  return std::max(low->second + share * (high->second - low->second), 0.0);
}

// A node just beyond a limit that the cost function checks has the value that continues the table, because costs at
// the limit are interpolated to it.
std::shared_ptr<const costmap::TravelStates> statesOf(const Rows& rows, const costmap::StatedCosts& limits,
                                                      std::size_t index) {
  constexpr double kBin = 1.0 / TravelCurve::kBinsPerUnit, kRow = 1.0 / TravelCurve::kRowsPerUnit;
  const bool level = rows.size() == 1;
  const auto cost = [&](const terramech::Gradient& gradient) {
    const double beyond = std::abs(gradient.along) >= limits.max_along ? kBin : 0.0;
    if (level) return between(rows.begin()->second, gradient.along, beyond);
    std::map<double, double> over_across;
    for (const auto& [across, row] : rows) over_across.emplace(across, between(row, gradient.along, beyond));
    return between(over_across, gradient.across, kRow);
  };
  return costmap::statedStates(cost, level ? 0.0 : limits.max_across, static_cast<std::uint8_t>(index));
}

}  // namespace

CostCurves readCostCurves(const std::string& path) {
  CostCurves curves;
  const std::map<int, Rows> classes = readRows(path, curves.classed);
  if (classes.empty())
    throw InputError({path, "contains no row", "give a cost for two gradients along or more"});
  costmap::StatedCosts& costs = curves.costs;
  costs.max_along = 0.0;
  double across = 0.0;
  for (const auto& [number, rows] : classes) {
    requireWhole(rows, curves.classed ? fmt::format("{}, class {}", path, number) : path);
    costs.max_along = std::max(
        {costs.max_along, -rows.begin()->second.begin()->first, rows.begin()->second.rbegin()->first});
    across = std::max(across, rows.size() > 1 ? rows.rbegin()->first : kMostGradient);
  }
  costs.max_across = across;
  for (const auto& [number, rows] : classes) {
    costs.states.push_back(statesOf(rows, costs, curves.numbers.size()));
    curves.numbers.push_back(number);
  }
  return curves;
}

}  // namespace talus::cli
