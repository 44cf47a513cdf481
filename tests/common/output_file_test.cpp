#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include <talus/common/input_error.hpp>
#include <talus/common/output_file.hpp>

namespace talus {
namespace output_file_test {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "talus-output-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const char* name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }
  void write(const char* name, const std::string& content) const { std::ofstream(path_ / name) << content; }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename().string());
    return names;
  }

 private:
  fs::path path_;
};

std::string fileContent(const std::string& path) {
  std::ostringstream content;
  content << std::ifstream(path).rdbuf();
  return content.str();
}

std::string refusal(const std::string& path) {
  try {
    writeFile(path, "text");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(OutputFile, CommitReplacesTheFileAtomically) {
  const Folder folder;
  writeFile(folder / "a.json", "old");
  writeFile(folder / "a.json", "new");
  EXPECT_EQ(fileContent(folder / "a.json"), "new");
  EXPECT_THAT(folder.names(), ElementsAre("a.json"));
}

TEST(OutputFile, UncommittedFileIsRemoved) {
  const Folder folder;
  {
    const OutputFile file(folder / "a.png");
    EXPECT_EQ(file.temporary().extension(), ".png");
    std::ofstream(file.temporary()) << "half";
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(OutputFile, SymbolicLinkIsFollowed) {
  const Folder folder;
  folder.write("real", "old");
  fs::create_symlink(folder / "real", folder / "link");
  writeFile(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(fileContent(folder / "real"), "new");
}

TEST(OutputFile, DevicesAndFifosAreNotReplaced) {
  const Folder folder;
  writeFile("/dev/null", "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal(folder / "pipe"),
              HasSubstr("cannot be written"));  // without a reader, the FIFO is an error and does not block
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

TEST(OutputFile, PermissionsAreKept) {
  const Folder folder;
  folder.write("a", "old");
  fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_write);
  writeFile(folder / "a", "new");
  EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

// Property: removeUnfinishedFiles(), called when a signal ends the process, removes unfinished files only.
TEST(OutputFile, UnfinishedFilesAreRemovedOnRequest) {
  const Folder folder;
  writeFile(folder / "whole", "x");
  const OutputFile half(folder / "half");
  std::ofstream(half.temporary()) << "x";
  removeUnfinishedFiles();
  EXPECT_THAT(folder.names(), ElementsAre("whole"));
}

TEST(OutputFile, NameAboveTheLengthLimitIsRejected) {
  EXPECT_THAT(refusal(std::string(5000, 'a')), HasSubstr("File name too long"));
}

TEST(OutputFile, ErrorNamesPathAndReason) {
  const Folder folder;
  EXPECT_THAT(refusal(folder / "no/a.json"), HasSubstr("no does not exist; make it first"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("is a directory"));
  EXPECT_THAT(refusal(""), HasSubstr("is not a file name"));
  EXPECT_THAT(refusal("/dev/full"), HasSubstr("No space left on device"));
}

}  // namespace output_file_test
}  // namespace talus
