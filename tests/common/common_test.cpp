#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <refused.hpp>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <talus/common/checksum.hpp>
#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/common/output_file.hpp>
#include <talus/common/parallel_for.hpp>

namespace talus {
namespace common_test {

std::uint64_t checksumOf(const std::string& bytes) {
  Checksum sum;
  sum.add(bytes.data(), bytes.size());
  return sum.value();
}

// Printed in: xxHash's specification, XXH3 64 bits of the empty string, seed 0.
TEST(Checksum, EmptyInputMatchesXxh3) {
  EXPECT_EQ(Checksum().value(), 0x2d06800538d394c2ULL);
}

// Property: the checksum is independent of the division of the bytes, also if value() is called in between.
TEST(Checksum, ChecksumIsIndependentOfDivision) {
  std::string bytes;
  for (int i = 0; i < 1000; ++i) bytes += static_cast<char>(i * 31);
  for (const std::size_t piece : {1U, 7U, 8U, 255U, 256U, 257U}) {
    Checksum sum;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      sum.add(bytes.data() + at, std::min(piece, bytes.size() - at));
      static_cast<void>(sum.value());
    }
    EXPECT_EQ(sum.value(), checksumOf(bytes)) << piece;
  }
}

// Property: every flipped bit changes the checksum, at all lengths for which the algorithm has a separate
// branch.
TEST(Checksum, EveryFlippedBitChangesTheChecksum) {
  for (const std::size_t size : {1U, 3U, 8U, 16U, 128U, 240U, 300U}) {
    const std::string bytes(size, 'a');
    for (std::size_t bit = 0; bit < 8 * size; ++bit) {
      std::string changed = bytes;
      changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << bit % 8));
      ASSERT_NE(checksumOf(changed), checksumOf(bytes)) << size << ' ' << bit;
    }
  }
}

TEST(InputError, MessageHasPlaceReasonAndRemedyOnOneLine) {
  EXPECT_STREQ(InputError({"a.csv:3", "no slip", "add it"}).what(), "a.csv:3: no slip; add it");
  EXPECT_STREQ(InputError({"a.csv", "is empty", ""}).what(), "a.csv: is empty");
}

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

TEST(MemoryBudget, RequestAboveTheBudgetIsRejectedWithItsSize) {
  setMemoryBudget(std::uint64_t{2} << 30U);
  EXPECT_NO_THROW(requireMemory(1e8, "a.npy"));
  try {
    requireMemory(6.2e9, "big.ot");
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(),
                testing::StartsWith("big.ot: needs 6.2 GB, more than the memory budget of 2.15 GB"));
    EXPECT_THAT(e.what(), testing::HasSubstr("--max-memory"));
  }
  setMemoryBudget(0);
}

TEST(MemoryBudget, DefaultBudgetRejectsExcessiveRequests) {
  EXPECT_NO_THROW(requireMemory(1e3, "small"));
  EXPECT_THROW(requireMemory(1e15, "no machine has this"), InputError);
}

const std::vector<std::string> kKnown{"plan", "plugins", "explain", "estimate"};

TEST(EditDistance, CountsInsertedDeletedReplacedAndSwappedLetters) {
  // Closed form: one edit of each kind.
  EXPECT_EQ(editDistance("plan", "plan"), 0U);
  EXPECT_EQ(editDistance("plan", "plain"), 1U);
  EXPECT_EQ(editDistance("plan", "pan"), 1U);
  EXPECT_EQ(editDistance("plan", "plam"), 1U);
  EXPECT_EQ(editDistance("plan", "paln"), 1U);
  EXPECT_EQ(editDistance("", "plan"), 4U);
}

TEST(NearestName, FindsTheNameWithFewestEdits) {
  EXPECT_EQ(nearestName("plam", kKnown), "plan");
  EXPECT_EQ(nearestName("lpan", kKnown), "plan");
  EXPECT_EQ(nearestName("explan", kKnown), "explain");
}

TEST(NearestName, DistantNameYieldsNoSuggestion) {
  EXPECT_EQ(nearestName("calibrate", kKnown), "");
  EXPECT_EQ(nearestName("", kKnown), "");
  EXPECT_EQ(nearestName("plan", {}), "");
}

TEST(ParallelFor, EachIndexIsCalledOnceForAnyThreadCount) {
  for (std::size_t count : {0U, 1U, 5U, 1000U})
    for (int threads : {1, 2, 7}) {
      std::vector<std::atomic<int>> calls(count);
      parallelFor(count, threads, [&](std::size_t k) { ++calls[k]; });
      for (const auto& n : calls) ASSERT_EQ(n, 1);
    }
}

TEST(ParallelFor, ExceptionIsRethrownAndStopsTheLoop) {
  // Property: an exception on any thread is rethrown, and no new call begins after the exception.
  for (int threads : {1, 2, 7}) {
    std::atomic<int> calls{0};
    const auto loop = [&] {
      parallelFor(100000, threads, [&](std::size_t k) {
        ++calls;
        if (k >= 10) throw std::runtime_error("call");
      });
    };
    EXPECT_THROW(loop(), std::runtime_error);
    EXPECT_LE(calls, 10 + threads);
  }
}

TEST(ParallelRows, EachRowIsVisitedOnceForAnyThreadCount) {
  for (int rows : {0, 1, 64, 65, 1000})
    for (int threads : {1, 2, 7}) {
      std::vector<std::atomic<int>> visits(static_cast<std::size_t>(rows));
      forEachStrip({.rows = rows, .threads = threads}, {}, [&](Rows strip) {
        for (int row = strip.first; row < strip.past; ++row) ++visits[static_cast<std::size_t>(row)];
      });
      for (const auto& count : visits) ASSERT_EQ(count, 1);
    }
}

TEST(ParallelRows, ProgressIsReportedOnTheCallingThreadAndStops) {
  std::stop_source source;
  const auto caller = std::this_thread::get_id();
  std::atomic<int> strips{0};
  const ProgressMonitor watch{.progress =
                                  [&](double fraction) {
                                    EXPECT_EQ(std::this_thread::get_id(), caller);
                                    EXPECT_TRUE(fraction > 0 && fraction <= 1);
                                    source.request_stop();
                                  },
                              .stop = source.get_token()};
  forEachStrip({.rows = 64 * 1000, .threads = 1}, watch, [&](Rows) { ++strips; });
  EXPECT_EQ(strips, 1);
}

}  // namespace common_test
}  // namespace talus
