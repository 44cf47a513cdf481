#include <cerrno>
#include <cstring>
#include <filesystem>

#include <unistd.h>

#include <talus/cli/app/command.hpp>

namespace talus::cli {
namespace {

void bind(CLI::App& command, ReproduceOptions& options) {
  addOption(command, "-o,--output DIR", options.output);
  auto* published = command.add_flag("--published", options.published);
  addOption(command, "name NAME", options.published_name)->needs(published);
  command.add_flag("--goals", options.goals_only);
  addOption(command, "--soils", options.soils)->check(CLI::Range(8, 100000));
  addOption(command, "--measured M.csv", options.measured);
}

// Path of talus-reproduce: beside this program, in the build folder, or in libexec of an installation.
std::filesystem::path validationProgram() {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const char* place : {"", "../tests/reproduce", "../libexec/talus"})
    if (auto path = folder / place / "talus-reproduce"; ::access(path.c_str(), X_OK) == 0) return path;
  throw InputError({(folder / "talus-reproduce").string(),
                    "the program that reproduces the thesis is not there",
                    "build the target talus_reproduce, or install talus again"});
}

int start(const ReproduceOptions&, Context& context) {
  const auto program = validationProgram();
  if (context.stop.stop_requested()) return Exit::kCancelled;
  ::execv(program.c_str(), const_cast<char* const*>(context.argv));
  throw InputError(
      {program.string(), std::strerror(errno), "build the target talus_reproduce, or install talus again"});
}

}  // namespace

void addReproduce(CLI::App& app, Context& context, int (*run)(const ReproduceOptions&, Context&)) {
  addCommand<ReproduceOptions>(app, context, "reproduce", bind, run);
}

void addReproduce(CLI::App& app, Context& context) {
  addReproduce(app, context, start);
}

}  // namespace talus::cli
