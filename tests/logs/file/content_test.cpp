// SPDX-License-Identifier: Apache-2.0
#include "file/content.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <string>
#include <thread>
#include <tuple>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::content_test {
namespace {

using testing::message_of;

std::string refusal(const std::filesystem::path& file, std::size_t most = 1'200'000) {
  return message_of<InputError>([&] { file::read_content(file, "a log", most); });
}

TEST(Content, FilesAndPipesAreReadToTheirEnd) {
  const testing::TemporaryFolder folder;
  const std::string text(700'000, 'x');  // more than a pipe holds
  testing::write_text(folder / "file", text);
  EXPECT_EQ(file::read_content(folder / "file", "a log", text.size()), text);
  testing::write_text(folder / "empty", "");
  EXPECT_EQ(file::read_content(folder / "empty", "a log", 0), "");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(folder / "pipe") << text; });
  EXPECT_EQ(file::read_content(folder / "pipe", "a log", text.size()), text);
  writer.join();
}

TEST(Content, WhatIsNoFileIsNamed) {
  const testing::TemporaryFolder folder;
  const std::string name = (folder / "none").string();
  EXPECT_EQ(refusal(name), name + ": cannot be read: No such file or directory; a log is needed");
  EXPECT_EQ(refusal(folder.path()), folder.path().string() + ": is a folder; a log is needed");
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: is a device; a log is needed");
}

TEST(Content, NoMoreIsReadThanAllowed) {
  const testing::TemporaryFolder folder;
  const std::string large(3 << 20, 'x');
  testing::write_text(folder / "file", large);
  const std::string why = ": is larger than 1.2 MB, the most that is read of a log";
  EXPECT_EQ(refusal(folder / "file"), (folder / "file").string() + why);
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::ignore = std::signal(SIGPIPE, SIG_IGN);
  std::thread writer([&] { std::ofstream(folder / "pipe") << large; });
  EXPECT_EQ(refusal(folder / "pipe"), (folder / "pipe").string() + why);
  writer.join();
}

TEST(Content, ABeginningIsOfFilesOnly) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "file", "kelpie");
  EXPECT_EQ(file::beginning_of(folder / "file", 3), "kel");
  EXPECT_EQ(file::beginning_of(folder / "file", 30), "kelpie");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(file::beginning_of(folder / "pipe", 3), "");
  EXPECT_EQ(file::beginning_of("/dev/zero", 3), "");
}

}  // namespace
}  // namespace kelpie::content_test
