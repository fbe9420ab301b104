// SPDX-License-Identifier: Apache-2.0
#include "file/mapped_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <filesystem>

#include "support.hpp"

namespace kelpie::mapped_file_test {
namespace {

TEST(SharedFile, AFileWithHolesHasItsRoomBeforeItIsRenewed) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder / "block";
  testing::write_text(file, "content");
  std::filesystem::resize_file(file, 1 << 20);
  struct stat status = {};
  const auto room = [&] { return ::stat(file.c_str(), &status) == 0 ? 512 * status.st_blocks : 0; };
  if (room() >= 1 << 20) {
    GTEST_SKIP() << "the file system has no holes";
  }
  const file::SharedFile shared(file);
  EXPECT_GE(room(), 1 << 20);
  EXPECT_EQ(shared.bytes().size(), 1U << 20);
  EXPECT_EQ(std::memcmp(shared.bytes().data(), "content", 7), 0);
}

}  // namespace
}  // namespace kelpie::mapped_file_test
