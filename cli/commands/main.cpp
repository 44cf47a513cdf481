#include <talus/cli/app/commands.hpp>
#include <talus/cli/commands/program.hpp>

int main(int argc, char** argv) {
  return talus::cli::run(argc, argv, talus::cli::addCommands);
}
