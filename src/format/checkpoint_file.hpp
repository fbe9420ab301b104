// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace kelpie::format {

/// What a checkpoint holds: a header for people and programs that compare (JSON), and a state that
/// only its owner reads. docs/checkpoints.md has the layout of the file.
struct Checkpoint {
  std::string header;
  std::string state;
};

inline constexpr const char* kCheckpointName = "checkpoint.kelpie";
inline constexpr const char* kPreviousCheckpointName = "checkpoint.previous.kelpie";

/// The file's content: magic, format version, lengths, header, state, checksum over all of it.
std::string checkpoint_bytes(const Checkpoint& checkpoint);

/// Throws InputError naming `source` and why, on content that is empty, no checkpoint, of another
/// version, cut short, too long or damaged.
Checkpoint parse_checkpoint(std::string_view bytes, const std::string& source);

/// Writes kCheckpointName into the folder (made if missing), synced to the disk; the one that was
/// there before stays as kPreviousCheckpointName. Whenever the process or the machine dies, there
/// is a whole one. Throws Failure as write_file_whole does.
void write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// A checkpoint as it was found.
struct FoundCheckpoint {
  Checkpoint checkpoint;
  std::filesystem::path file;
  std::string passed_over;  ///< why this is the previous one; empty where it is the newest
};

/// Whether a file's content begins as a checkpoint's does.
bool is_checkpoint(const std::filesystem::path& file);

/// Throws InputError as parse_checkpoint() does, and on a file that can't be read.
FoundCheckpoint read_checkpoint(const std::filesystem::path& file);

/// The newest checkpoint in a folder that can be read; nothing where there is none at all. Throws
/// InputError naming both files where neither can be read.
std::optional<FoundCheckpoint> find_checkpoint(const std::filesystem::path& folder);

}  // namespace kelpie::format
