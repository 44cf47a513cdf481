// talus update MAP.ot T.csv -o MAP2.ot: adds the telemetry of a drive to a map, leaves a drive out, lists drives.
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <talus/cli/app/command.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/cli/soil/table_options.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {
namespace {

struct UpdateOptions {
  std::string map;
  std::string telemetry;
  std::string output;
  std::string journal;
  std::vector<std::string> joined, without;
  bool replay = false, list = false;
  costmap::IntakeOptions intake;
  TableOptions columns;
};

void bind(CLI::App& command, UpdateOptions& options) {
  addOption(command, "MAP MAP.ot", options.map)->required();
  addOption(command, "TELEMETRY T.csv", options.telemetry);
  addOutput(command, "-o,--output MAP2.ot", options.output);
  auto* journal = addOption(command, "--journal EVIDENCE.db", options.journal);
  addOption(command, "--pose-error", options.intake.pose_std_m)->check(CLI::Range(0.0, 10.0));
  command.add_flag("--replay", options.replay)->needs(journal);
  addOption(command, "--join OTHER.db", options.joined)->needs(journal);
  addOption(command, "--without DRIVE", options.without);
  command.add_flag("--list", options.list);
  addTableOptions(command, options.columns);
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
  const bool other = options.list || !options.without.empty();
  if (options.output.empty() &&
      (!options.list || options.replay || !options.telemetry.empty() || !options.without.empty()))
    throw InputError({"talus update", "no map to write", "give -o MAP2.ot"});
  if (options.telemetry.empty() ? options.replay || other : !options.replay) return;
  throw InputError({options.replay ? options.telemetry : "talus update",
                    options.replay ? "telemetry and --replay together" : "no telemetry",
                    "give T.csv, --replay with --journal, --without or --list"});
}

terramech::Telemetry readDrive(const UpdateOptions& options, const costmap::TraversabilityMap& map,
                               const Context& context) {
  auto telemetry = terramech::readTelemetry(tableFile(options.telemetry, options.columns, context),
                                            {.required = {"x_m", "y_m", "load_N", "slip"},
                                             .wheel_radius_m = map.model().rover().wheel.radius_m,
                                             .once = true},
                                            context.watch("reading telemetry"));
  warnOfRejected(telemetry.rejected, options.telemetry, context);
  if (telemetry.repeated > 0)
    context.warn(fmt::format("{}: {} rows repeat earlier rows in every field and are ignored",
                             options.telemetry, telemetry.repeated));
  return telemetry;
}

// Adds the rows of the file to the map. `report` contains the rows replayed from the journal.
void addTelemetry(const UpdateOptions& options, costmap::TraversabilityMap& map,
                  const terramech::Telemetry& telemetry, costmap::EvidenceJournal* journal,
                  const Context& context, costmap::DriveReport& report) {
  costmap::DriveReport drive = costmap::addDrive(map, telemetry, journal, options.intake);
  if (drive.repeated == telemetry.size())
    context.warn(options.telemetry + ": all rows of this drive are in the map already; no row is added");
  else if (drive.repeated > 0)
    context.warn(
        fmt::format("{}: the first {} rows of this drive are in the map already; the later rows are added",
                    options.telemetry, drive.repeated));
  else if (drive.used == 0 && drive.bounding == 0)
    throw InputError({options.telemetry, fmt::format("none of its {} rows is usable", drive.rejected),
                      "first reason: " + drive.first_reason});
  drive.used += report.used;
  drive.raising += report.raising;
  drive.rejected += report.rejected + telemetry.rejected.size();
  drive.repeated += telemetry.repeated;
  drive.findings.insert(drive.findings.begin(), report.findings.begin(), report.findings.end());
  report = std::move(drive);
}

// What the last drive taught about each class: as JSON, and as text.
std::pair<nlohmann::json, std::string> learned(const costmap::DriveReport& report) {
  nlohmann::json all = nlohmann::json::array();
  std::string text;
  if (!report.learned.empty())
    text = fmt::format("slip        offset {:+.3f}, scale {:.2f}\n", report.slip_offset, report.slip_scale);
  for (const costmap::LearnedClass& one : report.learned) {
    all.push_back({{"class", one.class_number},
                   {"drawbar_pull_over_load", one.pull.value},
                   {"std", one.pull.std},
                   {"if_sensor_sound", one.if_sound.value},
                   {"if_sensor_sound_std", one.if_sound.std},
                   {"counted_on", one.counted_on}});
    text += fmt::format(
        "class {:<5} DP/W {:.3f} +- {:.3f} ({:.3f} +- {:.3f} if the slip is sound); decisions count on "
        "{:.3f}\n",
        one.class_number, one.pull.value, one.pull.std, one.if_sound.value, one.if_sound.std, one.counted_on);
  }
  return {all, text};
}

// Leaves the drives of --without out of the map. A drive that only the journal has is not replayed.
void leaveOut(const UpdateOptions& options, costmap::TraversabilityMap& map) try {
  for (const std::string& id : options.without)
    if (map.drives().contains(id) || !options.replay) map.leaveOut(id);
  if (!options.without.empty()) map.publishAll();
} catch (const std::invalid_argument& e) {
  throw InputError({options.map, e.what(), "name a drive of `talus update MAP.ot --list`"});
}

// What each drive taught, as JSON and as text: the difference between the map and the map without the drive, for
// classes, and one place of each block whose DP/W rose or fell by more than 0.05, by cause.
std::pair<nlohmann::json, std::string> drivesOf(const costmap::TraversabilityMap& map) {
  nlohmann::json all = nlohmann::json::array();
  std::string text;
  const int side = map.evidence().blockCells();
  for (const auto& [id, drive] : map.drives()) {
    nlohmann::json one{{"drive", id}, {"sensors", drive.sensors}};
    text += fmt::format("drive {}: {}\n", id, drive.sensors);
    costmap::TraversabilityMap less = map.moved({0, 0});
    if (drive.number != 0) less.leaveOut(id);
    for (int c = 0; const costmap::GroundClass& ground : map.model().parts().classes) {
      const double with = map.evidence().classBelief(c).pull.value,
                   without = less.evidence().classBelief(c++).pull.value;
      one["classes"].push_back({{"class", ground.number}, {"with", with}, {"without", without}});
      text +=
          fmt::format("  class {}: DP/W {:.3f}, without this drive {:.3f}\n", ground.number, with, without);
    }
    costmap::PlaceBeliefs with(map), without(less);
    std::map<std::string, int> blocks;
    for (maps::Cell cell{0, side / 2}; cell.row < map.grid().height; cell.row += side)
      for (cell.column = side / 2; cell.column < map.grid().width; cell.column += side) {
        const auto to = with.ground(cell), from = without.ground(cell);
        if (!to || std::abs(to->pull.value - from->pull.value) <= 0.05) continue;
        const auto *own = map.evidence().evidence(cell), *rest = less.evidence().evidence(cell);
        const double others = rest ? std::fmin(rest->bound().most_pull, 1.0) : 1.0;
        const std::string way = to->pull.value < from->pull.value ? "fell" : "rose",
                          why = own && own->bound().most_pull < others ? "a wheel failed here"
                                : own                                  ? "readings here"
                                      : "readings nearby, or the mean of the class";
        const maps::Point at = map.grid().centre(cell);
        one[way][why].push_back({at.x_m, at.y_m});
        ++blocks[way + ": " + why];
      }
    for (const auto& [cause, count] : blocks) text += fmt::format("  {} blocks {}\n", count, cause);
    all.push_back(std::move(one));
  }
  return {all, text};
}

// Prints the report; `categories` are those before the call.
void printReport(const UpdateOptions& options, const costmap::DriveReport& report,
                 const costmap::TraversabilityMap& map, const costmap::CostGrid& before,
                 const std::vector<std::uint8_t>& categories, const Context& context) {
  const std::vector<std::uint8_t> now = map.costs().categories().values();
  std::size_t recategorised = 0;
  for (std::size_t i = 0; i < now.size(); ++i) recategorised += now[i] != categories[i] ? 1U : 0U;
  const std::size_t cells = map.costs().cellsChanged(before);
  const auto [json, text] = learned(report);
  nlohmann::json out{{"rows_used", report.used},
                     {"rows_rejected", report.rejected},
                     {"rows_raising", report.raising},
                     {"rows_counted_before", report.repeated},
                     {"cells_changed", cells},
                     {"categories_changed", recategorised},
                     {"slip_offset", report.slip_offset},
                     {"slip_scale", report.slip_scale},
                     {"learned", json},
                     {"findings", report.findings}};
  const auto [drives, list] = options.list ? drivesOf(map) : std::pair<nlohmann::json, std::string>();
  if (options.list) out["drives"] = drives;
  if (context.json) return printJson(out);
  if (!options.output.empty())
    print(
        fmt::format("rows        {} used, {} rejected; {} able to raise the estimate\n"
                    "cells       {} changed, {} with a new category\n{}",
                    report.used, report.rejected, report.raising, cells, recategorised, text));
  print(list);
}

int run(const UpdateOptions& options, Context& context) {
  checkCall(options);
  checkJournal(options, context.force);
  const FileLock lock({options.map, options.output.empty() ? options.map : options.output}, context.stop);
  std::optional<OutputFile> output;
  if (!options.output.empty()) output.emplace(options.output);
  costmap::TraversabilityMap map = readBuiltMap(options.map, readingOf(context));
  std::optional<terramech::Telemetry> telemetry;
  if (!options.telemetry.empty()) telemetry = readDrive(options, map, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  // Opening creates the journal, and so follows the reading of all other files of the call.
  std::optional<costmap::EvidenceJournal> journal;
  std::optional<costmap::EvidenceJournal::Transaction> transaction;
  if (!options.journal.empty()) transaction.emplace(journal.emplace(options.journal));
  for (const std::string& other : options.joined) {
    const costmap::EvidenceJournal from(other);
    for (const std::string& drive : from.drives()) journal->append(drive, from.rows(drive));
  }
  if (options.replay && journal->drives().empty()) refuseReplay(options);

  const std::shared_ptr<const costmap::CostGrid> before = map.published();
  const std::vector<std::uint8_t> categories = map.costs().categories().values();
  leaveOut(options, map);
  // Rows of the journal that are missing in the map, as after an interrupted call, are added before this
  // drive.
  costmap::DriveReport report;
  if (journal) report = costmap::replay(map, *journal, {options.without.begin(), options.without.end()});
  if (report.used == 0 && report.rejected > 0) warnForeignJournal(options, report, context);
  if (telemetry) {
    if (report.used + report.rejected > 0)
      context.warn(fmt::format("{}: {} rows that the map lacks were put in from it", options.journal,
                               report.used + report.rejected));
    addTelemetry(options, map, *telemetry, journal ? &*journal : nullptr, context, report);
  }
  for (const std::string& finding : report.findings) context.warn(finding);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  if (output) costmap::writeMap(map, output->stream());
  if (output) output->sync();
  if (transaction) transaction->commit();
  if (output) output->commit();
  printReport(options, report, map, *before, categories, context);
  return Exit::kDone;
}

}  // namespace

void addUpdate(CLI::App& app, Context& context) {
  addCommand<UpdateOptions>(app, context, "update", bind, run);
}

}  // namespace talus::cli
