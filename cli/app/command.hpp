#pragma once

#include <memory>

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

template <typename Options, typename Run>
CLI::App& registerCommand(CLI::App& app, Context& context, const char* name,
                          void (*bind)(CLI::App&, Options&), Run run) {
  CLI::App& command = addSubcommand(app, name);
  auto options = std::make_shared<Options>();
  bind(command, *options);
  describeOptions(command);
  command.callback([options, run, &command, &context] {
    checkNumbers(command);
    const InputRecord manifest;
    checkOutputs(command, context.force);
    context.exit_code = run(*options, context);
  });
  return command;
}

/// Registers the subcommand `name`. `bind` declares the options of the subcommand as fields of a plain struct.
/// `run(options, context)` receives the parsed struct and returns the exit code of the program. main() prints exceptions.
template <typename Options>
CLI::App& addCommand(CLI::App& app, Context& context, const char* name, void (*bind)(CLI::App&, Options&),
                     int (*run)(const Options&, Context&)) {
  return registerCommand(app, context, name, bind, run);
}
/// The same for a command that a mission completes.
template <typename Options>
CLI::App& addCommand(CLI::App& app, Context& context, const char* name, void (*bind)(CLI::App&, Options&),
                     int (*run)(Options&, Context&)) {
  return registerCommand(app, context, name, bind, run);
}

}  // namespace talus::cli
