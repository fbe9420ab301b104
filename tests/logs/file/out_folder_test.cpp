// SPDX-License-Identifier: Apache-2.0
#include "file/out_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::out_folder_test {
namespace {

namespace fs = std::filesystem;
using testing::message_of;
using testing::TemporaryFolder;

TEST(OutFolder, IsMadeAndGoesAgainWhereNothingWasWritten) {
  const TemporaryFolder folder;
  {
    const file::OutFolder out(folder / "a" / "b", {"result"});
    EXPECT_TRUE(fs::is_directory(folder / "a" / "b"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  {
    const file::OutFolder out(folder / "a" / "b", {"result"});
    std::ofstream(out.path() / "result") << "x";
  }
  EXPECT_TRUE(fs::exists(folder / "a" / "b" / "result"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "a" / "b"), {}), 1);
  const fs::path there = folder / "there";
  fs::create_directory(there);
  { const file::OutFolder out(there, {"result"}); }
  EXPECT_TRUE(fs::is_directory(there)) << "it was not made here";
}

TEST(OutFolder, HasOneRunAtATime) {
  const TemporaryFolder folder;
  {
    const file::OutFolder one(folder.path(), {});
    const std::string message =
        message_of<InputError>([&] { const file::OutFolder other(folder.path(), {}); });
    EXPECT_NE(message.find("another run is writing into this folder"), std::string::npos)
        << message;
    const file::OutFolder elsewhere(folder / "elsewhere", {});
  }
  EXPECT_NO_THROW(file::OutFolder(folder.path(), {}));
}

TEST(OutFolder, WhatKilledRunsLeftIsNoObstacleAndGoes) {
  const TemporaryFolder folder;
  for (const char* const name : {".kelpie.lock", "result.7-0.tmp", "other.7-0.tmp"}) {
    std::ofstream(folder / name) << "x";
  }
  { const file::OutFolder out(folder.path(), {"result"}); }
  EXPECT_FALSE(fs::exists(folder / ".kelpie.lock"));
  EXPECT_FALSE(fs::exists(folder / "result.7-0.tmp"));
  EXPECT_TRUE(fs::exists(folder / "other.7-0.tmp")) << "of no file that is written";
}

TEST(OutFolder, SaysWhatCannotBeWrittenAndLeavesNothing) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  EXPECT_THROW(file::OutFolder(folder / "file", {}), Failure);
  EXPECT_THROW(file::OutFolder(folder / "file" / "below", {}), Failure);
  fs::create_directories(folder / "out" / "result");
  EXPECT_NE(message_of<Failure>([&] {
              const file::OutFolder out(folder / "out", {"result"});
            }).find("it is a folder"),
            std::string::npos);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), {}), 1);
}

}  // namespace
}  // namespace kelpie::out_folder_test
