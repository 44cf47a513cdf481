#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/io/model_file.hpp>

/// A table of wheel telemetry beside the model that its rows are compared with.
namespace talus::terramech {

/// The model of a soil or model file, with the wheel of a rover (library name or file). Without a file the model is
/// unknownSoil(), without a rover its wheel stays. Throws InputError as loadModel() and loadRover().
ModelFile baseModel(const std::string& file, const std::string& rover);

/// A model and the rows of a table that it can describe.
struct ModelRows {
  RefinedModel model;  ///< as given; slip_along_travel is also set where slipIsAlongTravel() of the rows
  Trial trial;
  Trial beyond_axle;                  ///< rows sunk to the axle or deeper: beyondAxle()
  std::vector<RejectedRow> rejected;  ///< of the table, with rows that have a side force and no slip angle
};

/// The rows of a table for a model. Throws InputError as leaveOutWithoutSlipAngle() and makeTrial().
ModelRows modelRows(Telemetry table, const RefinedModel& model);

}  // namespace talus::terramech
