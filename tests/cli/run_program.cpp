#include "run_program.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

#include <sys/wait.h>
#include <unistd.h>

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

/// Quotes the word for a shell line.
std::string quoted(const std::string& word) {
  std::ostringstream stream;
  stream << '\'' << std::regex_replace(word, std::regex("'"), "'\\''") << '\'';
  return stream.str();
}

}  // namespace

std::vector<std::string> joined(std::vector<std::string> first, const std::vector<std::string>& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

Ran runTalus(const std::vector<std::string>& words, const fs::path& folder, double interrupt_s) {
  const Folder capture;
  std::ostringstream line;
  line << "cd " << quoted(folder.string()) << " && exec ";
  if (interrupt_s > 0.0) line << "timeout --preserve-status --foreground --signal=INT " << interrupt_s << ' ';
  line << quoted(TALUS_PROGRAM);
  for (const std::string& word : words) line << ' ' << quoted(word);
  line << " >" << quoted(capture / "out") << " 2>" << quoted(capture / "err") << " </dev/null";
  const int status =
      std::system(line.str().c_str());  // NOLINT(cert-env33-c): the shell redirects both outputs
  Ran ran;
  ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ran.out = fileContent(capture / "out");
  ran.err = fileContent(capture / "err");
  return ran;
}

Folder::Folder() {
  std::string name = (fs::temp_directory_path() / "talus-XXXXXX").string();
  path_ = ::mkdtemp(name.data());
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& content) const {
  std::ofstream(path_ / name, std::ios::binary) << content;
  return (path_ / name).string();
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string fileContent(const fs::path& path) {
  std::ostringstream content;
  if (std::ifstream stream(path, std::ios::binary); stream.peek() != std::ifstream::traits_type::eof())
    content << stream.rdbuf();
  return content.str();
}

}  // namespace talus::cli
