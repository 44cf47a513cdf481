#include <cmath>

#include <talus/cli/app/command.hpp>
#include <talus/cli/soil/table_options.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/estimate/model_pull.hpp>

namespace talus::cli {
namespace {

using namespace terramech;
using Json = nlohmann::ordered_json;

struct AssessCommand : AssessOptions {
  TableOptions columns;
};

void bind(CLI::App& command, AssessCommand& options) {
  addOption(command, "table T.csv", options.table.path)->required();
  addOption(command, "--slope RAD", options.slope_rad);
  addOption(command, "--slope-uncertainty RAD", options.margin_rad);
  addOption(command, "--z-threshold", options.z_threshold);
  addOption(command, "--z-critical", options.z_critical);
  auto* model = addOption(command, "--model M.yaml", options.model);
  addOption(command, "--formula", options.formula)->check(CLI::IsMember(pullFormulas()))->excludes(model);
  command.add_flag("--extrapolate", options.extrapolate);
  addOption(command, "--reference-slip", options.reference_slip)->check(CLI::Range(0.01, 1.0));
  addOption(command, "--rover NAME|FILE", options.rover);
  addOption(command, "--noise", options.noise)->check(CLI::Range(0.0, 0.5));
  addTableOptions(command, options.columns);
}

Json jsonOf(const Estimate& pull) {
  const Estimate slope = climbableSlope_rad(pull);
  return {{"drawbar_pull_over_load", pull.value},
          {"std", pull.std},
          {"climbable_slope_rad", slope.value},
          {"climbable_slope_std_rad", slope.std}};
}

Json jsonOf(const PullForecast& f, double reference_slip) {
  Json reference{{"slip", reference_slip}};
  reference.update(jsonOf(f.at_reference));
  reference["sinkage_over_radius"] = f.sinkage_over_radius.value;
  reference["sinkage_over_radius_std"] = f.sinkage_over_radius.std;
  Json most{{"slip", f.most_slip}};
  most.update(jsonOf(f.most));
  return {{"at_reference_slip", reference}, {"greatest", most}};
}

Json jsonOf(const std::vector<Assessment>& rows, double reference_slip) {
  return jsonList(rows, [&](const Assessment& a) {
    const Estimate slope = climbableSlope_rad(a.pull);
    Json row{{"row", a.line - 1},
             {"line", a.line},
             {"drawbar_pull_over_load", a.pull.value},
             {"std", a.pull.std},
             {"sinkage_over_radius", a.sinkage_over_radius.value},
             {"sinkage_over_radius_std", a.sinkage_over_radius.std},
             {"torque_over_load_radius", a.torque_over_load_radius},
             {"category", name(a.category)},
             {"probability",
              {{"safe", a.probability[0]}, {"marginal", a.probability[1]}, {"dangerous", a.probability[2]}}},
             {"climbable_slope_rad", slope.value},
             {"climbable_slope_std_rad", slope.std}};
    if (a.forecast) row.update(jsonOf(*a.forecast, reference_slip));
    return row;
  });
}

std::string textOf(const AssessOptions& options, const std::vector<Assessment>& rows) {
  std::string text =
      "  line     DP/W     std     z/r   T/rW  slope [deg]  category   probability of (safe, marginal, "
      "dangerous)";
  if (options.extrapolate)
    text += fmt::format("  DP/W at slip {:.2f}     max DP/W   at slip  slope [deg]", options.reference_slip);
  text += '\n';
  for (const Assessment& a : rows) {
    text += fmt::format("{:6}  {:7.3f}  {:6.3f}  {:6.3f} {:6.3f}  {:11.1f}  {:9}  ({:.2f} {:.2f} {:.2f})",
                        a.line, a.pull.value, a.pull.std, a.sinkage_over_radius.value,
                        a.torque_over_load_radius, std::atan(a.pull.value) / kDegree, name(a.category),
                        a.probability[0], a.probability[1], a.probability[2]);
    if (a.forecast) {
      const PullForecast& f = *a.forecast;
      text += fmt::format("         {:7.3f} +-{:6.3f}  {:7.3f} +-{:6.3f}  {:4.1f}  {:4.1f} +-{:4.1f}",
                          f.at_reference.value, f.at_reference.std, f.most.value, f.most.std, f.most_slip,
                          f.climbable_slope_rad.value / kDegree, f.climbable_slope_rad.std / kDegree);
    }
    text += '\n';
  }
  return text;
}

int run(const AssessCommand& asked, Context& context) {
  AssessCommand options = asked;
  options.table = tableFile(asked.table.path, asked.columns, context);
  const AssessedTable table = assessTable(options, context.watch("assessing"));
  if (context.stop.stop_requested()) return Exit::kCancelled;
  warnOfRejected(table.rejected, options.table.path, context);
  for (const std::string& name : table.left_out) {
    context.warn(options.model + ": " + name +
                 " describes a sensor error; assess gives the true drawbar pull and leaves this effect out "
                 "(talus predict includes it)");
  }
  const Applicability applies =
      tableApplicability(options.table, options.model, options.rover, context.watch("checking the model"));
  if (context.stop.stop_requested()) return Exit::kCancelled;
  context.answer(jsonOf(table.rows, options.reference_slip), textOf(options, table.rows));
  if (applies.applies) return Exit::kDone;
  context.warn(options.table.path + ": the model does not apply: " + applies.reason);
  return Exit::kNo;
}

}  // namespace

void addAssess(CLI::App& app, Context& context) {
  addCommand<AssessCommand>(app, context, "assess", bind, run);
}

}  // namespace talus::cli
