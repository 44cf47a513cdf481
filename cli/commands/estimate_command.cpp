#include <algorithm>
#include <cmath>
#include <filesystem>

#include <Eigen/Cholesky>

#include <talus/cli/app/command.hpp>
#include <talus/cli/draw/plot.hpp>
#include <talus/cli/soil/table_options.hpp>
#include <talus/cli/soil/trace_report.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {
namespace {

using Json = nlohmann::ordered_json;

using namespace terramech;

struct EstimateCommand : EstimateOptions {
  std::string html;  // HTML page to write; empty: no page
  TableOptions columns;
};

void bind(CLI::App& command, EstimateCommand& options) {
  addOption(command, "table T.csv", options.table.path)->required();
  addOption(command, "--method", options.method)->required()->check(CLI::IsMember(estimateMethods()));
  addOption(command, "--shear-modulus M|HOW", options.shear_modulus)
      ->check([](const std::string& word) -> std::string {
        if (std::ranges::find(modulusMethods(), word) != modulusMethods().end()) return {};
        return CLI::Number(word).empty()
                   ? std::string()
                   : "'" + word + "' is neither a length in metres nor a method that finds K";
      });
  addOption(command, "--prior NAME|FILE", options.prior);
  addOption(command, "--model M.yaml", options.model);
  addOption(command, "--rover NAME|FILE", options.rover);
  addOption(command, "--plate-width M", options.plate_width_m)->check(CLI::Range(1e-3, 10.0));
  addOption(command, "--noise", options.noise)->check(CLI::Range(1e-4, 0.5));
  command.add_flag("--recursive", options.recursive);
  addTableOptions(command, options.columns);
  addOutput(command, "--html R.html", options.html);
}

Json runningJson(const SoilEstimate& e) {
  return jsonList(e.running, [](const RunningSoil& r) -> Json {
    return {{"line", r.line},
            {"cohesion_Pa", r.cohesion_Pa},
            {"cohesion_std_Pa", std::sqrt(r.covariance(0, 0))},
            {"friction_angle_rad", r.friction_angle_rad},
            {"friction_angle_std_rad", frictionStd_rad(r.covariance, r.friction_angle_rad)},
            {"shear_modulus_m", r.shear_modulus_m}};
  });
}

Json soilsJson(const SoilEstimate& e) {
  Json all = Json::array();
  for (const TrialSoil& s : e.soils) {
    Json one{{"soil", s.soil},
             {"trials", s.trials},
             {"sinkage_exponent", s.exponent.mean.value},
             {"sinkage_exponent_std", s.exponent.mean.std},
             {"sinkage_exponent_spread", s.exponent.spread},
             {"depth_m", s.depth_m},
             {"pressure_spread", s.pressure_spread}};
    if (s.fit.cohesive_modulus) one["cohesive_modulus"] = *s.fit.cohesive_modulus;
    if (s.fit.frictional_modulus) one["frictional_modulus"] = *s.fit.frictional_modulus;
    for (const auto& plate : s.fit.plates)
      one["plates"].push_back(
          {{"plate_width_m", plate.plate_width_m}, {"sinkage_modulus", plate.sinkage_modulus}});
    all.push_back(one);
  }
  return all;
}

/// The spread between trials, and the values of each soil if there are several soils.
std::string soilsText(const SoilEstimate& e) {
  std::string text;
  for (const TrialSoil& s : e.soils) {
    if (s.trials < 2 && e.soils.size() < 2) continue;
    text += fmt::format(
        "{:15} {} trials: n {:.3f} +- {:.3f}, spread {:.3f}; pressure at {:.1f} mm spread {:.0f} %\n",
        s.soil.empty() ? "trials" : s.soil, s.trials, s.exponent.mean.value, s.exponent.mean.std,
        s.exponent.spread, 1e3 * s.depth_m, 100.0 * s.pressure_spread);
    if (e.soils.size() < 2) continue;
    for (const auto& plate : s.fit.plates)
      text += fmt::format("  k at b {:5.1f} mm {:9.3g} N/m^(n+2)\n", 1e3 * plate.plate_width_m,
                          plate.sinkage_modulus);
  }
  return text;
}

// Returns the bounds between which a quantity lies with 95 % probability; cohesion and K are not negative.
Json interval(double mean, double std) {
  return {std::max(0.0, mean - 1.96 * std), mean + 1.96 * std};
}

Json posteriorJson(const SoilEstimate& e) {
  Json classes = Json::object();
  for (const auto& [name, probability] : e.classes) classes[name] = probability;
  return {{"interval_95",
           {{"cohesion_Pa", interval(e.cohesion_Pa, std::sqrt(e.covariance(0, 0)))},
            {"friction_angle_rad",
             interval(e.friction_angle_rad, frictionStd_rad(e.covariance, e.friction_angle_rad))},
            {"shear_modulus_m", interval(e.shear_modulus_m, e.shear_modulus_std_m)}}},
          {"class_probabilities", classes},
          {"misfit", e.misfit}};
}

Json jsonOf(const std::string& method, const SoilEstimate& e) {
  const auto& c = e.covariance;
  Json json{{"method", method},
            {"cohesion_Pa", e.cohesion_Pa},
            {"friction_angle_rad", e.friction_angle_rad},
            {"tan_friction", e.tan_friction},
            {"shear_modulus_m", e.shear_modulus_m},
            {"covariance", {{c(0, 0), c(0, 1)}, {c(1, 0), c(1, 1)}}},
            {"rows_used", e.rows_used},
            {"rows_rejected", e.rejected.size()},
            {"well_conditioned", e.unseen.empty()},
            {"unseen", e.unseen},
            {"warnings", e.warnings},
            {"ignored", e.ignored},
            {"plausible", e.implausible().empty()},
            {"rejected", rejectedJson(e.rejected)}};
  if (std::isfinite(e.sinkage_exponent)) json["sinkage_exponent"] = e.sinkage_exponent;
  if (e.cohesive_modulus) json["cohesive_modulus"] = *e.cohesive_modulus;
  if (e.frictional_modulus) json["frictional_modulus"] = *e.frictional_modulus;
  for (const auto& plate : e.plates)
    json["plates"].push_back(
        {{"plate_width_m", plate.plate_width_m}, {"sinkage_modulus", plate.sinkage_modulus}});
  if (!e.soils.empty()) json["soils"] = soilsJson(e);
  if (!e.effects.empty()) json["effects"] = e.effects;
  if (!e.running.empty()) json["running"] = runningJson(e);
  if (e.model) json.update(posteriorJson(e));
  return json;
}

Table runningTable(const SoilEstimate& e) {
  Table table{{"line", "c kPa", "std", "phi deg", "std", "K mm"}};
  for (const RunningSoil& r : e.running) {
    table.push_back({std::to_string(r.line)});
    for (const double value :
         {1e-3 * r.cohesion_Pa, 1e-3 * std::sqrt(r.covariance(0, 0)), r.friction_angle_rad / kDegree,
          frictionStd_rad(r.covariance, r.friction_angle_rad) / kDegree, 1e3 * r.shear_modulus_m})
      table.back().push_back(std::isfinite(value) ? fmt::format("{:.3f}", value) : "-");
  }
  return table;
}

// The known parameters with their standard deviations.
Table soilTable(const SoilEstimate& e) {
  Table table{{"quantity", "value", "standard deviation"}};
  const auto add = [&](const std::string& name, double value, const char* format, double std = NAN) {
    const auto text = [&](double v) {
      return std::isfinite(v) ? fmt::format(fmt::runtime(format), v) : std::string();
    };
    if (std::isfinite(value)) table.push_back({name, text(value), text(std)});
  };
  add("cohesion [kPa]", 1e-3 * e.cohesion_Pa, "{:.3f}", 1e-3 * std::sqrt(e.covariance(0, 0)));
  add("friction angle [deg]", e.friction_angle_rad / kDegree, "{:.2f}",
      frictionStd_rad(e.covariance, e.friction_angle_rad) / kDegree);
  add("shear modulus [mm]", 1e3 * e.shear_modulus_m, "{:.2f}");
  add("exponent n", e.sinkage_exponent, "{:.3f}");
  for (const auto& plate : e.plates)
    add(fmt::format("k at b {:.1f} mm [N/m^(n+2)]", 1e3 * plate.plate_width_m), plate.sinkage_modulus,
        "{:.3g}");
  add("k_c [N/m^(n+1)]", e.cohesive_modulus.value_or(NAN), "{:.3g}");
  add("k_phi [N/m^(n+2)]", e.frictional_modulus.value_or(NAN), "{:.3g}");
  for (const auto& [name, probability] : e.classes) add("probability of " + name, probability, "{:.3f}");
  return table;
}

Report reportOf(const EstimateCommand& options, const SoilEstimate& e) {
  Report report("Soil estimated from " + std::filesystem::path(options.table.path).filename().string());
  if (!e.running.empty()) report.table(runningTable(e));
  report.table(soilTable(e));
  if (const std::string soils = soilsText(e); !soils.empty()) report.paragraph(soils);
  if (!e.effects.empty()) report.paragraph(fmt::format("effects {}", fmt::join(e.effects, ", ")));
  report.paragraph(
      fmt::format("method {}: {} rows used, {} rejected", options.method, e.rows_used, e.rejected.size()));
  return report;
}

Plot strengthPlot(const SoilEstimate& e) {
  Series points{.name = "samples", .x = {}, .y = {}, .mark = Series::Mark::Points};
  double most = 0.0;
  for (const auto& p : e.points) {
    points.x.push_back(1e-3 * p.normal_Pa);
    points.y.push_back(1e-3 * p.shear_Pa);
    most = std::max(most, points.x.back());
  }
  const Series line{.name = "c + sigma tan(phi)",
                    .x = {0.0, 1.1 * most},
                    .y = {1e-3 * e.cohesion_Pa, 1e-3 * e.cohesion_Pa + 1.1 * most * e.tan_friction}};
  return {.title = "Shear strength",
          .x = {.label = "normal stress [kPa]"},
          .y = {.label = "shear stress [kPa]"},
          .series = {line, points}};
}

// Ellipse that contains cohesion and friction with 95 % probability.
Plot posteriorPlot(const SoilEstimate& e) {
  constexpr double kBound = 5.991;  // of chi-squared with two degrees of freedom
  Series ellipse{.name = "95 % of the posterior", .x = {}, .y = {}};
  const Eigen::Matrix2d root = e.covariance.llt().matrixL();
  for (int k = 0; k <= 72; ++k) {
    const double angle = k * 5.0 * kDegree;
    const Eigen::Vector2d at = std::sqrt(kBound) * root * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    ellipse.x.push_back(1e-3 * (e.cohesion_Pa + at[0]));
    ellipse.y.push_back(std::atan(e.tan_friction + at[1]) / kDegree);
  }
  return {.title = "Strength",
          .x = {.label = "cohesion [kPa]"},
          .y = {.label = "friction angle [deg]"},
          .series = {ellipse}};
}

// Measured rows and model predictions for the estimated soil, one plot per channel; empty if the estimate has
// no wheel model.
std::vector<Plot> fitPlots(const EstimateCommand& options, const SoilEstimate& e) {
  std::vector<Plot> plots;
  if (!e.model) return plots;
  const ModelRows rows = modelRows(readTelemetry(options.table, {}), *e.model);
  SolvedContacts solved;
  const Eigen::MatrixXd predicted = predictRows(rows.model, rows.trial, solved);
  for (const Channel c : kAllChannels)
    if (rows.trial.has(c)) plots.push_back(overSlip(c, rows.trial, {{"estimated soil", predicted}}));
  return plots;
}

void writePage(const EstimateCommand& options, const SoilEstimate& e,
               const std::vector<std::string>& warnings) {
  Report page = reportOf(options, e);
  for (const std::string& text : warnings) page.paragraph("Warning: " + text + ".");
  std::vector<Plot> plots = fitPlots(options, e);
  if (!e.points.empty()) plots.push_back(strengthPlot(e));
  if (e.model) plots.push_back(posteriorPlot(e));
  page.charts(plots);
  writeFile(options.html, page.html());
}

int run(const EstimateCommand& asked, Context& context) {
  EstimateCommand options = asked;
  options.table = tableFile(asked.table.path, asked.columns, context);
  const SoilEstimate estimate = estimateSoil(options, context.watch("estimating"));
  if (context.stop.stop_requested()) return Exit::kCancelled;
  warnOfRejected(estimate.rejected, options.table.path, context);
  if (!estimate.ignored.empty())
    context.warn(fmt::format("{}: --method {} does not read {}", options.table.path, options.method,
                             fmt::join(estimate.ignored, ", ")));
  std::vector<std::string> warnings;
  for (const std::string& text : estimate.unseen) warnings.push_back("ill-conditioned: " + text);
  if (const std::string why = estimate.implausible(); !why.empty()) warnings.push_back(why);
  warnings.insert(warnings.end(), estimate.warnings.begin(), estimate.warnings.end());
  const Applicability applies = options.method == "bevameter"
                                    ? Applicability{}
                                    : tableApplicability(options.table, options.model, options.rover,
                                                         context.watch("checking the model"));
  if (context.stop.stop_requested()) return Exit::kCancelled;
  if (!applies.applies)
    warnings.push_back(options.table.path + ": the model does not apply: " + applies.reason);
  for (const std::string& text : warnings) context.warn(text);
  if (!options.html.empty()) writePage(options, estimate, warnings);
  Json json = jsonOf(options.method, estimate);
  json["applies"] = applies.applies;
  json["applies_reason"] = applies.reason;
  context.answer(json, reportOf(options, estimate).text());
  return applies.applies ? Exit::kDone : Exit::kNo;
}

}  // namespace

void addEstimate(CLI::App& app, Context& context) {
  addCommand<EstimateCommand>(app, context, "estimate", bind, run);
}

}  // namespace talus::cli
