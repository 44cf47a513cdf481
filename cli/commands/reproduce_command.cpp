#include <cerrno>
#include <cstring>
#include <filesystem>

#include <unistd.h>

#include <talus/cli/app/command.hpp>

namespace talus::cli {
namespace {

void bind(CLI::App& command, ReproduceOptions& options) {
  addOption(command, "-o,--output DIR", options.output, "folder for validation.md and validation/*.png");
  auto* published = command.add_flag("--published", options.published,
                                     "only rebuild published results: theirs, ours, error, source");
  addOption(command, "name NAME", options.published_name, "one published result (default: all)")
      ->needs(published);
  command.add_flag("--goals", options.goals_only, "only measure the estimators and print the table");
  command.add_option("--soils", options.soils, "number of soils sampled from thesis Table 2.1")
      ->check(CLI::Range(8, 100000));
  addOption(command, "--measured M.csv", options.measured,
            "CSV of measured load, torque, sinkage, slip and drawbar pull");
}

// Path of talus-reproduce: beside this program, in the build folder, or in libexec of an installation.
std::filesystem::path validationProgram() {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const char* place : {"", "../tests/reproduce", "../libexec/talus"})
    if (auto path = folder / place / "talus-reproduce"; ::access(path.c_str(), X_OK) == 0) return path;
  throw InputError({.where = (folder / "talus-reproduce").string(),
                    .reason = "the program that reproduces the thesis is not there",
                    .remedy = "build the target talus_reproduce, or install talus again"});
}

int start(const ReproduceOptions&, Context& context) {
  const auto program = validationProgram();
  if (context.stop.stop_requested()) return Exit::kCancelled;
  ::execv(program.c_str(), const_cast<char* const*>(context.argv));
  throw InputError({.where = program.string(),
                    .reason = std::strerror(errno),
                    .remedy = "build the target talus_reproduce, or install talus again"});
}

}  // namespace

void addReproduce(CLI::App& app, Context& context, int (*run)(const ReproduceOptions&, Context&)) {
  addCommand<ReproduceOptions>(app, context, "reproduce", bind, run);
}

void addReproduce(CLI::App& app, Context& context) {
  addReproduce(app, context, start);
}

}  // namespace talus::cli
