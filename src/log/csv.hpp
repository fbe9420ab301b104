// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "log/dataset.hpp"

namespace kelpie::log {

/// Reads a CSV log with a header line, plain or packed by gzip or zstd (docs/csv.md). The separator
/// (comma, semicolon or tab) is the most frequent in the header, or given by "sep=;"; lines end in
/// LF, CRLF or CR; blank lines and lines starting with '#' are skipped but counted; names and
/// numbers may be in double quotes, with separators and doubled quotes inside; a UTF-8 byte order
/// mark is skipped. "nan" and "inf" are numbers; an empty cell is NaN; unless commas separate
/// cells, "0,5" is 0.5; a column of time stamps becomes s since the first stamp; any other word,
/// and a number out of range, becomes NaN and part of the column's text (Table::texts). Units come
/// from the header, or from a row of units below the header (Table::units). A first column without
/// name that numbers the rows is left out. Throws InputError (file, line, column) on a missing,
/// unreadable or empty file, a folder, UTF-16 or binary content, a column without name, duplicate
/// names, a header of numbers only, a row with a wrong number of cells, a broken quotation, no
/// rows, mixed decimal commas and points, and as file::unpacked() does. Throws Failure when the
/// device fails while reading.
Table read_csv(const std::filesystem::path& file);

/// Reads from a stream to the end; messages call the stream `source`.
Table read_csv(std::istream& stream, const std::string& source);

/// Header and rows, separated by commas; numbers in the shortest exact form, words as read, NaN and
/// empty cells as "nan". Requires names that are different, not empty, without line ends.
std::string csv_text(const Table& table);

/// Writes csv_text() to a file, atomically. Throws Failure as write_file_whole() does.
void write_csv(const std::filesystem::path& file, const Table& table);

}  // namespace kelpie::log
