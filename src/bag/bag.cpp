// SPDX-License-Identifier: Apache-2.0
#include "bag/bag.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <span>
#include <string_view>
#include <utility>

#include "bag/alog_reader.hpp"
#include "bag/dataflash_reader.hpp"
#include "bag/mat_reader.hpp"
#include "bag/mcap_reader.hpp"
#include "bag/metadata.hpp"
#include "bag/ros1_reader.hpp"
#include "bag/ros1_records.hpp"
#include "bag/sqlite_reader.hpp"
#include "bag/tlog_reader.hpp"
#include "bag/ulog_reader.hpp"

namespace kelpie::bag {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMetadata = "metadata.yaml";
constexpr std::string_view kMcap = "\x89MCAP";
constexpr std::string_view kSqlite = "SQLite format 3";

[[noreturn]] void refuse(const fs::path& file, const std::string& message) {
  throw InputError({.file = file.string(), .line = 0, .field = {}}, message);
}

// Empty when it can't be read.
std::string beginning_of(const fs::path& file) {
  std::array<char, 4096> bytes{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), bytes.size());
  return {bytes.data(), static_cast<std::size_t>(stream.gcount())};
}

// The kinds of files: what they begin with, and who reads them.
struct FileKind {
  bool (*is_it)(std::string_view beginning);
  std::unique_ptr<BagReader> (*read)(const fs::path& file, ReadMode mode);
};

std::unique_ptr<BagReader> refuse_encrypted_ulog(const fs::path& file, ReadMode /*mode*/) {
  refuse(file, "is an encrypted ULog file; PX4's decrypt_ulog.py makes a plain one of it");
}

std::unique_ptr<BagReader> refuse_dataflash_text(const fs::path& file, ReadMode /*mode*/) {
  refuse(file, "is a DataFlash log as text; the .BIN file that it was made of is read");
}

constexpr std::array<FileKind, 10> kFileKinds{{
    {[](std::string_view beginning) { return begins_as_alog(std::as_bytes(std::span(beginning))); },
     read_alog},
    {begins_as_mat, [](const fs::path& file, ReadMode mode) { return read_mat(file, mode); }},
    {[](std::string_view beginning) { return beginning.starts_with(kMcap); }, read_mcap},
    {[](std::string_view beginning) { return beginning.starts_with(kSqlite); }, read_sqlite_bag},
    {[](std::string_view beginning) { return beginning.starts_with(kRos1Magic); }, read_ros1},
    {begins_as_ulog, read_ulog},
    {[](std::string_view beginning) { return beginning.starts_with("ULogEnc"); },
     refuse_encrypted_ulog},
    {begins_as_dataflash, read_dataflash},
    {[](std::string_view beginning) { return beginning.starts_with("FMT, 128, 89, FMT,"); },
     refuse_dataflash_text},
    {[](std::string_view beginning) { return begins_as_tlog(std::as_bytes(std::span(beginning))); },
     read_tlog},
}};

const FileKind* kind_of_file(const std::string& beginning) {
  const auto* const found =
      std::ranges::find_if(kFileKinds, [&](const FileKind& kind) { return kind.is_it(beginning); });
  return found == kFileKinds.end() ? nullptr : found;
}

std::unique_ptr<BagReader> open_file(const fs::path& file, ReadMode mode) {
  std::error_code error;
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) {
    refuse(file, "is a pipe or a device; a bag has to be a file");
  }
  if (!std::ifstream(file).is_open()) {
    refuse(file, "cannot be read; is it there?");
  }
  const std::string beginning = beginning_of(file);
  if (const FileKind* const kind = kind_of_file(beginning)) {
    return kind->read(file, mode);
  }
  refuse(file, beginning.empty()
                   ? "is empty"
                   : "is neither an MCAP file nor one of sqlite3, nor a .tlog file "
                     "of MAVLink, a bag of ROS 1, a .BIN of ArduPilot, a ULog file of "
                     "PX4, an .alog of MOOS or a .mat of MATLAB");
}

// The files of a rosbag2 folder, one after the other.
class FolderReader final : public BagReader {
 public:
  FolderReader(const fs::path& folder, ReadMode mode) : BagReader(mode, folder.string()) {
    if (mode == ReadMode::strict || fs::exists(folder / kMetadata)) {
      list_files(folder);
    } else {
      lose(InputError({.file = (folder / kMetadata).string(), .line = 0, .field = {}},
                      "is missing; the folder's files are read in the order of their names"));
      find_files(folder);
    }
  }

  bool next(Message& message) override {
    while (at_ < files_.size()) {
      try {
        if (next_of_file(message)) {
          return true;
        }
      } catch (const InputError& error) {
        lose(error);
      }
      current_.reset();
      ++at_;
    }
    return false;
  }

  Place place() const override { return current_ == nullptr ? Place{} : current_->place(); }

 private:
  void list_files(const fs::path& folder) {
    const fs::path metadata = folder / kMetadata;
    if (!fs::exists(metadata)) {
      refuse(metadata,
             "is missing; rosbag2 writes it when recording ends (`ros2 bag reindex` "
             "makes it again; --recover does without)");
    }
    for (const std::string& name : read_metadata(metadata).files) {
      if (fs::exists(folder / name)) {
        files_.push_back(folder / name);
      } else {
        lose(InputError({.file = (folder / name).string(), .line = 0, .field = {}},
                        "is missing; metadata.yaml lists it"));
      }
    }
  }

  void find_files(const fs::path& folder) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".db3" || extension == ".mcap") {
        files_.push_back(entry.path());
      }
    }
    std::ranges::sort(files_);
  }

  bool next_of_file(Message& message) {
    if (current_ == nullptr) {
      topics_of_file_.clear();
      current_ = open_file(files_[at_], mode());
    }
    const bool is_there = current_->next(message);
    while (topics_of_file_.size() < current_->topics().size()) {
      topics_of_file_.push_back(
          add_topic(current_->topics()[topics_of_file_.size()], files_[at_].string()));
    }
    take_losses(*current_);
    if (is_there) {
      message.topic = topics_of_file_[message.topic];
    }
    return is_there;
  }

  std::vector<fs::path> files_;
  std::size_t at_ = 0;
  std::unique_ptr<BagReader> current_;
  std::vector<std::size_t> topics_of_file_;  // the file's number of a topic to the bag's
};

}  // namespace

std::string BagReader::losses_text() const {
  std::string text;
  for (const std::string& loss : losses_) {
    text += "lost: " + loss + "\n";
  }
  if (loss_count_ > losses_.size()) {
    text += "lost: " + std::to_string(loss_count_ - losses_.size()) + " more\n";
  }
  return text;
}

void BagReader::lose(const InputError& damage) {
  if (mode_ == ReadMode::strict) {
    throw damage;  // NOLINT(cert-err60-cpp): a copy of texts fails only without memory
  }
  if (losses_.size() < kShownLosses) {
    losses_.emplace_back(damage.what());
  }
  ++loss_count_;
}

void BagReader::take_losses(BagReader& other) {
  for (std::string& loss : other.losses_) {
    if (losses_.size() < kShownLosses) {
      losses_.push_back(std::move(loss));
    }
  }
  loss_count_ += std::exchange(other.loss_count_, 0);
  other.losses_.clear();
}

std::size_t BagReader::add_topic(const Topic& topic, const std::string& file) {
  const auto [found, is_new] = index_by_name_.emplace(topic.name, topics_.size());
  if (is_new) {
    topics_.push_back(topic);
  } else if (topics_[found->second].type != topic.type) {
    throw InputError({.file = file, .line = 0, .field = topic.name},
                     "has two types, " + topics_[found->second].type + " and " + topic.type);
  }
  return found->second;
}

bool is_bag(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return true;
  }
  if (!fs::is_regular_file(path, error)) {
    return false;  // looking into a pipe would take from it
  }
  return kind_of_file(beginning_of(path)) != nullptr;
}

std::unique_ptr<BagReader> open_bag(const fs::path& path, ReadMode mode) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return std::make_unique<FolderReader>(path, mode);
  }
  return open_file(path, mode);
}

}  // namespace kelpie::bag
