#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/table/prediction_table.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::terramech {
namespace {

bool isPrediction(const std::string& name) {
  return name.starts_with("predicted_");
}

struct Rows {
  std::vector<std::string> header;
  std::vector<CsvRow> rows;
};

Rows readRows(const TableFile& table, const std::stop_token& stop) {
  CsvReader reader(table);
  checkColumnUnits(reader.header(), knownTelemetryColumns(), table.path);
  Rows all{reader.header(), {}};
  for (CsvRow row; !stop.stop_requested() && reader.next(row);) {
    row.fields.resize(all.header.size());
    all.rows.push_back(row);
  }
  return all;
}

/// Telemetry with the conditions only, without measured answers.
Telemetry conditionsOf(const Rows& all, const std::string& source) {
  Telemetry t;
  t.source = source;
  for (std::size_t k = 0; k < all.header.size(); ++k) {
    const std::string& name = all.header[k];
    if (name.empty() || isAnswer(name) || isPrediction(name)) continue;
    std::vector<std::string> fields;
    for (const CsvRow& row : all.rows) fields.push_back(row.fields[k]);
    std::vector<double> numbers;
    const bool known = std::ranges::count(knownTelemetryColumns(), name) > 0,
               texts = name == "run" || name == "wheel";
    if (!texts && (allNumbers(fields, numbers) || known)) {
      numbers.resize(all.rows.size(), WheelState::kUnknown);
      t.numbers.push_back({name, numbers});
    } else {
      t.words.push_back({name, std::move(fields)});
    }
  }
  for (const CsvRow& row : all.rows) t.lines.push_back(row.line);
  return t;
}

/// Returns which column of an effect the row lacks; empty if none. A missing slip angle is 0.
std::string missingFor(const RefinedModel& model, const WheelState& s) {
  for (const Effect& e : model.effects) {
    const bool of_group = !e.only_column.empty();
    const std::string& column = of_group ? e.only_column : e.covariate;
    const bool known =
        of_group ? !s.label(column).empty()
                 : column == "sinkage_m" || column == "slip_angle_rad" || std::isfinite(s.covariate(column));
    if (!known) return column + " is missing, on which " + e.name + " of the model depends";
  }
  return "";
}

std::string faultOf(const CsvRow& row, const WheelState& s) {
  if (!row.fault.empty()) return row.fault;
  if (!std::isfinite(s.load_N)) return "load_N is missing";
  if (!(s.load_N > 0.0)) return "load_N must be > 0";
  if (!std::isfinite(s.slip)) return "slip is missing";
  if (std::abs(s.slip) > 1.0) return "slip must be in [-1, 1]";
  if (!(s.wheel.radius_m > 0.0 && s.wheel.width_m > 0.0)) return "the wheel's radius and width must be > 0";
  return "";
}

/// Removes the corrections that the scope excludes, and includes the removed correction in the standard
/// deviation.
void takeBack(const ModelScope& scope, const WheelState& state, Prediction& p) {
  std::array<double, kChannels> taken{};
  for (std::size_t c = 0; c < kChannels; ++c) taken[c] = 1.0 - scope.share(state, c);
  if (std::all_of(taken.begin(), taken.end(), [](double t) { return t == 0.0; })) return;
  const Reading base = predict(*scope.base, state);
  for (std::size_t c = 0; c < kChannels; ++c) {
    const auto channel = static_cast<Channel>(c);
    const double back = taken[c] * (base.scaled(channel) - p.mean.scaled(channel));
    p.mean.addScaled(channel, back);
    p.scaled_std[c] = std::hypot(p.scaled_std[c], back);
  }
}

/// Increases the standard deviation outside the trained ranges; returns the names of the columns.
std::string outsideOf(const ModelScope& scope, const WheelState& state, Prediction& p) {
  std::string columns;
  for (const TrainedRange& range : scope.trained) {
    const double x = state.covariate(range.column);
    if (range.outside(x) == 0.0) continue;
    columns += (columns.empty() ? "" : ";") + range.column;
    for (std::size_t c = 0; c < kChannels; ++c)
      p.scaled_std[c] = std::hypot(p.scaled_std[c], range.stdAt(x, c));
  }
  return columns;
}

void append(std::string& text, double value) {
  char field[40];
  std::snprintf(field, sizeof field, ",%.9g", value);
  text += field;
}

}  // namespace

PredictionTable predictTable(const TableFile& file, const RefinedModel& model, const ModelScope& scope,
                             const ProgressMonitor& watch) {
  const Rows all = readRows(file, watch.stop);
  const auto states = statesOf(conditionsOf(all, file.path), model);
  PredictionTable table;
  for (std::size_t k = 0; k < all.header.size(); ++k) {
    if (isPrediction(all.header[k])) {
      table.replaced = true;
      continue;
    }
    table.text += (table.text.empty() ? "" : ",") + csvField(all.header[k]);
  }
  for (const char* answer : kAnswers)
    table.text += std::string(",predicted_") + answer + ",predicted_" + answer + "_std";
  table.text += ",predicted_outside";
  table.text += '\n';
  for (std::size_t row = 0; row < all.rows.size() && !watch.stopped(); ++row) {
    watch.report(static_cast<double>(row) / static_cast<double>(all.rows.size()));
    std::string line;
    for (std::size_t k = 0; k < all.header.size(); ++k)
      if (!isPrediction(all.header[k])) line += (k ? "," : "") + csvField(all.rows[row].fields[k]);
    std::string fault = faultOf(all.rows[row], states[row]);
    if (fault.empty()) fault = missingFor(model, states[row]);
    if (!fault.empty()) {
      table.refused.push_back({all.rows[row].line, fault});
      line += std::string(2 * kAnswers.size() + 1, ',');
    } else {
      Prediction p = predictWithStd(model, states[row]);
      takeBack(scope, states[row], p);
      const std::string outside = outsideOf(scope, states[row], p);
      for (std::size_t c = 0; c < kChannels; ++c) {
        const auto channel = static_cast<Channel>(c);
        append(line, p.mean.scaled(channel) * p.mean.denominator(channel));
        append(line, p.scaled_std[c] * p.mean.denominator(channel));
      }
      line += ',' + csvField(outside);
      table.outside += !outside.empty();
      ++table.predicted;
    }
    table.text += line + '\n';
  }
  watch.report(1.0);
  return table;
}

}  // namespace talus::terramech
