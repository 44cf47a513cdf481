#include "journal.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include <sqlite3.h>

namespace safety {
namespace {

double number(sqlite3_stmt* row, int column) {
  return sqlite3_column_type(row, column) == SQLITE_NULL ? std::numeric_limits<double>::quiet_NaN()
                                                         : sqlite3_column_double(row, column);
}

}  // namespace

std::vector<JournalRow> readJournal(const std::string& path) {
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_READWRITE, nullptr);
  const std::unique_ptr<sqlite3, decltype(&sqlite3_close)> file(opened, &sqlite3_close);
  sqlite3_stmt* prepared = nullptr;
  if (code != SQLITE_OK ||
      sqlite3_prepare_v2(opened,
                         "SELECT source, accepted, time_s, x_m, y_m, load_N, slip, torque_Nm, sinkage_m, "
                         "gradient, pass_index FROM evidence ORDER BY id",
                         -1, &prepared, nullptr) != SQLITE_OK)
    throw std::runtime_error(path + ": no journal");
  const std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> rows(prepared, &sqlite3_finalize);
  std::vector<JournalRow> found;
  while (sqlite3_step(prepared) == SQLITE_ROW)
    found.push_back({.source = reinterpret_cast<const char*>(sqlite3_column_text(prepared, 0)),
                     .accepted = sqlite3_column_int(prepared, 1) != 0,
                     .time_s = number(prepared, 2),
                     .place = {number(prepared, 3), number(prepared, 4)},
                     .load_N = number(prepared, 5),
                     .slip = number(prepared, 6),
                     .torque_Nm = number(prepared, 7),
                     .sinkage_m = number(prepared, 8),
                     .gradient = number(prepared, 9),
                     .pass = sqlite3_column_int(prepared, 10)});
  return found;
}

}  // namespace safety
