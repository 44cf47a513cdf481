// talus update MAP.ot T.csv -o MAP2.ot: adds the telemetry of a drive to a map.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/command.hpp>
#include <talus/cli/app/commands.hpp>
#include <talus/cli/app/file_lock.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/ground/map_options.hpp>
#include <talus/cli/soil/table_options.hpp>
#include <talus/common/input_error.hpp>
#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/telemetry/drive_evidence.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>

namespace talus::cli {
namespace {

struct UpdateOptions {
  std::string map;
  std::string telemetry;
  std::string output;
  std::string journal;
  bool replay = false;
  costmap::IntakeOptions intake;
  TableOptions columns;
};

void bind(CLI::App& command, UpdateOptions& options) {
  command.add_option("MAP", options.map, "traversability map from `talus costmap`")
      ->required()
      ->type_name("MAP.ot");
  command.add_option("TELEMETRY", options.telemetry, "wheel telemetry")->type_name("T.csv");
  addOutput(command, "-o,--output", options.output, "map to write")->required()->type_name("MAP2.ot");
  auto* journal =
      command.add_option("--journal", options.journal, "SQLite journal of every row, accepted or rejected")
          ->type_name("EVIDENCE.db");
  command
      .add_option("--pose-error", options.intake.pose_std_m,
                  "standard deviation of x_m and y_m if there is no column pose_std_m [m]")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command.add_flag("--replay", options.replay, "replay the whole journal instead of a telemetry file")
      ->needs(journal);
  groupOptions(command, "Evidence");
  addTableOptions(command, options.columns);
}

// Costs and categories of the cells at one time, for a comparison before and after.
struct Snapshot {
  std::shared_ptr<const costmap::CostGrid> grid;
  std::vector<std::uint8_t> categories;
};

Snapshot snapshotOf(const costmap::TraversabilityMap& map) {
  Snapshot snapshot{map.published(), {}};
  snapshot.categories.reserve(map.grid().size());
  for (int row = 0; row < map.grid().height; ++row)
    for (int column = 0; column < map.grid().width; ++column)
      snapshot.categories.push_back(map.costs().category({column, row}));
  return snapshot;
}

struct Difference {
  std::size_t cells = 0;
  std::size_t categories = 0;
};

bool sameCost(const Snapshot& a, const Snapshot& b, maps::Cell cell) {
  const std::size_t from = a.grid->at(cell).curve(), to = b.grid->at(cell).curve();
  const auto& before = a.grid->cost().curves();
  const auto& after = b.grid->cost().curves();
  if (from >= before.size() || to >= after.size()) return from == to;
  return before[from].cost_J_per_m == after[to].cost_J_per_m;
}

Difference between(const Snapshot& before, const Snapshot& after) {
  Difference difference;
  const maps::Grid& grid = before.grid->grid();
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const std::size_t i = grid.index({column, row});
      difference.categories += before.categories[i] != after.categories[i] ? 1U : 0U;
      difference.cells += sameCost(before, after, {column, row}) ? 0U : 1U;
    }
  return difference;
}

[[noreturn]] void refuseReplay(const UpdateOptions& options) {
  throw InputError(
      {options.journal, "contains nothing to replay", "name the journal that the drives went into"});
}

// Reports a journal without any usable row for this map: the journal probably belongs to another map.
void warnForeignJournal(const UpdateOptions& options, const costmap::DriveReport& report,
                        const Context& context) {
  const std::string reason = fmt::format("none of its {} rows lies on this map", report.rejected);
  if (options.replay) throw InputError({options.journal, reason, "name the journal of this map"});
  context.warn(options.journal + ": " + reason + "; the journal may belong to another map");
}

// A journal that does not exist yet, or is empty, is checked as an output.
void checkJournal(const UpdateOptions& options, bool force) {
  std::error_code error;
  const auto size = std::filesystem::file_size(options.journal, error);
  if (!force && !options.journal.empty() && (error || size == 0)) checkOutput(options.journal, {});
  for (const std::string& file : {options.output, options.map, options.telemetry})
    checkBesideJournal(file, options.journal);
}

void checkCall(const UpdateOptions& options) {
  std::error_code error;
  if (options.replay && (std::filesystem::file_size(options.journal, error) == 0 || error))
    refuseReplay(options);
  if (options.telemetry.empty() == options.replay) return;
  throw InputError({options.replay ? options.telemetry : "talus update",
                    options.replay ? "telemetry and --replay together" : "no telemetry",
                    "give T.csv, or --replay with --journal"});
}

terramech::Telemetry readDrive(const UpdateOptions& options, const costmap::TraversabilityMap& map,
                               const Context& context) {
  auto telemetry = terramech::readTelemetry(tableFile(options.telemetry, options.columns, context),
                                            {.required = {"x_m", "y_m", "load_N", "slip"},
                                             .wheel_radius_m = map.model().rover().wheel.radius_m,
                                             .once = true},
                                            context.watch("reading telemetry"));
  for (const auto& row : telemetry.rejected)
    context.warn(fmt::format("{}:{}: {}", options.telemetry, row.line, row.reason));
  if (telemetry.repeated > 0)
    context.warn(fmt::format("{}: {} rows repeat earlier rows in every field and are ignored",
                             options.telemetry, telemetry.repeated));
  return telemetry;
}

// Adds the rows of the file to the map. `report` contains the rows replayed from the journal.
void addTelemetry(const UpdateOptions& options, costmap::TraversabilityMap& map,
                  const terramech::Telemetry& telemetry, costmap::EvidenceJournal* journal,
                  const Context& context, costmap::DriveReport& report) {
  const costmap::DriveReport drive = costmap::addDrive(map, telemetry, journal, options.intake);
  if (drive.repeated == telemetry.size())
    context.warn(options.telemetry + ": all rows of this drive are in the map already; no row is added");
  else if (drive.repeated > 0)
    context.warn(
        fmt::format("{}: the first {} rows of this drive are in the map already; the later rows are added",
                    options.telemetry, drive.repeated));
  else if (drive.used == 0 && drive.bounding == 0)
    throw InputError({options.telemetry, fmt::format("none of its {} rows is usable", drive.rejected),
                      "first reason: " + drive.first_reason});
  report.used += drive.used;
  report.raising += drive.raising;
  report.rejected += drive.rejected + telemetry.rejected.size();
  report.repeated = drive.repeated + telemetry.repeated;
  report.learned = drive.learned;
  report.slip_offset = drive.slip_offset;
  report.slip_scale = drive.slip_scale;
  report.findings.insert(report.findings.end(), drive.findings.begin(), drive.findings.end());
}

nlohmann::json learnedJson(const costmap::DriveReport& report) {
  nlohmann::json all = nlohmann::json::array();
  for (const costmap::LearnedClass& one : report.learned)
    all.push_back({{"class", one.class_number},
                   {"drawbar_pull_over_load", one.pull.value},
                   {"std", one.pull.std},
                   {"if_sensor_sound", one.if_sound.value},
                   {"if_sensor_sound_std", one.if_sound.std},
                   {"counted_on", one.counted_on}});
  return all;
}

std::string learnedText(const costmap::DriveReport& report) {
  if (report.learned.empty()) return {};
  std::string text =
      fmt::format("slip        offset {:+.3f}, scale {:.2f}\n", report.slip_offset, report.slip_scale);
  for (const costmap::LearnedClass& one : report.learned)
    text += fmt::format(
        "class {:<5} DP/W {:.3f} +- {:.3f} ({:.3f} +- {:.3f} if the slip is sound); decisions count on "
        "{:.3f}\n",
        one.class_number, one.pull.value, one.pull.std, one.if_sound.value, one.if_sound.std, one.counted_on);
  return text;
}

void printReport(const costmap::DriveReport& report, const Difference& difference, const Context& context) {
  if (context.json)
    printJson({{"rows_used", report.used},
               {"rows_rejected", report.rejected},
               {"rows_raising", report.raising},
               {"rows_counted_before", report.repeated},
               {"cells_changed", difference.cells},
               {"categories_changed", difference.categories},
               {"slip_offset", report.slip_offset},
               {"slip_scale", report.slip_scale},
               {"learned", learnedJson(report)},
               {"findings", report.findings}});
  else
    print(
        fmt::format("rows        {} used, {} rejected; {} able to raise the estimate\n"
                    "cells       {} changed, {} with a new category\n{}",
                    report.used, report.rejected, report.raising, difference.cells, difference.categories,
                    learnedText(report)));
}

int run(const UpdateOptions& options, Context& context) {
  checkCall(options);
  checkJournal(options, context.force);
  const FileLock lock({options.map, options.output}, context.stop);
  OutputFile output(options.output);
  costmap::TraversabilityMap map = readBuiltMap(options.map, context);
  std::optional<terramech::Telemetry> telemetry;
  if (!options.replay) telemetry = readDrive(options, map, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  // Opening creates the journal, and so follows the reading of all other files of the call.
  std::optional<costmap::EvidenceJournal> journal;
  std::optional<costmap::EvidenceJournal::Transaction> transaction;
  if (!options.journal.empty()) transaction.emplace(journal.emplace(options.journal));
  if (options.replay && journal->drives().empty()) refuseReplay(options);

  const Snapshot before = snapshotOf(map);
  // Rows of the journal that are missing in the map, as after an interrupted call, are added before this
  // drive.
  costmap::DriveReport report;
  if (journal) report = costmap::replay(map, *journal);
  if (report.used == 0 && report.rejected > 0) warnForeignJournal(options, report, context);
  if (telemetry) {
    if (report.used + report.rejected > 0)
      context.warn(fmt::format("{}: {} rows that the map lacks were put in from it", options.journal,
                               report.used + report.rejected));
    addTelemetry(options, map, *telemetry, journal ? &*journal : nullptr, context, report);
  }
  for (const std::string& finding : report.findings) context.warn(finding);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  costmap::writeMap(map, output.stream());
  output.sync();
  if (transaction) transaction->commit();
  output.commit();
  printReport(report, between(before, snapshotOf(map)), context);
  return Exit::kDone;
}

}  // namespace

void addUpdate(CLI::App& app, Context& context) {
  addCommand<UpdateOptions>(
      app, context,
      {.name = "update",
       .group = Group::kMaps,
       .description = "update a traversability map with the telemetry of a drive",
       .examples = "  talus update map.ot drive.csv -o map2.ot --journal evidence.db\n"
                   "  talus update map.ot --replay --journal evidence.db -o rebuilt.ot\n"},
      bind, run);
}

}  // namespace talus::cli
