// talus help [TOPIC]: describes file formats, or prints the help of a subcommand.

#include <talus/cli/app/command.hpp>
#include <talus/cli/ground/file_formats.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {
namespace {

struct HelpOptions {
  std::string topic;
  const CLI::App* command = nullptr;
};

struct Topic {
  const char* name;
  const char* about;
  std::string (*text)(const CLI::App& app);
};

std::string librarySoilsText() {
  std::string text = fmt::format("{:24} {:>8} {:>8} {:>6} {:>8}\n", "soil", "c kPa", "phi deg", "n", "K mm");
  for (const std::string& name : terramech::librarySoils()) {
    const terramech::Soil soil = terramech::loadSoil(name);
    text += fmt::format("{:24} {:8.3g} {:8.3g} {:6.3g} {:8.3g}\n", name, 1e-3 * soil.cohesion_Pa,
                        soil.friction_angle_rad / kDegree, soil.sinkage_exponent, 1e3 * soil.shear_modulus_m);
  }
  return text +
         "\nKeys of a soil file: talus help formats. A wheel on one: talus wheel --soil NAME --rover NAME "
         "--slip 0.3\n";
}

std::string libraryRoversText() {
  std::string text =
      fmt::format("{:24} {:>8} {:>8} {:>6} {:>14}\n", "rover", "mass kg", "g m/s2", "wheels", "wheel r, b m");
  for (const std::string& name : terramech::libraryRovers()) {
    const terramech::Rover rover = terramech::loadRover(name);
    text +=
        fmt::format("{:24} {:8.4g} {:8.3g} {:6} {:>14}\n", name, rover.mass_kg, rover.gravity_m_s2,
                    rover.wheel_count, fmt::format("{:g}, {:g}", rover.wheel.radius_m, rover.wheel.width_m));
  }
  return text + "\nKeys of a rover file: talus help formats\n";
}

// Returns the text of a manual page. No line begins with a roff request or is wider than a terminal.
std::string roff(std::string_view text) {
  constexpr std::size_t kWidth = 72;
  std::string out;
  std::size_t line = 0;
  for (const char c : text) {
    if (out.ends_with('\n')) line = out.size();
    if (c == ' ' && out.size() - line >= kWidth - 16)
      out += '\n';
    else if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
      out += std::string("\\&") + c;
    else
      out += c;
  }
  return out;
}

std::string valueOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return option.get_type_size() == 0 ? "" : type.substr(0, endOfTypeName(type));
}

// Options shown by --help; deprecated names have no group.
std::vector<const CLI::Option*> shown(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

std::string optionsText(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : shown(app)) {
    const bool positional = !option->nonpositional();
    std::string name = option->get_name(positional);
    name.resize(std::min(name.size(), name.find('{')));
    text +=
        fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(name),
                    positional || valueOf(*option).empty() ? "" : " \\fI" + roff(valueOf(*option)) + "\\fR",
                    roff(option->get_description()));
  }
  return text;
}

/// Returns the manual page talus(1) with all subcommands and their options.
std::string manualPage(const CLI::App& app) {
  std::string text = ".TH TALUS 1 2026-11-01 \"talus " TALUS_VERSION
                     "\" \"User Commands\"\n.SH NAME\ntalus \\- " +
                     roff(app.get_description()) +
                     "\n.SH SYNOPSIS\n.B talus\n.I call\n.RI [ options ]\n.SH OPTIONS\nOf every call:\n" +
                     optionsText(app) + ".SH CALLS\n";
  for (const CLI::App* call : app.get_subcommands({}))
    text += fmt::format(".SS talus {}\n{}.\n{}", roff(call->get_name()), roff(call->get_description()),
                        optionsText(*call));
  return text +
         ".SH EXIT STATUS\n0 done; 1 no (no route, no fit);\n2 the call or an input is wrong; 3 an internal "
         "failure; 130 cancelled.\n.SH FILES\nKeys and columns of all files: \\fBtalus help formats\\fR.\n";
}

constexpr Topic kTopics[] = {
    {"formats", "keys and columns of files", [](const CLI::App&) { return formatsText(); }},
    {"soils", "soils of the library", [](const CLI::App&) { return librarySoilsText(); }},
    {"rovers", "rovers of the library", [](const CLI::App&) { return libraryRoversText(); }},
    {"missions", "a mission file with every key",
     [](const CLI::App&) {
       return missionText({{"dem", "dem.tif"},
                           {"rover", "mer"},
                           {"soil", "mars_blocky"},
                           {"start", "100,100"},
                           {"goal", "900,900"},
                           {"output", "route.geojson"}});
     }},
    {"man", "manual page, for man", manualPage},
};

void bind(CLI::App& command, HelpOptions& options) {
  std::string topics;
  for (const Topic& topic : kTopics) topics += fmt::format("{} ({}), ", topic.name, topic.about);
  addOption(command, "TOPIC", options.topic)->description(topics + "or the name of a call");
  options.command = &command;
}

std::string helpOf(const std::string& topic, const CLI::App& app) {
  // app.help() would print the help of the current subcommand.
  if (topic.empty()) return app.get_formatter()->make_help(&app, "talus", CLI::AppFormatMode::Normal);
  std::vector<std::string> known;
  for (const Topic& one : kTopics) {
    if (topic == one.name) return one.text(app);
    known.emplace_back(one.name);
  }
  for (const CLI::App* call : app.get_subcommands({})) {
    if (call->get_name() == topic) return call->help("talus");
    known.push_back(call->get_name());
  }
  const std::string near = nearestName(topic, known);
  throw InputError({topic, "is no topic of help",
                    near.empty() ? "write talus help formats, or talus help and the name of a call"
                                 : "did you mean " + near + "?"});
}

nlohmann::ordered_json formatsJson() {
  nlohmann::ordered_json all;
  for (const FileFormat& format : fileFormats())
    for (const terramech::FileKey& key : format.keys) all[format.title][key.name] = key.meaning;
  return {{"formats", all}};
}

int run(const HelpOptions& options, Context& context) {
  if (options.topic == "formats" && context.json)
    printJson(formatsJson());
  else
    print(helpOf(options.topic, *options.command->get_parent()));
  return Exit::kDone;
}

}  // namespace

void addHelp(CLI::App& app, Context& context) {
  addCommand<HelpOptions>(app, context, "help", bind, run);
}

}  // namespace talus::cli
