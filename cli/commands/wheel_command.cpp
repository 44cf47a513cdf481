#include <cmath>
#include <numbers>

#include <talus/cli/app/command.hpp>
#include <talus/cli/soil/table_options.hpp>
#include <talus/terramech/contact/pneumatic_tyre.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {
namespace {

struct WheelOptions {
  std::string soil, rover;
  double load_N = std::nan(""), slip = std::nan(""), slip_angle_rad = 0.0;
  double inflation_Pa = std::nan(""), carcass_Pa = 0.0, torque_Nm = std::nan("");
  bool hard_ground = false;
  std::string cases, output;
  TableOptions columns;
};

void bind(CLI::App& command, WheelOptions& options) {
  auto* soil = addOption(command, "--soil NAME|FILE", options.soil);
  auto* rover = addOption(command, "--rover NAME|FILE", options.rover);
  auto* load = addOption(command, "--load N", options.load_N)->check(finite());
  auto* slip = addOption(command, "--slip I", options.slip)->check(within(-1.0, 1.0));
  auto* angle = addOption(command, "--slip-angle RAD", options.slip_angle_rad)
                    ->check(within(-0.5 * std::numbers::pi, 0.5 * std::numbers::pi));
  auto* inflation = addOption(command, "--inflation PA", options.inflation_Pa)->check(notNegative());
  auto* carcass =
      addOption(command, "--carcass PA", options.carcass_Pa)->check(notNegative())->needs(inflation);
  auto* hard = command.add_flag("--hard-ground", options.hard_ground);
  auto* torque =
      addOption(command, "--torque NM", options.torque_Nm)->check(finite())->needs(hard)->excludes(slip);
  for (auto* straight : {inflation, hard}) straight->excludes(angle);
  hard->excludes(soil);
  auto* cases = addOption(command, "--cases IN.csv", options.cases);
  addOutput(command, "-o,--output OUT.csv", options.output)->needs(cases);
  for (auto* single : {soil, rover, load, slip, angle, inflation, carcass, hard, torque})
    cases->excludes(single);
  addTableOptions(command, options.columns);
  for (const char* column : {"--column", "--columns", "--radius", "--width"})
    command.get_option(column)->needs(cases);
}

[[noreturn]] void lacking(const std::string& option) {
  throw InputError(
      {"talus wheel", "missing " + option, "give --soil, --rover and --slip, or --cases IN.csv -o OUT.csv"});
}

int runTable(const WheelOptions& options, Context& context) {
  if (options.output.empty()) lacking("-o OUT.csv");
  const WheelCaseTable table =
      solveWheelTable(tableFile(options.cases, options.columns, context, wheelCaseColumns()), options.output,
                      context.workers(), context.watch("wheels"));
  if (table.replaced) context.warn(options.cases + ": contains result columns; they are replaced");
  warnOfRejected(table.refused, options.cases, context);
  context.answer(
      {{"rows_solved", table.solved},
       {"rows_refused", table.refused.size()},
       {"refused", rejectedJson(table.refused)}},
      fmt::format("{}: {} rows solved, {} refused\n", options.output, table.solved, table.refused.size()));
  return Exit::kDone;
}

std::string report(const terramech::WheelForces& forces, double load_N, double radius_m) {
  return fmt::format(
      "sinkage       {:10.3f} mm   z/r  {:.3f}\n"
      "entry angle   {:10.3f} deg\n"
      "torque        {:10.3f} Nm   T/rW {:.3f}\n"
      "drawbar pull  {:10.3f} N    DP/W {:.3f}\n"
      "side force    {:10.3f} N    F/W  {:.3f}\n",
      1e3 * forces.sinkage_m, forces.sinkage_m / radius_m, forces.entry_angle_rad / kDegree, forces.torque_Nm,
      forces.torque_Nm / (radius_m * load_N), forces.drawbar_pull_N, forces.drawbar_pull_N / load_N,
      forces.side_force_N, forces.side_force_N / load_N);
}

using Answer = std::pair<nlohmann::ordered_json, std::string>;

Answer rigidWheel(const WheelOptions& options, const terramech::Rover& rover, double load_N) {
  const terramech::Soil soil = terramech::underGravity(terramech::loadSoil(options.soil), rover.gravity_m_s2);
  const auto forces = terramech::equilibrium(soil, rover.wheel,
                                             {.load_N = load_N,
                                              .slip = options.slip,
                                              .slip_angle_rad = options.slip_angle_rad,
                                              .gravity_m_s2 = rover.gravity_m_s2});
  return {{{"soil", soil.name},
           {"rover", rover.name},
           {"load_N", load_N},
           {"slip", options.slip},
           {"slip_angle_rad", options.slip_angle_rad},
           {"sinkage_m", forces.sinkage_m},
           {"entry_angle_rad", forces.entry_angle_rad},
           {"torque_Nm", forces.torque_Nm},
           {"drawbar_pull_N", forces.drawbar_pull_N},
           {"side_force_N", forces.side_force_N}},
          report(forces, load_N, rover.wheel.radius_m)};
}

Answer pneumaticTyre(const WheelOptions& options, const terramech::Rover& rover, double load_N) {
  const terramech::Tyre tyre{
      .wheel = rover.wheel, .inflation_Pa = options.inflation_Pa, .carcass_Pa = options.carcass_Pa};
  const terramech::TyreOperation operation{load_N, options.slip};
  const terramech::TyreForces forces =
      options.hard_ground ? tyreOnRigidGround(tyre, operation)
                          : tyreOnSoftGround(tyre, terramech::loadSoil(options.soil), operation);
  const std::string mode = forces.mode == terramech::TyreMode::Rigid ? "rigid" : "flattened";
  return {{{"rover", rover.name},
           {"load_N", load_N},
           {"slip", options.slip},
           {"mode", mode},
           {"critical_pressure_Pa", forces.critical_pressure_Pa},
           {"sinkage_m", forces.sinkage_m},
           {"deflection_m", forces.deflection_m},
           {"flat_length_m", forces.flat_length_m},
           {"torque_Nm", forces.torque_Nm},
           {"drawbar_pull_N", forces.drawbar_pull_N}},
          fmt::format("tyre          {}\n"
                      "sinkage       {:10.3f} mm\n"
                      "deflection    {:10.3f} mm\n"
                      "flat length   {:10.3f} mm\n"
                      "torque        {:10.3f} Nm\n"
                      "drawbar pull  {:10.3f} N    DP/W {:.3f}\n",
                      mode, 1e3 * forces.sinkage_m, 1e3 * forces.deflection_m, 1e3 * forces.flat_length_m,
                      forces.torque_Nm, forces.drawbar_pull_N, forces.drawbar_pull_N / load_N)};
}

Answer hardGround(const WheelOptions& options, const terramech::Rover& rover, double load_N) {
  const terramech::RigidGroundForces forces =
      terramech::rigidGroundForces(rover.wheel, {}, load_N, options.torque_Nm);
  return {{{"rover", rover.name},
           {"load_N", load_N},
           {"torque_Nm", options.torque_Nm},
           {"drawbar_pull_N", forces.drawbar_pull_N},
           {"slips", forces.slips}},
          fmt::format("drawbar pull  {:10.3f} N    DP/W {:.3f}{}\n", forces.drawbar_pull_N,
                      forces.drawbar_pull_N / load_N, forces.slips ? "   the wheel slips" : "")};
}

int run(const WheelOptions& options, Context& context) {
  if (!options.cases.empty()) return runTable(options, context);
  const bool tyre = !std::isnan(options.inflation_Pa), rolls = options.hard_ground && !tyre;
  if (!options.hard_ground && options.soil.empty()) lacking("--soil");
  if (options.rover.empty()) lacking("--rover");
  if (rolls && std::isnan(options.torque_Nm)) lacking("--torque, or --inflation and --slip for a tyre");
  if (!rolls && std::isnan(options.slip)) lacking("--slip");
  const terramech::Rover rover = terramech::loadRover(options.rover);
  const double load_N = std::isnan(options.load_N) ? terramech::wheelLoad_N(rover) : options.load_N;
  const auto [json, text] = tyre    ? pneumaticTyre(options, rover, load_N)
                            : rolls ? hardGround(options, rover, load_N)
                                    : rigidWheel(options, rover, load_N);
  context.answer(json, text);
  return Exit::kDone;
}

std::string libraryText() {
  return wrapped("Soils: " + fmt::format("{}", fmt::join(terramech::librarySoils(), ", ")), kHelpWidth) +
         "\n" +
         wrapped("Rovers: " + fmt::format("{}", fmt::join(terramech::libraryRovers(), ", ")), kHelpWidth) +
         "\n";
}

}  // namespace

void addWheel(CLI::App& app, Context& context) {
  CLI::App& command = addCommand<WheelOptions>(app, context, "wheel", bind, run);
  command.footer(command.get_footer() + "\n" + libraryText());
}

}  // namespace talus::cli
