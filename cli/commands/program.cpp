#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <cpl_error.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <ompl/util/Console.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <unistd.h>
#include <yaml-cpp/exceptions.h>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/commands.hpp>
#include <talus/cli/app/context.hpp>
#include <talus/cli/app/options.hpp>
#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/common/nearest_name.hpp>

namespace talus::cli {
namespace {

// Smaller limits are not meaningful, because the program and its libraries use a part of the memory
// (docs/security.md).
constexpr double kLeastMemory_B = 1e8;

// Largest integer up to which all integers are exact in JSON numbers; route files state the seed.
constexpr double kGreatestSeed = 9007199254740992.0;

// CLI11's parser of sizes accepts a unit without a number as 1, 0x1GB as 1 GB, 010GB as 8 GB, and 1e as 1 EB.
CLI::Validator decimalSize() {
  const auto check = [](std::string& text) -> std::string {
    static const std::regex size(R"((0|[1-9]\d*) *(B|[KMGTP](I|I?B)?|E(I|I?B))?)", std::regex::icase);
    return std::regex_match(text, size)
               ? ""
               : text + ", must be a whole decimal number with or without a unit, such as 4GB";
  };
  return CLI::Validator(check, "");
}

/// Silences messages of the libraries, because errors are printed as one line on stderr; the libraries return
/// their errors.
void silenceLibraries() {
  CPLSetErrorHandler(CPLQuietErrorHandler);
  ompl::msg::noOutputHandler();
  spdlog::set_level(spdlog::level::off);
}

int fail(int code, std::string_view text) {
  std::fflush(stdout);
  printError(fmt::format("talus: {}\n", oneLine(text)));
  return code;
}

/// Prints the current exception and returns its exit code.
int failure() {
  try {
    throw;
  } catch (const InputError& e) {
    return fail(Exit::kInput, e.what());
  } catch (const std::filesystem::filesystem_error& e) {
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
    return fail(Exit::kInput, "out of memory; use a smaller map or window");
  } catch (const std::exception& e) {
    return fail(Exit::kInternal, fmt::format("internal failure: {}; please report it", e.what()));
  } catch (...) {
    return fail(Exit::kInternal, "internal failure of unknown type; please report it");
  }
}

/// Opens closed standard streams, because the first file that a call opens would get the number of a closed
/// stream. A write to a broken pipe becomes an error instead of a signal.
void keepStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 &&
        ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY) < 0)
      std::abort();
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file above the size limit is a failed write, as on a full disk
}

/// Returns true if the other end of standard output was closed, as by `head`.
bool readerIsGone() {
  pollfd out{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  return ::poll(&out, 1, 0) > 0 && (out.revents & POLLERR) != 0;
}

using Names = std::vector<std::string>;

Names subcommandNames(const CLI::App& app) {
  Names names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

// Option names for suggestions; deprecated names are accepted but not suggested.
Names optionNames(const CLI::App& app) {
  Names names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_group().empty() ? Names{} : option->get_lnames())
      names.push_back("--" + name);
  return names;
}

const CLI::App* chosen(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? nullptr : parsed.front();
}

/// Suggestion for an unknown word: ", did you mean 'plan'?".
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
  app.add_flag("--json", context.json);
  app.add_flag("--quiet", context.quiet);
  app.add_flag("--force", context.force);
  app.add_option_function<std::uint64_t>("--max-memory", setMemoryBudget)
      ->transform(CLI::AsSizeValue(false))
      ->transform(decimalSize())
      ->check(numberThat([](double bytes) { return bytes >= kLeastMemory_B; }, "100 MB or more, in bytes"))
      ->type_name("SIZE");
  addOption(app, "--seed N", context.seed)->check(within(0.0, kGreatestSeed));
  addOption(app, "--threads N", context.threads)->check(CLI::Range(1, 1024));
  app.fallthrough();
  app.require_subcommand(1);
}

/// Refuses an option without a value, because CLI11 would use the word after "--map=" as its value.
void refuseNoValue(std::string_view word) {
  if (word.starts_with("--") && word.find('=') == word.size() - 1)
    throw InputError({std::string(word.substr(0, word.size() - 1)), "its value is empty",
                      "leave the option out or give a value"});
}

/// Arguments in CLI11's order, last first; a leading "-.5" would be read as an option.
std::vector<std::string> words(int argc, const char* const* argv) {
  std::vector<std::string> reversed;
  for (int i = argc - 1; i > 0; --i) {
    std::string word = argv[i];
    refuseNoValue(word);
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
    std::ostringstream help;
    app.exit(error, help, help);
    print(help.str());
  }
  return context.exit_code;
}

}  // namespace

int run(int argc, const char* const* argv, AddCommand* add) {
  keepStandardStreams();
  Interrupt interrupt;
  silenceLibraries();
  Context context;
  context.argv = argv;
  context.stop = interrupt.token();
  context.answers_stop = &interrupt.answered();
  context.status = &interrupt.status();
  int code = Exit::kDone;
  try {
    requireMpiForRanks();
    CLI::App app("Plan safe routes for rovers over soft, sloping ground.", "talus");
    app.formatter(std::make_shared<HelpFormat>());
    app.option_defaults()->always_capture_default();
    addGlobalOptions(app, context);
    app.footer(
        "Topics: talus help formats, soils, rovers, missions. Manual page: talus help man. `./dev install`\n"
        "puts it in place, and the completion for bash, zsh and fish.");
    describeOptions(app);
    add(app, context);
    refuseEmptyValues(app);
    code = parseAndRun(app, context, words(argc, argv));
  } catch (...) {
    code = interrupt.requested() ? interrupt.code() : failure();
  }
  if (code != Exit::kDone && interrupt.requested()) return fail(interrupt.code(), "cancelled");
  errno = 0;
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written) return code;
  // After an earlier failed write, another write sets errno to the reason.
  const bool stated = errno != 0 || ::write(STDOUT_FILENO, "\n", 1) < 0;
  const std::string reason = stated ? std::string(": ") + std::strerror(errno) : "";
  if (readerIsGone()) return Exit::kReaderGone;
  return fail(Exit::kInput, "standard output: cannot be written" + reason + "; check where it leads");
}

}  // namespace talus::cli
