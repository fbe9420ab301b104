// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "log/dataset.hpp"

namespace kelpie::log {

/// Reads a CSV log with a header line, packed by gzip or zstd or not (docs/csv.md). The separator
/// (comma, semicolon or tab) is the one the header holds most of, or that "sep=;" names; lines end
/// in LF, CRLF or CR; blank lines and lines starting with '#' are passed over but counted; names
/// and numbers may stand in double quotes, and then hold separators and doubled quotes; a UTF-8
/// byte order mark is passed over. "nan" and "inf" are read as such, an empty cell as NaN, where
/// commas separate nothing "0,5" as 0.5, a column of time stamps as s since the first one, any
/// other word or a number out of range as NaN and as the column's text (Table::texts): who uses the
/// column decides. Units come from the header, or from a row of them below it (Table::units). A
/// first column without a name that numbers the rows is left out. Throws InputError (file, line,
/// column) on a missing, unreadable or empty file, a folder, UTF-16 or binary content, a column
/// without a name, a name used twice, a header of numbers only, a row with more or fewer cells than
/// the header, a broken quotation, no rows, decimals with commas and points, and as
/// file::unpacked() does. Throws Failure when the device fails while reading.
Table read_csv(const std::filesystem::path& file);

/// The same from a stream, to its end; `source` is what messages call it.
Table read_csv(std::istream& stream, const std::string& source);

/// Header and rows, separated by commas, numbers in the shortest form that reads back to the same
/// value, words as they were read, NaN and empty cells as "nan". Requires: names that are
/// different, not empty, without line ends.
std::string csv_text(const Table& table);

/// csv_text() as a file, which appears whole or not at all. Throws Failure as write_file_whole
/// does.
void write_csv(const std::filesystem::path& file, const Table& table);

}  // namespace kelpie::log
