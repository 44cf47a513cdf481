#include <utility>

#include <talus/terramech/calibration/table/model_rows.hpp>
#include <talus/terramech/io/terramech_io.hpp>
#include <talus/terramech/io/wheel_rows.hpp>

namespace talus::terramech {

ModelFile baseModel(const std::string& file, const std::string& rover) {
  ModelFile base = file.empty() ? unknownSoil() : loadModel(file);
  if (!rover.empty()) base.model.takeRover(loadRover(rover));
  return base;
}

ModelRows modelRows(Telemetry table, const RefinedModel& model) {
  leaveOutWithoutSlipAngle(table);
  const Trial all = makeTrial(table, model);
  const std::vector<char> sunk = beyondAxle(all);
  std::vector<char> above;
  for (const char row : sunk) above.push_back(!row);
  ModelRows rows{.model = model,
                 .trial = subset(all, above),
                 .beyond_axle = subset(all, sunk),
                 .rejected = std::move(table.rejected)};
  rows.model.slip_along_travel |= slipIsAlongTravel(rows.trial.states);
  return rows;
}

}  // namespace talus::terramech
