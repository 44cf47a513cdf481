#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <cpl_error.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <ompl/util/Console.h>
#include <spdlog/spdlog.h>
#include <yaml-cpp/exceptions.h>

#include <talus/cli/app/commands.hpp>
#include <talus/cli/app/context.hpp>
#include <talus/cli/app/interrupt.hpp>
#include <talus/cli/app/mpi_launch.hpp>
#include <talus/cli/app/number_check.hpp>
#include <talus/cli/commands/program.hpp>
#include <talus/talus.hpp>

namespace talus::cli {
namespace {

/// The libraries' own chatter would break "one line on stderr"; their errors reach us as return values.
void silenceLibraries() {
  CPLSetErrorHandler(CPLQuietErrorHandler);
  ompl::msg::noOutputHandler();
  spdlog::set_level(spdlog::level::off);
}

int fail(int code, std::string_view text) {
  std::fflush(stdout);
  fmt::print(stderr, "talus: {}\n", oneLine(text));
  return code;
}

/// The exit code and line for the exception in flight.
int failure() {
  try {
    throw;
  } catch (const InputError& e) {
    return fail(Exit::kInput, e.what());
  } catch (const std::invalid_argument& e) {
    return fail(Exit::kInput, e.what());
  } catch (const nlohmann::json::exception& e) {
    return fail(Exit::kInput, fmt::format("malformed JSON: {}", e.what()));
  } catch (const YAML::Exception& e) {
    return fail(Exit::kInput, fmt::format("malformed YAML: {}", e.what()));
  } catch (const std::domain_error& e) {
    return fail(Exit::kNo, e.what());
  } catch (const std::bad_alloc&) {
    return fail(Exit::kInternal, "out of memory; use a smaller map or window");
  } catch (const std::exception& e) {
    return fail(Exit::kInternal, fmt::format("internal failure: {}; please report it", e.what()));
  } catch (...) {
    return fail(Exit::kInternal, "internal failure of unknown kind; please report it");
  }
}

std::vector<std::string> subcommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> optionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

const CLI::App* chosen(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? nullptr : parsed.front();
}

/// What the unknown word may have meant: ", did you mean 'plan'?".
std::string suggestion(const CLI::App& app, const std::string& word) {
  const CLI::App* command = chosen(app);
  std::vector<std::string> known = optionNames(app);
  if (command != nullptr) {
    for (std::string& name : optionNames(*command)) known.push_back(std::move(name));
  } else if (word.front() != '-') {
    known = subcommandNames(app);
  }
  const std::string near = nearestName(word.substr(0, word.find('=')), known);
  return near.empty() ? "" : fmt::format(", did you mean '{}'?", near);
}

int parseFailure(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = chosen(app);
  const std::string help =
      fmt::format("; see talus {}--help", command == nullptr ? "" : command->get_name() + " ");
  const std::vector<std::string> unknown = app.remaining(true);
  if (!unknown.empty()) {
    const char* kind = unknown[0].starts_with('-') ? "option"
                       : command == nullptr        ? "subcommand"
                                                   : "argument";
    return fail(Exit::kInput,
                fmt::format("unknown {} '{}'{}{}", kind, unknown[0], suggestion(app, unknown[0]), help));
  }
  if (command == nullptr && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
    return fail(Exit::kInput, "no subcommand" + help);
  return fail(Exit::kInput, error.what() + help);
}

void addGlobalOptions(CLI::App& app, Context& context) {
  app.set_version_flag("--version", "talus " TALUS_VERSION);
  app.set_help_flag("-h,--help", "print this help");
  app.add_flag("--json", context.json, "print the result as JSON");
  app.add_flag("--quiet", context.quiet, "no progress, no warnings");
  app.add_option("--seed", context.seed, "seed of every random number")
      ->check(notNegative())
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--threads", context.threads, "use at most N threads (default: one a core)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  app.fallthrough();
  app.require_subcommand(1);
}

/// Words as CLI11 takes them, last first; a leading "-.5" would be read as an option.
std::vector<std::string> words(int argc, const char* const* argv) {
  std::vector<std::string> reversed;
  for (int i = argc - 1; i > 0; --i) {
    std::string word = argv[i];
    if (word.starts_with("-.")) word.insert(1, "0");
    reversed.push_back(std::move(word));
  }
  return reversed;
}

int parseAndRun(CLI::App& app, const Context& context, std::vector<std::string> reversed_words) {
  try {
    app.parse(std::move(reversed_words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return parseFailure(app, error);
    return app.exit(error);
  }
  return context.exit_code;
}

}  // namespace

int run(int argc, const char* const* argv) {
  const Interrupt interrupt;
  silenceLibraries();
  Context context;
  context.stop = interrupt.token();
  int code = Exit::kDone;
  try {
    requireMpiForRanks();
    CLI::App app("Safe routes for rovers over soft, sloping ground.", "talus");
    addGlobalOptions(app, context);
    addCommands(app, context);
    code = parseAndRun(app, context, words(argc, argv));
  } catch (...) {
    code = interrupt.requested() ? Exit::kCancelled : failure();
  }
  if (code != Exit::kDone && interrupt.requested()) return fail(Exit::kCancelled, "cancelled");
  if (std::fflush(stdout) != 0 || !std::cout.flush())
    return fail(Exit::kInternal, "cannot write to standard output");
  return code;
}

}  // namespace talus::cli
