// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bag/mcap_writer.hpp"
#include "file/descriptor.hpp"

namespace kelpie::live {

/// The last PARAM_VALUE of each of a vehicle's parameters, in bounded memory. A vehicle tells its
/// parameters once, and every recording needs the parameters.
class ParameterMessages {
 public:
  void hear(const std::vector<bag::Topic>& topics, const bag::Message& message);

  /// Calls `use` with each, by topic and name, as if received with `like`.
  void visit(const bag::Message& like, const std::function<void(const bag::Message&)>& use) const;

 private:
  using Name = std::pair<std::size_t, std::string>;  // of topic and parameter

  std::map<Name, std::vector<std::byte>> last_;
};

/// Records messages to an MCAP file. A killed program loses at most the last
/// Tuning::between_recordings, a power cut also what the system has not yet written; the file then
/// has no end, and `--recover` reads the file. Where the disk takes no more, messages are counted
/// as lost, until a chunk of a new file is written. For one thread.
class Recorder {
 public:
  /// Creates live_0001.mcap, live_0002.mcap, … in `folder`, and the folder where missing. Throws
  /// Failure.
  Recorder(std::filesystem::path folder, const std::filesystem::path& definitions);

  /// Every new file begins with these. Requires that they outlive this.
  void begin_with(const ParameterMessages& parameters) { parameters_ = &parameters; }

  void write(const std::vector<bag::Topic>& topics, const bag::Message& message);
  void finish();  ///< Writes the end of the file.

  const std::string& error() const { return error_; }  ///< Why nothing is recorded now, or empty.
  std::size_t lost() const { return lost_; }           ///< Messages not recorded.

 private:
  void open();
  bool reopen();
  bool append(const std::string& bytes);
  void note_written(const std::string& bytes);
  void give_up();

  std::filesystem::path folder_;
  bag::MessageDefinitions definitions_;
  std::filesystem::path path_;
  std::optional<file::Descriptor> file_;  // none: the disk took no more
  std::size_t bytes_ = 0;                 // of whole chunks in the file, and its head
  std::optional<bag::McapWriter> writer_;
  const ParameterMessages* parameters_ = nullptr;
  bool is_new_ = true;       // nothing was written to the file
  bool has_chunks_ = false;  // in the file
  std::size_t topics_ = 0;   // added to the file
  std::size_t waiting_ = 0;  // messages in writer_
  std::size_t lost_ = 0;
  std::chrono::steady_clock::time_point written_;  // or tried
  std::string error_;
};

}  // namespace kelpie::live
