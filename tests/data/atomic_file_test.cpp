// SPDX-License-Identifier: Apache-2.0
#include "kelpie/data/atomic_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie {
namespace {

using testing::message_of;
using testing::TemporaryFolder;

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(AtomicFile, ReplacesTheOldContentAndLeavesNothingElse) {
  const TemporaryFolder folder;
  write_file_whole(folder / "a.txt", "old");
  write_file_whole(folder / "a.txt", std::string(100'000, 'x') + std::string("\0end", 4));
  EXPECT_EQ(content(folder / "a.txt").size(), 100'004U);
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, AFailureNamesTheFileAndKeepsTheOldOnes) {
  const TemporaryFolder folder;
  write_file_whole(folder / "file", "old");
  const auto below_a_file = folder / "file" / "b.txt";
  EXPECT_EQ(message_of<Failure>([&] { write_file_whole(below_a_file, "new"); }),
            below_a_file.string() + ": cannot be written: Not a directory");
  // Of a set, none appears when one can't be written: "b" is a folder's place.
  std::filesystem::create_directory(folder / "set");
  write_file_whole(folder / "set" / "a", "old");
  const std::string name = "no-such-folder/b";
  EXPECT_NE(message_of<Failure>([&] {
              write_files_whole(folder / "set", {{"a", "new"}, {name, "new"}});
            }),
            "");
  EXPECT_EQ(content(folder / "set" / "a"), "old");
  EXPECT_EQ(files_in(folder / "set"), 1U);
}

TEST(AtomicFile, MakesTheFolderOfASet) {
  const TemporaryFolder folder;
  write_files_whole(folder / "deep" / "down", {{"a", "1"}, {"b", "2"}});
  EXPECT_EQ(content(folder / "deep" / "down" / "b"), "2");
}

}  // namespace
}  // namespace kelpie
