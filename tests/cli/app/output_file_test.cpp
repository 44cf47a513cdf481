#include <fstream>

#include <talus/cli/app/output_file.hpp>
#include <talus/talus.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string refusal(const std::string& path) {
  try {
    writeFile(path, "text");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(OutputFile, AppearsWholeAndReplacesWhatWasThere) {
  const Folder folder;
  writeFile(folder / "a.json", "old");
  writeFile(folder / "a.json", "new");
  EXPECT_EQ(fileContent(folder / "a.json"), "new");
  EXPECT_THAT(folder.names(), ElementsAre("a.json"));
}

TEST(OutputFile, LeavesNothingWhenNotCommitted) {
  const Folder folder;
  {
    const OutputFile file(folder / "a.png");
    EXPECT_EQ(file.temporary().extension(), ".png");
    std::ofstream(file.temporary()) << "half";
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(OutputFile, FollowsALinkInsteadOfReplacingIt) {
  const Folder folder;
  folder.write("real", "old");
  fs::create_symlink(folder / "real", folder / "link");
  writeFile(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(fileContent(folder / "real"), "new");
}

TEST(OutputFile, WritesADeviceInPlace) {
  EXPECT_EQ(OutputFile("/dev/null").temporary(), "/dev/null");
  writeFile("/dev/null", "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(OutputFile, RefusalSaysWhereAndWhy) {
  const Folder folder;
  EXPECT_THAT(refusal(folder / "no/a.json"), HasSubstr("no does not exist; make it first"));
  EXPECT_THAT(refusal(folder.path().string()), HasSubstr("is a directory"));
  EXPECT_THAT(refusal(""), HasSubstr("is not a file name"));
  EXPECT_THAT(refusal("/dev/full"), HasSubstr("No space left on device"));
}

}  // namespace
}  // namespace talus::cli
