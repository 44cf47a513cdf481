#include <filesystem>
#include <fstream>

#include <refused.hpp>

#include <talus/common/common.hpp>

namespace talus {
namespace input_file_test {

std::string written(const std::string& name, const std::string& content) {
  const std::string path = testing::TempDir() + "input_file_test_" + name;
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

class InputFile : public testing::Test {
 protected:
  void SetUp() override {
    if (sha256OfFile(written("probe", "")).empty()) GTEST_SKIP() << "built without nettle";
  }
};

TEST_F(InputFile, DigestsMatchKnownMessages) {
  // Printed in: examples of FIPS 180-4 (NIST, SHA256.pdf): one block, two blocks, one million letters.
  EXPECT_EQ(sha256OfFile(written("abc", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256OfFile(written("two", "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256OfFile(written("long", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(sha256OfFile("/no/such/file"), "");
}

TEST_F(InputFile, FileThatDiffersFromItsChecksumIsRejected) {
  const std::string path = written("map", "heights");
  EXPECT_NO_THROW(checkInput(path));
  written("map.sha256", sha256OfFile(path) + "  map\n");
  EXPECT_NO_THROW(checkInput(path));
  written("map.sha256", std::string(64, '0') + "  other\n" + sha256OfFile(path) + " *input_file_test_map\n");
  EXPECT_NO_THROW(checkInput(path));
  written("map", "weights");
  EXPECT_REFUSED(checkInput(path), InputError, "changed or damaged since; get it again");
  written("map.sha256", "deadbeef  map\n");
  EXPECT_REFUSED(checkInput(path), InputError, "does not begin with a SHA-256");
  std::filesystem::remove(path + ".sha256");
}

}  // namespace input_file_test
}  // namespace talus
