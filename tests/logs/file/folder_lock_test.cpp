// SPDX-License-Identifier: Apache-2.0
#include "file/descriptor.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "file/atomic_file.hpp"
#include "support.hpp"

namespace kelpie::folder_lock_test {
namespace {

using testing::TemporaryFolder;

int number_in(const std::filesystem::path& file) {
  int number = -1;
  std::ifstream(file) >> number;
  return number;
}

// Each counts in a file that it reads and writes anew.
TEST(FolderLock, WhoReadsAndWritesLosesNothing) {
  constexpr int kWriters = 4;
  constexpr int kRounds = 25;
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "count";
  file::write_file_whole(file, "0");
  std::vector<std::jthread> writers;
  writers.reserve(kWriters);
  for (int i = 0; i < kWriters; ++i) {
    writers.emplace_back([&] {
      for (int round = 0; round < kRounds; ++round) {
        const file::FolderLock lock(file);
        file::write_file_whole(file, std::to_string(number_in(file) + 1));
      }
    });
  }
  writers.clear();
  EXPECT_EQ(number_in(file), kWriters * kRounds);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(FolderLock, AFolderThatIsNotThereKeepsNobodyWaiting) {
  const file::FolderLock one("no/such/folder/m.json");
  const file::FolderLock other("no/such/folder/m.json");
}

}  // namespace
}  // namespace kelpie::folder_lock_test
