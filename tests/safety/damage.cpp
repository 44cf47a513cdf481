#include "damage.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "damaged_site.hpp"

namespace safety {
namespace {

std::string number(std::size_t value) {
  return std::to_string(value);
}

std::vector<std::string> cut(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

// Format of a line: number;file;damage;exit;cause|cause|;complaint|
std::string line(const DamageResult& r) {
  std::ostringstream out;
  out << r.number << ';' << r.file << ';' << r.damage << ';' << r.exit << ';';
  for (const std::string& cause : r.causes) out << cause << '|';
  std::string complaint = r.complaint.substr(0, 200);
  std::replace_if(
      complaint.begin(), complaint.end(), [](char c) { return c == ';' || c == '\n' || c == '|'; }, ' ');
  out << ';' << complaint << '|';
  return out.str();
}

std::optional<DamageResult> parsed(const std::string& text) {
  const auto parts = cut(text, ';');
  if (parts.size() != 6 || parts[5].empty() || parts[5].back() != '|') return std::nullopt;
  return DamageResult{.number = std::stoull(parts[0]),
                      .file = parts[1],
                      .damage = parts[2],
                      .exit = std::stoi(parts[3]),
                      .causes = cut(parts[4], '|'),
                      .complaint = parts[5].substr(0, parts[5].size() - 1)};
}

}  // namespace

const std::vector<std::string>& damagedFiles() {
  static const std::vector<std::string> files{
      "dem.img",     "dem.tif",       "dem_deflate.tif",  "dem.nc",    "dem.asc",     "classes.asc",
      "classes.img", "rocks.img",     "keep_out.geojson", "drive.csv", "evidence.db", "learned.ot",
      "model.yaml",  "route.geojson", "patch.f32",        "patch.u8"};
  return files;
}

std::pair<std::string, std::string> damaged(const std::string& bytes, std::mt19937_64& random) {
  constexpr std::size_t kParts[] = {1, 3, 40, 512, 4096};
  const std::size_t part =
      std::min(kParts[random() % std::size(kParts)], std::max<std::size_t>(1, bytes.size() / 3));
  std::size_t begin = random() % (bytes.size() - part + 1);
  if (part == 512 || part == 4096) begin -= begin % part;
  std::string made = bytes;
  const auto at = made.begin() + static_cast<std::ptrdiff_t>(begin),
             end = at + static_cast<std::ptrdiff_t>(part);
  const std::string where = " " + number(part) + " at " + number(begin);
  switch (random() % 6) {
    case 0:
      made.erase(at, end);
      return {made, "removed" + where};
    case 1:
      made.erase(at, made.end());
      return {made, "cut at " + number(begin)};
    case 2:
      std::fill(at, end, '\0');
      return {made, "zeroed" + where};
    case 3:
      std::fill(at, end, static_cast<char>(random()));
      return {made, "one byte" + where};
    case 4:
      std::generate(at, end, [&] { return static_cast<char>(random()); });
      return {made, "random" + where};
    default: {
      const std::size_t from = random() % (bytes.size() - part + 1);
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(from), part, at);
      return {made, "moved" + where + " from " + number(from)};
    }
  }
}

std::vector<DamageResult> DamageCampaign::results() const {
  std::vector<DamageResult> all;
  std::ifstream in(results_);
  for (std::string text; std::getline(in, text);)
    if (auto result = parsed(text)) all.push_back(std::move(*result));
  return all;
}

std::uint64_t DamageCampaign::missing(std::uint64_t first, std::uint64_t count) const {
  std::set<std::uint64_t> done;
  for (const DamageResult& result : results())
    if (result.number >= first && result.number < first + count) done.insert(result.number);
  return count - done.size();
}

void DamageCampaign::run(std::uint64_t first, std::uint64_t count,
                         const std::function<void(const std::string&)>& report) {
  std::set<std::uint64_t> done;
  for (const DamageResult& result : results()) done.insert(result.number);
  std::ofstream out(results_, std::ios::app);
  std::unique_ptr<DamagedSite> site;
  std::optional<std::uint64_t> at;
  for (std::uint64_t k = first; k < first + count; ++k) {
    if (done.contains(k)) continue;
    if (at != k / kPerSite) {
      at = k / kPerSite;
      site.reset();
      try {
        site = std::make_unique<DamagedSite>(places_, *at);
      } catch (const std::exception& failure) {
        report(failure.what());
      }
    }
    if (!site) continue;
    std::mt19937_64 random(104729 * k + 7);
    std::string file = damagedFiles()[k % damagedFiles().size()];
    if (site->whole(file).empty()) file = "learned.ot";
    const auto [bytes, damage] = damaged(site->whole(file), random);
    DamageResult result = site->tried(file, bytes, random() % kPairs);
    result.number = k;
    result.damage = damage;
    out << '\n' << line(result) << std::flush;
  }
}

std::string table(const std::vector<DamageResult>& results) {
  struct Row {
    std::size_t routes = 0, none = 0, refused = 0, failed = 0, less_safe = 0;
    std::string numbers;
  };
  std::map<std::string, Row> rows;
  std::ostringstream out;
  for (const DamageResult& r : results) {
    Row& row = rows[r.file];
    ++(r.exit == 0 ? row.routes : r.exit == 1 ? row.none : r.exit == 2 ? row.refused : row.failed);
    if (!r.complaint.empty()) out << "  number " << r.number << " printed: " << r.complaint << '\n';
    if (r.causes.empty()) continue;
    ++row.less_safe;
    row.numbers += ' ' + std::to_string(r.number) + " (" + r.damage + ": " + r.causes.front() + ")";
  }
  out << results.size() << " damaged files: file, routes, without a route, refused, failed, less safe\n";
  for (const auto& [file, r] : rows)
    out << "  " << file << ": " << r.routes << ", " << r.none << ", " << r.refused << ", " << r.failed << ", "
        << r.less_safe << r.numbers << '\n';
  return out.str();
}

}  // namespace safety
