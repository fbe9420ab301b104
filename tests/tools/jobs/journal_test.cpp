// SPDX-License-Identifier: Apache-2.0
#include "jobs/journal.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::journal_test {
namespace {

using jobs::Journal;
using testing::message_of;
using testing::TemporaryFolder;

const Journal::Header kHeader{{"dataset", "log.csv"}, {"seed", "1"}};
constexpr const char* kKind = "kelpie-test-journal";

void append(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::app) << text;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Journal, GivesBackWhatAnEarlierOneWasTold) {
  const TemporaryFolder folder;
  {
    Journal journal(folder / "new" / "journal.jsonl", kKind, kHeader);
    journal.add("a \"key\"\n", R"({"r2":0.30000000000000004,"name":"ö"})");
    journal.add("b", "null");
    EXPECT_EQ(journal.result("b"), "null");
  }
  const Journal journal(folder / "new" / "journal.jsonl", kKind, kHeader);
  EXPECT_EQ(journal.size(), 2U);
  EXPECT_EQ(journal.result("a \"key\"\n"), "{\"r2\":0.30000000000000004,\"name\":\"ö\"}");
  EXPECT_FALSE(journal.has("c"));
}

// A process may be killed, and a machine lost, at any byte.
TEST(Journal, CutOffAtAnyByteItKeepsTheWholeLinesAndGoesOn) {
  const TemporaryFolder folder;
  const auto whole = folder / "whole.jsonl";
  {
    Journal journal(whole, kKind, kHeader);
    journal.add("first", "1");
    journal.add("second", "[1,2]");
  }
  const std::string content = content_of(whole);
  for (std::size_t size = 0; size <= content.size(); ++size) {
    const auto file = folder / "cut.jsonl";
    std::filesystem::remove(file);
    append(file, content.substr(0, size));
    if (size % 3 == 0) {
      append(file, std::string(7, '\0'));  // as some file systems leave it
    }
    {
      Journal journal(file, kKind, kHeader);
      const auto lines = std::ranges::count(content.substr(0, size), '\n');
      EXPECT_EQ(journal.size(), lines == 0 ? 0U : static_cast<std::size_t>(lines - 1)) << size;
      journal.add("third", "3");
    }
    EXPECT_EQ(Journal(file, kKind, kHeader).result("third"), "3") << size;
  }
}

// File names may be Latin-1.
TEST(Journal, GoesOnWithTextsThatAreNoUtf8) {
  const TemporaryFolder folder;
  const Journal::Header header{{"dataset", "Br\374cke.csv"}};
  Journal(folder / "journal.jsonl", kKind, header).add("Br\374cke", "1");
  const Journal journal(folder / "journal.jsonl", kKind, header);
  EXPECT_TRUE(journal.has("Br\374cke"));
  EXPECT_EQ(journal.result("Br\374cke"), "1");
}

TEST(Journal, RefusesASecondProcess) {
  const TemporaryFolder folder;
  const Journal journal(folder / "journal.jsonl", kKind, kHeader);
  EXPECT_NE(message_of<InputError>([&] {
              const Journal second(folder / "journal.jsonl", kKind, kHeader);
            }).find("another run is writing into this journal"),
            std::string::npos);
}

TEST(Journal, RefusesAnotherRunsJournalNamingWhatDiffers) {
  const TemporaryFolder folder;
  const auto file = folder / "journal.jsonl";
  { const Journal begun(file, kKind, kHeader); }
  const std::string message = message_of<InputError>([&] {
    const Journal other(file, kKind, {{"dataset", "log.csv"}, {"seed", "2"}});
  });
  EXPECT_NE(message.find("seed: this run has \"2\", but the journal was begun with \"1\""),
            std::string::npos)
      << message;
  EXPECT_THROW(Journal(file, "kelpie-other-journal", kHeader), InputError);
}

TEST(Journal, RefusesFilesThatAreNoJournalAndBrokenLinesAndLeavesThemAsTheyAre) {
  const TemporaryFolder folder;
  append(folder / "other.csv", "u,v,r\n1,2,3\n");
  EXPECT_THROW(Journal(folder / "other.csv", kKind, kHeader), InputError);
  EXPECT_EQ(content_of(folder / "other.csv"), "u,v,r\n1,2,3\n");
  append(folder / "line", "{\"crc\": 1}");
  EXPECT_THROW(Journal(folder / "line", kKind, kHeader), InputError);
  EXPECT_EQ(content_of(folder / "line"), "{\"crc\": 1}");

  const auto file = folder / "journal.jsonl";
  {
    Journal journal(file, kKind, kHeader);
    journal.add("first", "1");
    journal.add("second", "2");
  }
  std::string content = content_of(file);
  content[content.find("\"result\":1") + 9] = '7';
  std::filesystem::remove(file);
  append(file, content);
  const std::string message =
      message_of<InputError>([&] { const Journal broken(file, kKind, kHeader); });
  EXPECT_NE(message.find(":2: doesn't match its checksum"), std::string::npos) << message;
  EXPECT_EQ(content_of(file), content);
}

TEST(Journal, TheLastResultOfAKeyCounts) {
  const TemporaryFolder folder;
  const auto file = folder / "journal.jsonl";
  {
    Journal journal(file, kKind, kHeader);
    journal.add("first", "1");
    journal.add("first", "2");
    EXPECT_EQ(journal.result("first"), "2");
    EXPECT_EQ(journal.size(), 1U);
  }
  EXPECT_EQ(Journal(file, kKind, kHeader).result("first"), "2");
}

TEST(Journal, IsReadWhileAnotherProcessWritesIt) {
  const TemporaryFolder folder;
  const auto file = folder / "journal.jsonl";
  Journal journal(file, kKind, kHeader);
  journal.add("first", "1");
  append(file, R"({"crc32":"0)");  // half a line
  const std::string content = content_of(file);
  const jobs::JournalReader reader(file, kKind, kHeader);
  EXPECT_EQ(reader.result("first"), "1");
  EXPECT_EQ(reader.size(), 1U);
  EXPECT_EQ(content_of(file), content);
}

TEST(Journal, APipeIsRefusedWithoutWaitingForAWriter) {
  const TemporaryFolder folder;
  const auto file = folder / "journal.jsonl";
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  const std::string message =
      message_of<InputError>([&] { const jobs::JournalReader reader(file, kKind, kHeader); });
  EXPECT_NE(message.find("cannot be read"), std::string::npos) << message;
}

}  // namespace
}  // namespace kelpie::journal_test
