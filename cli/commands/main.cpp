#include <talus/cli/app/commands.hpp>

int main(int argc, char** argv) {
  return talus::cli::run(argc, argv, talus::cli::addCommands);
}
