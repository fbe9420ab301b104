// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bag/mcap_writer.hpp"
#include "file/descriptor.hpp"

namespace kelpie::live {

/// Records messages to an MCAP file. At most the last Tuning::between_recordings are lost, whatever
/// happens; a killed program leaves a file without an end, which `--recover` reads. For one thread.
class Recorder {
 public:
  /// Creates live_0001.mcap, live_0002.mcap, … in `folder`, and the folder where missing. Throws
  /// Failure.
  Recorder(const std::filesystem::path& folder, const std::filesystem::path& definitions);

  /// Recording ends with the first error, which error() describes.
  void write(const std::vector<bag::Topic>& topics, const bag::Message& message);
  void finish();  ///< Writes the end of the file.

  const std::filesystem::path& file() const { return path_; }
  const std::string& error() const { return error_; }  ///< Empty: none.

 private:
  void append(const std::string& bytes);

  bag::MessageDefinitions definitions_;
  std::filesystem::path path_;
  file::Descriptor file_;
  bag::McapWriter writer_;
  std::size_t topics_ = 0;  // added to the file
  std::chrono::steady_clock::time_point written_;
  std::string error_;
};

}  // namespace kelpie::live
