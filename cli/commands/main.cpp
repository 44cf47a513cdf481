#include <talus/cli/commands/program.hpp>

int main(int argc, char** argv) {
  return talus::cli::run(argc, argv);
}
