#pragma once

#include <talus/costmap/journal/journal_database.hpp>

namespace talus::costmap {

/// Enables the write-ahead log and marks a new file as a journal. Throws InputError for another SQLite file.
void beginJournal(const JournalDatabase& database);

/// Creates the tables of a new journal. Requires that the file has no other
/// tables, triggers or views, because a trigger or view could drop rows without an error. Must be called
/// within a transaction. Throws InputError, also for other formats.
void bringUpToDate(const JournalDatabase& database);

}  // namespace talus::costmap
