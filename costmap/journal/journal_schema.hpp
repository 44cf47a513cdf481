#pragma once

#include <talus/costmap/journal/journal_database.hpp>

namespace talus::costmap {

/// Enables the write-ahead log and marks a new file as a journal. Throws InputError for another SQLite file.
void beginJournal(const JournalDatabase& database);

/// Creates the tables of a new journal, or converts those of Talus 0.1.0, and requires that the file has no
/// other entries: a trigger or view could silently drop rows. Call within a transaction. Throws InputError,
/// also for other formats.
void bringUpToDate(const JournalDatabase& database);

}  // namespace talus::costmap
