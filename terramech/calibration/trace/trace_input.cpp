#include <string>

#include <talus/common/input_error.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/trace/trace_input.hpp>

namespace talus::terramech {

TraceInput traceInput(const Telemetry& table, const ModelFile& base, const TraceOptions& options) {
  constexpr int kFewest = 5;
  TraceInput input{.rows = modelRows(table, base.model), .options = options};
  input.options.fit_soil = !base.soil_given;
  const Trial& trial = input.rows.trial;
  if (trial.rows() < kFewest)
    throw InputError({table.source,
                      std::to_string(trial.rows()) +
                          " usable rows with sinkage below the wheel radius; tracing needs at least 5",
                      ""});
  // The rows of a drive do not determine both soil and effects.
  if (base.soil_given && trial.moment.empty()) giveDefaultDeviations(input.rows.model);
  return input;
}

}  // namespace talus::terramech
