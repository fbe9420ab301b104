// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "kelpie/data/dataset.hpp"

namespace kelpie {

/// Reads a CSV log with a header line. The separator (comma, semicolon or tab) is taken from the
/// header; lines may end in CRLF; blank lines and lines starting with '#' are passed over; names
/// and numbers may stand in double quotes; a UTF-8 byte order mark is passed over. Empty cells,
/// "nan" and "inf" are read as such: who uses the column decides.
/// Throws InputError (file, line, column) on a missing, unreadable or empty file, a header without
/// a name or with one twice, a header of numbers only, a row with more or fewer cells than the
/// header, text in a number column, no rows.
Table read_csv(const std::filesystem::path& file);

/// The same from a stream; `source` is what messages call it.
Table read_csv(std::istream& stream, const std::string& source);

/// Writes header and rows, numbers in the shortest form that reads back to the same value.
/// The file appears whole or not at all.
void write_csv(const std::filesystem::path& file, const Table& table);

}  // namespace kelpie
