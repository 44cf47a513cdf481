#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/io/terramech_io.hpp>

/// Table of wheel telemetry together with the wheel model for its rows.
namespace talus::terramech {

/// Reads the model from a soil or model file and sets its wheel to that of a rover (library name or file).
/// With an empty `file` the model is unknownSoil(); with an empty `rover` the wheel of the model is kept.
/// Throws the exceptions of loadModel() and loadRover().
ModelFile baseModel(const std::string& file, const std::string& rover);

/// Wheel model, and the rows of a table to which the model applies.
struct ModelRows {
  RefinedModel model;  ///< the given model, with slip_along_travel set if slipIsAlongTravel() of the rows
  Trial trial;         ///< rows to which the model applies
  Trial beyond_axle;   ///< rows with sinkage z >= wheel radius r (beyondAxle())
  /// Rejected rows of the table, including rows with a side force but no slip angle.
  std::vector<RejectedRow> rejected;
};

/// Selects the rows of a table for a model. Throws the exceptions of leaveOutWithoutSlipAngle() and
/// makeTrial().
ModelRows modelRows(Telemetry table, const RefinedModel& model);

}  // namespace talus::terramech
