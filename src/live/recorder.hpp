// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bag/mcap_writer.hpp"
#include "bag/message_type.hpp"
#include "file/descriptor.hpp"

namespace kelpie::live {

/// Writes all messages that come into an MCAP file, which `kelpie learn` reads as it does any bag.
/// What came more than five seconds ago is in the file, whatever happens; a file whose program was
/// killed lacks its end (`--recover` reads it). Used by one thread.
class Recorder {
 public:
  /// Into a new file live_0001.mcap, live_0002.mcap, … of `folder`, which is made where it is
  /// missing. Throws Failure where the file can't be made.
  Recorder(const std::filesystem::path& folder, const std::filesystem::path& definitions);

  /// Where a disk is full, recording ends, and error() says so.
  void write(const std::vector<bag::Topic>& topics, const bag::Message& message);
  void finish();  ///< Writes the end of the file.

  const std::filesystem::path& file() const { return path_; }
  const std::string& error() const { return error_; }  ///< Empty: all is well.

 private:
  void append(const std::string& bytes);

  bag::MessageDefinitions definitions_;
  std::filesystem::path path_;
  file::Descriptor file_;
  bag::McapWriter writer_;
  std::size_t topics_ = 0;  // added
  std::chrono::steady_clock::time_point written_;
  std::string error_;
};

}  // namespace kelpie::live
