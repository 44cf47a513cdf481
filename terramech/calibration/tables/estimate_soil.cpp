#include <algorithm>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/tables/estimate_soil.hpp>
#include <talus/terramech/calibration/tables/line_estimate.hpp>
#include <talus/terramech/calibration/tables/model_estimate.hpp>

namespace talus::terramech {
namespace {

void requireOneOf(const std::string& word, const std::vector<std::string>& words, const std::string& what) {
  if (std::ranges::find(words, word) != words.end()) return;
  std::string list;
  for (const std::string& other : words) list += (list.empty() ? "" : ", ") + other;
  throw InputError(
      {.where = what + " '" + word + "'", .reason = "is unknown", .remedy = "there are " + list});
}

void validate(const EstimateOptions& options) {
  requireOneOf(options.method, estimateMethods(), "--method");
  if (!options.shear_modulus.empty() && !statedModulus(options))
    requireOneOf(options.shear_modulus, modulusMethods(), "--shear-modulus");
  if (options.plate_width_m > 0.0 && options.method != "bevameter") {
    throw InputError({.where = "--plate-width",
                      .reason = "applies to plate tests only",
                      .remedy = "use --method bevameter, or remove the option"});
  }
}

}  // namespace

const std::vector<std::string>& estimateMethods() {
  static const std::vector<std::string> names{"bevameter", "sojourner", "iagnemma", "linear-offset",
                                              "wong-reece"};
  return names;
}

const std::vector<std::string>& modulusMethods() {
  static const std::vector<std::string> names{"error-minimisation", "effective-torque",
                                              "effective-torque-printed", "joint"};
  return names;
}

SoilEstimate estimateSoil(const EstimateOptions& options, const ProgressMonitor& watch) {
  validate(options);
  const bool whole_model = options.method == "wong-reece" && measuresSideForce(options.table);
  if (!options.model.empty() || whole_model) return modelEstimate(options, watch);
  if (options.method == "wong-reece") return posteriorEstimate(options, watch);
  if (options.method != "bevameter") return lineEstimate(options, watch);
  if (options.recursive) {
    throw InputError({.where = "--recursive",
                      .reason = "cannot be combined with --method bevameter, which fits a whole test at once",
                      .remedy = "remove one of the two"});
  }
  return plateEstimate(options, watch);
}

}  // namespace talus::terramech
