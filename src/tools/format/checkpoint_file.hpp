// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace kelpie::format {

/// The content of a checkpoint: a header in JSON for people and for comparison of runs, and a state
/// for the owner alone. File layout: docs/reference/files.md.
struct Checkpoint {
  std::string header;
  std::string state;
};

inline constexpr const char* kCheckpointName = "checkpoint.kelpie";
inline constexpr const char* kPreviousCheckpointName = "checkpoint.previous.kelpie";

/// The bytes of the file: magic, format version, lengths, header, state, checksum of the whole
/// file.
std::string checkpoint_bytes(const Checkpoint& checkpoint);

/// Throws InputError with `source` and reason for content that is empty, not a checkpoint, of
/// another version, cut short, too long or damaged.
Checkpoint parse_checkpoint(std::string_view bytes, const std::string& source);

/// Writes kCheckpointName into the folder (made if missing), synced to the disk; the earlier
/// checkpoint stays as kPreviousCheckpointName. A whole checkpoint exists whenever the process or
/// the machine dies. Throws Failure as write_file_whole does.
void write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// A checkpoint read from disk.
struct FoundCheckpoint {
  Checkpoint checkpoint;
  std::filesystem::path file;
  std::string passed_over;  ///< why the newest was rejected; empty: this is the newest
};

/// Whether the file begins with the magic bytes of a checkpoint.
bool is_checkpoint(const std::filesystem::path& file);

/// Throws InputError as parse_checkpoint() does, and for an unreadable file.
FoundCheckpoint read_checkpoint(const std::filesystem::path& file);

/// The newest readable checkpoint of a folder; std::nullopt in a folder without checkpoints. Throws
/// InputError with both file names where neither is readable.
std::optional<FoundCheckpoint> find_checkpoint(const std::filesystem::path& folder);

}  // namespace kelpie::format
