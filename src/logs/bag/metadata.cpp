// SPDX-License-Identifier: Apache-2.0
#include "bag/metadata.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>

#include "core/text.hpp"
#include "file/content.hpp"
#include "file/tuning.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

// The parts of metadata.yaml with error messages that name line and key.
class MetadataFile {
 public:
  explicit MetadataFile(std::string file) : file_(std::move(file)) {}

  std::vector<std::string> read() const {
    const YAML::Node root = load();
    const YAML::Node bag = root.IsMap() ? root["rosbag2_bagfile_information"] : YAML::Node();
    if (!bag.IsDefined() || !bag.IsMap()) {
      refuse({}, "rosbag2_bagfile_information", "is missing; rosbag2 writes it");
    }
    check_storage(bag["storage_identifier"], text(bag, "storage_identifier"));
    check_compression(bag);
    const YAML::Node files = bag["relative_file_paths"];
    if (!files.IsDefined() || !files.IsSequence() || files.size() == 0) {
      refuse(bag.Mark(), "relative_file_paths", "a list of files is due");
    }
    std::vector<std::string> names;
    for (const YAML::Node& node : files) {
      std::string name = file_name(node);
      if (std::ranges::find(names, name) != names.end()) {
        refuse(node.Mark(), "relative_file_paths", "'" + name + "' stands here twice");
      }
      names.push_back(std::move(name));
    }
    return names;
  }

 private:
  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& key,
                           const std::string& message) const {
    const std::size_t line = mark.is_null() ? 0 : static_cast<std::size_t>(mark.line) + 1;
    throw InputError({.file = file_, .line = line, .field = key}, message);
  }

  YAML::Node load() const {
    try {
      return YAML::Load(
          file::read_content(file_, "rosbag2's metadata.yaml", file::kTuning.configuration_bytes));
    } catch (const YAML::Exception& error) {
      refuse(error.mark, "", "is no YAML: " + error.msg);
    }
  }

  std::string text(const YAML::Node& map, const std::string& key) const {
    const YAML::Node value = map[key];
    if (!value.IsDefined() || !value.IsScalar()) {
      refuse(map.Mark(), key, "a word is due");
    }
    return value.Scalar();
  }

  // `ros2 bag reindex` leaves it empty; files are told apart by their content.
  void check_storage(const YAML::Node& node, const std::string& storage) const {
    const std::array<std::string, 2> known{"sqlite3", "mcap"};
    if (!storage.empty() && std::ranges::find(known, storage) == known.end()) {
      refuse(node.Mark(), "storage_identifier",
             "the storage '" + storage + "' is unknown" + did_you_mean(storage, known) +
                 "; sqlite3 and mcap are read");
    }
  }

  void check_compression(const YAML::Node& bag) const {
    const YAML::Node mode = bag["compression_mode"];
    if (mode.IsDefined() && mode.IsScalar() && !mode.Scalar().empty() && mode.Scalar() != "NONE" &&
        mode.Scalar() != "none") {
      refuse(mode.Mark(), "compression_mode",
             "rosbag2 compressed this bag by " + mode.Scalar() +
                 "; `ros2 bag convert` writes it without (MCAP's own compression is read)");
    }
  }

  std::string file_name(const YAML::Node& node) const {
    const std::filesystem::path name = node.IsScalar() ? node.Scalar() : "";
    const bool is_outside = name.is_absolute() || std::ranges::find(name, "..") != name.end();
    if (!name.has_filename() || name.filename() == "..") {
      refuse(node.Mark(), "relative_file_paths", "the name of a file is due");
    }
    return (is_outside ? name.filename() : name.lexically_normal()).string();
  }

  std::string file_;
};

}  // namespace

std::vector<std::string> read_metadata(const std::filesystem::path& file) {
  return MetadataFile(file.string()).read();
}

}  // namespace kelpie::bag
