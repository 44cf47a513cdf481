// The version is stated in CMakeLists.txt; files of other tools that repeat it agree with it.
#include <regex>

#include "source_files.hpp"

namespace talus::architecture {
namespace version_test {

// Match of the first group of a pattern in a file; empty without a match.
std::string stated(const std::string& file, const std::string& pattern) {
  const std::string content = text(TALUS_SOURCE_DIR "/" + file);
  std::smatch found;
  return std::regex_search(content, found, std::regex(pattern)) ? found[1].str() : std::string();
}

std::string version() {
  return stated("CMakeLists.txt", R"(project\(talus VERSION (\d+\.\d+\.\d+) )");
}

TEST(VersionTest, FilesAgreeWithCMake) {
  ASSERT_NE(version(), "");
  EXPECT_EQ(stated("debian/changelog", R"(^talus \(([^)]+)\))"), version());
  EXPECT_EQ(stated("CITATION.cff", R"(\nversion: (\S+))"), version());
  EXPECT_EQ(stated("CHANGELOG.md", R"(\n## \[?([0-9.]+))"), version());
  EXPECT_EQ(stated("examples/ros2/package.xml", "<version>([^<]+)<"), version());
}

TEST(VersionTest, PythonPackageReadsItFromCMake) {
  EXPECT_EQ(stated("pyproject.toml", R"(\n(version) *=)"), "");
  EXPECT_EQ(stated("pyproject.toml", R"x(dynamic = \["(version)"\])x"), "version");
  EXPECT_EQ(stated("planner/python/wheel/wheel_backend.py", R"x(\nVERSION = .*"(CMakeLists.txt)")x"),
            "CMakeLists.txt");
}

TEST(VersionTest, ProjectsOutsideTheTreeRequireIt) {
  // Property: the installed package accepts requests of its own major and minor version only.
  const std::regex required(R"(find_package\(talus (\d+\.\d+) )");
  const std::string minor = version().substr(0, version().rfind('.'));
  int seen = 0;
  for (const std::string folder : {"examples", "tests/install"})
    for (const auto& file : files(folder, {".txt"})) {
      const std::string source = text(file);
      for (std::sregex_iterator i(source.begin(), source.end(), required), end; i != end; ++i, ++seen)
        EXPECT_EQ((*i)[1], minor) << file;
    }
  EXPECT_GE(seen, 5);
}

}  // namespace version_test
}  // namespace talus::architecture
