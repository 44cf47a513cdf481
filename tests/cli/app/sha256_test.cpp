#include <fstream>

#include <talus/cli/app/sha256.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace sha256_test {

TEST(Sha256, OfKnownMessages) {
  const Folder folder;
  // Printed in: FIPS 180-4's examples (NIST, SHA256.pdf), one block, two blocks, and a million letters.
  EXPECT_EQ(sha256OfFile(folder.write("abc", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256OfFile(folder.write("two", "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256OfFile(folder.write("long", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(sha256OfFile(folder / "none"), "");
}

}  // namespace sha256_test
}  // namespace talus::cli
