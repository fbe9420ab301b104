// SPDX-License-Identifier: Apache-2.0
#include "file/atomic_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <vector>

#include "file/descriptor.hpp"
#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::atomic_file_test {
namespace {

namespace fs = std::filesystem;
using testing::message_of;
using testing::TemporaryFolder;

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

// As on a full disk: writing beyond `bytes` fails, whoever writes (root, too).
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);  // NOLINT(cert-err33-c): it was set before
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit(FileSizeLimit&&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(FileSizeLimit&&) = delete;

 private:
  void (*handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before_{};
};

TEST(AtomicFile, ReplacesTheOldContentAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const std::string binary("new\0\n\xFF", 6);
  file::write_file_whole(folder / "a.json", "a much longer old content");
  file::write_file_whole(folder / "a.json", binary);
  EXPECT_EQ(content_of(folder / "a.json"), binary);
  file::write_file_whole(folder / "a.json", "");
  EXPECT_EQ(content_of(folder / "a.json"), "");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFile, AFileNameWithoutFolderMeansTheCurrentOne) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  file::write_file_whole("here.txt", "x");
  fs::current_path(before);
  EXPECT_EQ(content_of(folder / "here.txt"), "x");
}

TEST(AtomicFile, FailureNamesFileAndReason) {
  const TemporaryFolder folder;
  file::write_file_whole(folder / "file", "x");
  const std::string message =
      message_of<Failure>([&] { file::write_file_whole(folder / "file" / "below.csv", "y"); });
  EXPECT_NE(message.find("below.csv"), std::string::npos) << message;
  EXPECT_NE(message.find("Not a directory"), std::string::npos) << message;
  EXPECT_THROW(file::write_file_whole(folder / "missing" / "a", "y"), Failure);
}

TEST(AtomicFile, AFullDiskKeepsTheOldContentAndLeavesNoDraft) {
  const TemporaryFolder folder;
  file::write_file_whole(folder / "a", "old");
  file::write_file_whole(folder / "b", "old");
  {
    const FileSizeLimit limit(1000);
    EXPECT_THROW(file::write_file_whole(folder / "a", std::string(5000, 'x')), Failure);
    EXPECT_THROW(
        file::write_files_whole(folder.path(), {{"a", "new"}, {"b", std::string(5000, 'x')}}),
        Failure);
  }
  EXPECT_EQ(content_of(folder / "a"), "old");
  EXPECT_EQ(content_of(folder / "b"), "old");
  EXPECT_EQ(entries(folder.path()), 2U);
}

TEST(AtomicFile, FoldersAndDevicesAreNotReplaced) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  EXPECT_THROW(file::write_file_whole(folder / "sub", "x"), Failure);
  fs::create_symlink("/dev/null", folder / "null");
  EXPECT_THROW(file::write_file_whole(folder / "null", "x"), Failure);
  EXPECT_TRUE(fs::is_character_file(folder / "null"));
  EXPECT_EQ(entries(folder.path()), 2U);
}

TEST(AtomicFile, ALinkStaysALink) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  file::write_file_whole(folder / "sub" / "real", "old");
  fs::create_symlink(folder / "sub" / "real", folder / "link");
  file::write_file_whole(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(content_of(folder / "sub" / "real"), "new");
}

TEST(AtomicFile, TheContentKeptOfALinkIsTheOldOne) {
  const fs::path memory = "/dev/shm";  // a file system of its own
  for (const bool is_elsewhere : {false, true}) {
    if (is_elsewhere && !fs::is_directory(memory)) {
      GTEST_SKIP() << "there is no second file system";
    }
    const TemporaryFolder folder;
    fs::create_directory(folder / "sub");
    const fs::path real =
        is_elsewhere ? memory / folder.path().filename() : folder / "sub" / "real";
    file::write_file_whole(real, "first");
    fs::create_symlink(real, folder / "link");
    for (const char* const content : {"second", "third"}) {
      file::write_file_keeping(folder / "link", content, folder / "previous");
    }
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(content_of(real), "third");
    EXPECT_EQ(content_of(folder / "previous"), "second");
    EXPECT_EQ(entries(folder.path()), 3U);
    fs::remove(real);
  }
}

TEST(AtomicFile, ALeftOverDraftIsNoObstacle) {
  const TemporaryFolder folder;
  // The drafts a killed process of our number would have left, whatever it had counted to.
  for (int count = 0; count < 200; ++count) {
    std::ostringstream name;
    name << "a." << ::getpid() << '-' << count << ".tmp";
    std::ofstream(folder / name.str()) << "left over";
  }
  file::write_file_whole(folder / "a", "new");
  EXPECT_EQ(content_of(folder / "a"), "new");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFile, DraftsOfTheKilledAreRemovedAndNothingElse) {
  const TemporaryFolder folder;
  for (const char* const name :
       {"a.json.12-0.tmp", "a.json.5-link.tmp", "b.json.7-3.tmp", "a.json.tmp", "a.json.1-.tmp"}) {
    std::ofstream(folder / name) << "x";
  }
  // Somebody is still writing this one.
  const file::Descriptor living(folder / "a.json.12-1.tmp", O_RDWR | O_CREAT);
  ASSERT_TRUE(living.lock(LOCK_EX));
  file::write_file_whole(folder / "a.json", "new");
  EXPECT_EQ(entries(folder.path()), 5U);
  for (const char* const name :
       {"a.json", "b.json.7-3.tmp", "a.json.tmp", "a.json.1-.tmp", "a.json.12-1.tmp"}) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  file::remove_drafts(folder / "missing" / "a.json");
}

TEST(AtomicFile, AnOldFileThatIsNoPartOfTheSetGoes) {
  const TemporaryFolder folder;
  file::write_files_whole(folder.path(), {{"model", "1"}, {"result", "1"}});
  {
    const FileSizeLimit limit(1000);
    EXPECT_THROW(file::write_files_whole(
                     folder.path(), {{"model", std::nullopt}, {"result", std::string(5000, 'x')}}),
                 Failure);
  }
  EXPECT_EQ(content_of(folder / "model"), "1");  // the old set, whole
  file::write_files_whole(folder.path(), {{"model", std::nullopt}, {"result", "2"}});
  EXPECT_FALSE(fs::exists(folder / "model"));
  EXPECT_EQ(content_of(folder / "result"), "2");
  EXPECT_NO_THROW(file::write_files_whole(folder.path(), {{"model", std::nullopt}}));
}

TEST(AtomicFile, WhetherItCanBeWrittenIsKnownBefore) {
  const TemporaryFolder folder;
  file::check_writable(folder / "a");
  EXPECT_EQ(entries(folder.path()), 0U);
  file::write_file_whole(folder / "a", "old");
  file::check_writable(folder / "a");
  EXPECT_EQ(content_of(folder / "a"), "old");
  EXPECT_THROW(file::check_writable(folder / "missing" / "a"), Failure);
  EXPECT_THROW(file::check_writable(folder / "a" / "b"), Failure);
  EXPECT_THROW(file::check_writable(folder.path()), Failure);
}

TEST(AtomicFile, SeveralFilesMakeTheirFolder) {
  const TemporaryFolder folder;
  file::write_files_whole(folder / "x" / "y", {{"a.json", "1"}, {"b.html", "2"}});
  EXPECT_EQ(content_of(folder / "x" / "y" / "a.json"), "1");
  EXPECT_EQ(content_of(folder / "x" / "y" / "b.html"), "2");
  EXPECT_EQ(entries(folder / "x" / "y"), 2U);
  const file::Content told([](const auto& write) {
    write("piece ");
    write("by piece");
  });
  file::write_files_whole(folder / "x", {{"told", told}});
  EXPECT_EQ(content_of(folder / "x" / "told"), "piece by piece");
  file::write_file_whole(folder / "file", "");
  EXPECT_THROW(file::write_files_whole(folder / "file", {{"a", "1"}}), Failure);
}

}  // namespace
}  // namespace kelpie::atomic_file_test
