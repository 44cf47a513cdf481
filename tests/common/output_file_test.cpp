#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <talus/common/common.hpp>
#include <talus/common/output_file.hpp>

namespace talus {
namespace output_file_test {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

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
    OutputFile file(folder / "a.png");
    file.write("half");
    EXPECT_EQ(folder.names().size(), 1U);
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
  OutputFile half(folder / "half");
  half.write("x");
  removeUnfinishedFiles();
  EXPECT_THAT(folder.names(), ElementsAre("whole"));
}

// Regression: a hidden file of the user whose name held a number was removed as the leftover of a process.
TEST(OutputFile, FilesOfOthersAreKept) {
  const Folder folder;
  for (const char* name : {".map.2026-11-27.ot", ".map.999999-0.ot", ".talus-1"}) folder.write(name, "other");
  writeFile(folder / "map.ot", "new");
  EXPECT_THAT(folder.names(),
              UnorderedElementsAre(".map.2026-11-27.ot", ".map.999999-0.ot", ".talus-1", "map.ot"));
}

// Regression: a map of which one write failed replaced its predecessor, because the state of the stream was
// cleared between two sections. The limit of the file size fails like a full disk, and is lifted again.
TEST(OutputFile, FailedWriteRemains) {
  const Folder folder;
  folder.write("a", "old");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  {
    OutputFile file(folder / "a");
    const rlimit small{.rlim_cur = 1024, .rlim_max = before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(file.stream() << std::string(100000, 'x'), InputError);
    ::setrlimit(RLIMIT_FSIZE, &before);
    file.stream().clear();
    EXPECT_THROW(file.stream() << std::string(100000, 'x'), InputError);
    file.stream().clear();
    EXPECT_THROW(file.commit(), InputError);
  }
  EXPECT_EQ(fileContent(folder / "a"), "old");
  EXPECT_THAT(folder.names(), ElementsAre("a"));
}

// A name such as /dev/stdout denotes an open file, whose content before stays.
TEST(OutputFile, DescriptorReceivesTheBytes) {
  const Folder folder;
  folder.write("log", "before ");
  const int log = ::open((folder / "log").c_str(), O_WRONLY | O_APPEND);
  ASSERT_GE(log, 0);
  writeFile("/dev/fd/" + std::to_string(log), "route");
  ::close(log);
  EXPECT_EQ(fileContent(folder / "log"), "before route");
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
