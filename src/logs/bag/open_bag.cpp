// SPDX-License-Identifier: Apache-2.0
#include "bag/open_bag.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <system_error>

#include "bag/alog_reader.hpp"
#include "bag/byte_reader.hpp"
#include "bag/dataflash_reader.hpp"
#include "bag/mat_reader.hpp"
#include "bag/mcap_reader.hpp"
#include "bag/metadata.hpp"
#include "bag/ros1_reader.hpp"
#include "bag/sqlite_reader.hpp"
#include "bag/tlog_reader.hpp"
#include "bag/tuning.hpp"
#include "bag/ulog_reader.hpp"
#include "core/text.hpp"
#include "file/content.hpp"
#include "file/mapped_file.hpp"

namespace kelpie::bag {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMetadata = "metadata.yaml";

[[noreturn]] void refuse(const fs::path& file, const std::string& message) {
  throw InputError({.file = file.string()}, message);
}

// Refuses a place that permissions hide.
bool is_there(const fs::path& file) {
  std::error_code error;
  const bool found = fs::exists(file, error);
  if (error) {
    refuse(file, "cannot be read: " + error.message());
  }
  return found;
}

// Empty for anything but a regular file that can be read.
std::string beginning_of(const fs::path& file) {
  return file::beginning_of(file, kTuning.recognised_by);
}

using Reader = std::unique_ptr<MessageReader>;

// A format of files: a line of kFileKinds. Readers of bytes get the mapped file.
struct FileKind {
  std::string_view ending;  // of the files' names; empty: such files are refused
  std::string_view name;    // of the format; or why files are refused
  bool (*is_it)(std::string_view beginning);
  Reader (*read_bytes)(std::span<const std::byte>, const std::string& file, ReadMode) = nullptr;
  Reader (*read_file)(const fs::path&, ReadMode, const RowTimes&) = nullptr;
};

// The last one recognises the least: a frame may stand anywhere in a .tlog file's beginning.
constexpr auto kFileKinds = std::to_array<FileKind>({
    {".db3", "SQLite of rosbag2", begins_as_sqlite, nullptr, read_sqlite_bag},
    {".mcap", "MCAP", begins_as_mcap, read_mcap},
    {".bag", "ROS 1", begins_as_ros1, read_ros1},
    {".BIN", "ArduPilot", begins_as_dataflash, read_dataflash},
    {"", "is a DataFlash log as text; give the original .BIN file",
     [](std::string_view beginning) { return beginning.starts_with("FMT, 128, 89, FMT,"); }},
    {".ulg", "PX4", begins_as_ulog, read_ulog},
    {"", "is an encrypted ULog file; decrypt it with PX4's decrypt_ulog.py",
     [](std::string_view beginning) { return beginning.starts_with("ULogEnc"); }},
    {".alog", "MOOS", begins_as_alog, read_alog},
    {".mat", "MATLAB", begins_as_mat, nullptr, read_mat},
    {".tlog", "MAVLink", begins_as_tlog, read_tlog},
});

const FileKind* kind_of_file(std::string_view beginning) {
  const auto* const found =
      std::ranges::find_if(kFileKinds, [&](const FileKind& kind) { return kind.is_it(beginning); });
  return found == kFileKinds.end() ? nullptr : found;
}

const FileKind& required_kind(std::string_view beginning, const fs::path& file) {
  const FileKind* const kind = kind_of_file(beginning);
  if (beginning.empty()) {
    refuse(file, "is empty");
  }
  if (kind != nullptr && kind->ending.empty()) {
    refuse(file, std::string(kind->name));
  }
  if (kind != nullptr) {
    return *kind;
  }
  std::vector<std::string> known;
  for (const FileKind& one : kFileKinds) {
    if (!one.ending.empty()) {
      known.push_back(std::string(one.name) + " (" + std::string(one.ending) + ")");
    }
  }
  refuse(file, "is of no known format; these are read: " + join_text(known, ", "));
}

Reader open_file(const fs::path& file, ReadMode mode, const RowTimes& times) {
  std::error_code error;
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) {
    refuse(file, "is a pipe or a device; a bag has to be a file");
  }
  const auto content =
      std::make_shared<file::MappedFile>(file);  // throws where there is no such file
  const FileKind& kind = required_kind(beginning_of(file), file);
  if (kind.read_file != nullptr) {
    return kind.read_file(file, mode, times);
  }
  Reader reader = kind.read_bytes(content->bytes(), file.string(), mode);
  reader->keep(content);
  return reader;
}

// The files of a rosbag2 folder, one after the other.
class FolderReader final : public MessageReader {
 public:
  FolderReader(const fs::path& folder, ReadMode mode) : MessageReader(mode, folder.string()) {
    if (mode != ReadMode::recover || is_there(folder / kMetadata)) {
      list_files(folder);
    } else {
      lose(InputError({.file = (folder / kMetadata).string()},
                      "is missing; the folder's files are read in the order of their names"));
      find_files(folder);
    }
  }

  Place place() const override { return current_ == nullptr ? Place{} : current_->place(); }

 private:
  bool at_end() const override { return at_ >= files_.size(); }

  bool step(Message& message) override {
    if (current_ == nullptr) {
      topics_of_file_.clear();
      current_ = open_file(files_[at_], mode(), {});
    }
    const bool is_there = current_->next(message);
    while (topics_of_file_.size() < current_->topics().size()) {
      topics_of_file_.push_back(
          add_topic(current_->topics()[topics_of_file_.size()], files_[at_].string()));
    }
    take_losses(*current_);
    if (is_there) {
      message.topic = topics_of_file_[message.topic];
    } else {
      pass_damage();
    }
    return is_there;
  }

  // To the next file.
  void pass_damage() override {
    current_.reset();
    ++at_;
  }

  void list_files(const fs::path& folder) {
    const fs::path metadata = folder / kMetadata;
    if (!is_there(metadata)) {
      find_files(folder);
      if (files_.empty()) {
        refuse(metadata, "is missing; a folder is read as a rosbag2. Of tables name the files: " +
                             (folder / "*.csv").string());
      }
      refuse(metadata,
             "is missing; rosbag2 writes it when recording ends (`ros2 bag reindex` "
             "makes it again; --recover does without)");
    }
    const std::vector<std::string> names = read_metadata(metadata);
    for (const fs::path name : names) {
      // Until Foxy rosbag2 wrote paths from the folder above.
      if (is_there(folder / name)) {
        files_.push_back(folder / name);
      } else if (is_there(folder / name.filename())) {
        files_.push_back(folder / name.filename());
      } else if (names.size() > 1 || !find_renamed(folder)) {
        lose(InputError({.file = (folder / name).string()}, "is missing; metadata.yaml lists it"));
      }
    }
  }

  // The folder's only file, in place of the only one that is listed.
  bool find_renamed(const fs::path& folder) {
    find_files(folder);
    if (files_.size() != 1) {
      files_.clear();
    }
    return !files_.empty();
  }

  void find_files(const fs::path& folder) {
    std::error_code error;
    const fs::directory_iterator entries(folder, error);
    if (error) {
      refuse(folder, "cannot be read: " + error.message());
    }
    for (const auto& entry : entries) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".db3" || extension == ".mcap") {
        files_.push_back(entry.path());
      }
    }
    std::ranges::sort(files_);
  }

  std::vector<fs::path> files_;
  std::size_t at_ = 0;
  Reader current_;
  std::vector<std::size_t> topics_of_file_;  // the file's number of a topic to the bag's
};

}  // namespace

const std::string& recording_formats() {
  static const std::string text = [] {
    std::vector<std::string> endings;
    for (const FileKind& kind : kFileKinds) {
      if (!kind.ending.empty()) {
        endings.emplace_back(kind.ending);
      }
    }
    const std::string last = endings.back();
    endings.pop_back();
    return "a rosbag2 folder, or one " + join_text(endings, ", ") + " or " + last + " file";
  }();
  return text;
}

bool is_bag(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return true;
  }
  return kind_of_file(beginning_of(path)) != nullptr;
}

bool may_lack_times(const fs::path& file) {
  return begins_as_mat(beginning_of(file));
}

std::unique_ptr<MessageReader> open_bytes(std::span<const std::byte> bytes, const std::string& file,
                                          ReadMode mode) {
  const FileKind& kind =
      required_kind(text_of(bytes.first(std::min(bytes.size(), kTuning.recognised_by))), file);
  if (kind.read_bytes == nullptr) {
    refuse(file, "is read as a file only");
  }
  return kind.read_bytes(bytes, file, mode);
}

std::unique_ptr<MessageReader> open_bag(const fs::path& path, ReadMode mode,
                                        const RowTimes& times) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return std::make_unique<FolderReader>(path, mode);
  }
  return open_file(path, mode, times);
}

}  // namespace kelpie::bag
