#pragma once

#include <talus/costmap/journal/journal_database.hpp>

namespace talus::costmap {

/// Sets the write-ahead log, and marks a new file as a journal. Throws InputError for another SQLite file.
void beginJournal(const JournalDatabase& database);

/// Makes the tables of a new journal, or those of Talus 0.1.0 into those of the present format, and requires that the file
/// has these and nothing else: a trigger or a view could drop rows in silence. Within a transaction. Throws InputError, for
/// all other formats, too.
void bringUpToDate(const JournalDatabase& database);

}  // namespace talus::costmap
