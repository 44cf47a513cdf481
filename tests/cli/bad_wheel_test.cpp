// Invalid calls of wheel.
#include "bad_input.hpp"

namespace talus::cli {
namespace bad_wheel_test {

TEST(BadInput, InvalidWheelCallsAreRejectedWithOneLine) {
  const auto wheel = [](const std::vector<std::string>& more) {
    return joined({"wheel", "--soil", "clay", "--rover", "fido"}, more);
  };
  std::vector<BadCall> calls{
      {{"wheel"}, 2, "missing --soil"},
      {wheel({"--load", "100"}), 2, "missing --slip"},
      {wheel({"--load", "-1", "--slip", "0.2"}), 2, "load_N = -1, must be > 0"},
      {wheel({"--load", "nan", "--slip", "0.2"}), 2, "--load: nan, must be a finite number"},
      {wheel({"--load", "100", "--slip", "2"}), 2, "--slip: 2, must be -1 to 1"},
      {wheel({"--load", "1e12", "--slip", "0.5"}), 1, "sinks to its axle"},
      {{"wheel", "--soil", "/dev/zero", "--rover", "fido", "--slip", "0.2"}, 2, "is a device"},
      {{"wheel", "--soil", "cley", "--rover", "fido", "--slip", "0.2"}, 2, "did you mean clay?"},
  };
  for (const char* file : {"missing.csv", "folder", "empty.csv", "head_only.csv", "wrong_columns.csv",
                           "words.csv", "garbage.csv"})
    calls.push_back({{"wheel", "--cases", file, "-o", "out.csv"}, 2, file});
  expectRefused(BadFiles(), calls);
}

}  // namespace bad_wheel_test
}  // namespace talus::cli
