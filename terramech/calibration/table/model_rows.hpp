#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/io/model_file.hpp>

/// A table of wheel telemetry together with the model for its rows.
namespace talus::terramech {

/// Reads the model of a soil or model file, with the wheel of a rover (library name or file). Without a file
/// the model is unknownSoil(); without a rover the wheel of the model is used. Throws InputError as
/// loadModel() and loadRover().
ModelFile baseModel(const std::string& file, const std::string& rover);

/// A model, and the rows of a table to which it applies.
struct ModelRows {
  RefinedModel model;  ///< the given model; sets slip_along_travel if slipIsAlongTravel() of the rows
  Trial trial;
  Trial beyond_axle;                  ///< rows with z >= r: beyondAxle()
  std::vector<RejectedRow> rejected;  ///< rejected rows of the table, including rows with a side force but no
                                      ///< slip angle
};

/// Selects the rows of a table for a model. Throws InputError as leaveOutWithoutSlipAngle() and makeTrial().
ModelRows modelRows(Telemetry table, const RefinedModel& model);

}  // namespace talus::terramech
