#pragma once

#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/commands.hpp>
#include <talus/cli/app/context.hpp>
#include <talus/cli/app/options.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/common/common.hpp>

namespace talus::cli {

/// Headings of the groups of subcommands in `talus --help`.
struct Group {
  static constexpr const char* kRoutes = "Routes";
  static constexpr const char* kMaps = "Maps";
  static constexpr const char* kSoil = "Wheels and soil";
  static constexpr const char* kHelp = "Help";
};

/// The text of a subcommand in --help.
struct CommandText {
  std::string name;
  std::string group;        ///< heading, one of Group
  std::string description;  ///< purpose in one line
  std::string examples;     ///< at least two example calls, each on lines indented by two blanks
};

template <typename Options, typename Run>
CLI::App& registerCommand(CLI::App& app, Context& context, const CommandText& text,
                          void (*bind)(CLI::App&, Options&), Run run) {
  CLI::App& command = *app.add_subcommand(text.name, text.description)->group(text.group);
  command.set_help_flag("-h,--help", "print this help; `talus --help` lists the options of all calls");
  command.footer("Examples:\n" + text.examples);
  auto options = std::make_shared<Options>();
  bind(command, *options);
  command.callback([options, run, &command, &context] {
    checkNumbers(command);
    const InputRecord manifest;
    checkOutputs(command, context.force);
    context.exit_code = run(*options, context);
  });
  return command;
}

/// Registers a subcommand. `bind` declares the options of the subcommand as fields of a plain struct.
/// `run(options, context)` receives the parsed struct and returns the exit code of the program. main() prints exceptions.
template <typename Options>
CLI::App& addCommand(CLI::App& app, Context& context, const CommandText& text,
                     void (*bind)(CLI::App&, Options&), int (*run)(const Options&, Context&)) {
  return registerCommand(app, context, text, bind, run);
}
/// The same for a command that a mission completes.
template <typename Options>
CLI::App& addCommand(CLI::App& app, Context& context, const CommandText& text,
                     void (*bind)(CLI::App&, Options&), int (*run)(Options&, Context&)) {
  return registerCommand(app, context, text, bind, run);
}

}  // namespace talus::cli
