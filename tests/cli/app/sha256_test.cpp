#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <talus/cli/app/sha256.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace sha256_test {

TEST(Sha256, DigestsMatchKnownMessages) {
  const Folder folder;
  // Printed in: examples of FIPS 180-4 (NIST, SHA256.pdf): one block, two blocks, one million letters.
  EXPECT_EQ(sha256OfFile(folder.write("abc", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256OfFile(folder.write("two", "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256OfFile(folder.write("long", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(sha256OfFile(folder / "none"), "");
}

// The checksum file is compared for every option and for files of a mission.
TEST(Sha256, FileThatDiffersFromItsChecksumIsRejected) {
  const Folder folder;
  const std::string dem = folder.write(
      "hill.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n0 0 0\n0 0 0\n0 0 0\n");
  const auto ends = [&](const std::vector<std::string>& words) { return runTalus(words, folder.path()); };
  folder.write("mission.yaml",
               "maps: {dem: hill.asc}\nrover: mer\nsoil: sand\nstart: 1.5,1.5\ngoal: 1.5,1.5\n");
  const int plain = ends({"info", dem}).code;
  folder.write("hill.asc.sha256", sha256OfFile(dem) + "  hill.asc\n");
  EXPECT_EQ(ends({"info", dem}).code, plain);
  folder.write("hill.asc", fileContent(dem) + "\n");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"info", dem}, {"plan", "mission.yaml", "-o", "route.geojson"}}) {
    const Ran ran = ends(words);
    EXPECT_EQ(ran.code, 2) << ran.err;
    EXPECT_THAT(ran.err, testing::HasSubstr("changed or damaged since; get it again"));
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
  folder.write("hill.asc.sha256", "deadbeef  hill.asc\n");
  EXPECT_THAT(ends({"info", dem}).err, testing::HasSubstr("does not begin with a SHA-256"));
}

}  // namespace sha256_test
}  // namespace talus::cli
