// SPDX-License-Identifier: Apache-2.0
#include "format/checkpoint_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::checkpoint_file_test {
namespace {

namespace fs = std::filesystem;
using testing::message_of;
using testing::TemporaryFolder;

const format::Checkpoint kExample{"{\"format\": \"test\"}\n", std::string("\0\1state\xFF", 8)};

void write_bytes(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string refusal(const std::string& bytes) {
  return message_of<InputError>([&] { format::parse_checkpoint(bytes, "c.kelpie"); });
}

TEST(CheckpointFile, WhatIsReadIsWhatWasWritten) {
  const format::Checkpoint read =
      format::parse_checkpoint(format::checkpoint_bytes(kExample), "c.kelpie");
  EXPECT_EQ(read.header, kExample.header);
  EXPECT_EQ(read.state, kExample.state);
}

TEST(CheckpointFile, EveryTruncationIsRefused) {
  const std::string bytes = format::checkpoint_bytes(kExample);
  EXPECT_EQ(refusal(""), "c.kelpie: is empty");
  for (std::size_t size = 1; size < bytes.size(); ++size) {
    EXPECT_EQ(refusal(bytes.substr(0, size)), "c.kelpie: is cut short") << size;
  }
  EXPECT_EQ(refusal(bytes + "x"), "c.kelpie: is longer than it says");
}

TEST(CheckpointFile, EveryFlippedBitIsRefused) {
  const std::string bytes = format::checkpoint_bytes(kExample);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    EXPECT_NE(refusal(flipped), "") << bit;
  }
}

// As Python's zlib.crc32 says: other programs can check a file.
TEST(CheckpointFile, EndsInTheChecksumOfAllBytesBefore) {
  const std::string bytes = format::checkpoint_bytes(kExample);
  EXPECT_EQ(bytes.substr(bytes.size() - 4), "\xE5\xA3\xC4\x88");
}

TEST(CheckpointFile, OlderAndNewerVersionsAndAnotherFileAreToldApart) {
  std::string bytes = format::checkpoint_bytes(kExample);
  bytes[12] = '\x01';
  EXPECT_EQ(refusal(bytes),
            "c.kelpie: is a checkpoint of version 1; this kelpie reads only version 5");
  bytes[12] = '\x06';
  EXPECT_EQ(refusal(bytes),
            "c.kelpie: is a checkpoint of version 6; this kelpie reads only version 5");
  EXPECT_EQ(refusal("t,u,udot\n0,1,2\n"), "c.kelpie: is no checkpoint of kelpie");
}

TEST(CheckpointFile, TheOneBeforeIsKept) {
  const TemporaryFolder folder;
  const fs::path place = folder / "made" / "when" / "missing";
  for (const char* const state : {"1", "2", "3", "4"}) {
    format::write_checkpoint(place, {"", state});
    const std::optional<format::FoundCheckpoint> found = format::find_checkpoint(place);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->checkpoint.state, state);
    EXPECT_EQ(found->passed_over, "");
  }
  fs::remove(place / format::kCheckpointName);
  EXPECT_EQ(format::find_checkpoint(place)->checkpoint.state, "3");
  EXPECT_EQ(std::distance(fs::directory_iterator(place), {}), 1);  // no draft is left
}

TEST(CheckpointFile, WhereTheNewestIsBadThePreviousIsTakenAndWhyIsSaid) {
  const TemporaryFolder folder;
  EXPECT_FALSE(format::find_checkpoint(folder.path()).has_value());
  format::write_checkpoint(folder.path(), {"", "1"});
  format::write_checkpoint(folder.path(), {"", "2"});
  write_bytes(folder / format::kCheckpointName, "");
  const std::optional<format::FoundCheckpoint> found = format::find_checkpoint(folder.path());
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->checkpoint.state, "1");
  EXPECT_EQ(found->file, folder / format::kPreviousCheckpointName);
  EXPECT_EQ(found->passed_over, (folder / format::kCheckpointName).string() + ": is empty");
  write_bytes(folder / format::kPreviousCheckpointName, "KELPIE");
  const std::string message =
      message_of<InputError>([&] { format::find_checkpoint(folder.path()); });
  EXPECT_NE(message.find("checkpoint.kelpie: is empty; "), std::string::npos) << message;
  EXPECT_NE(message.find("previous.kelpie: is no checkpoint"), std::string::npos) << message;
}

TEST(CheckpointFile, AnUnwritablePlaceIsAFailureAndTheOldOneStays) {
  const TemporaryFolder folder;
  format::write_checkpoint(folder.path(), {"", "1"});
  fs::create_directory(folder / format::kPreviousCheckpointName);
  EXPECT_THROW(format::write_checkpoint(folder.path(), {"", "2"}), Failure);
  EXPECT_EQ(format::find_checkpoint(folder.path())->checkpoint.state, "1");
  EXPECT_THROW(format::write_checkpoint(folder / format::kCheckpointName, {"", "2"}), Failure);
}

}  // namespace
}  // namespace kelpie::checkpoint_file_test
