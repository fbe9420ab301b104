// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "bag/bag.hpp"
#include "bag/byte_reader.hpp"
#include "bag/mapped_file.hpp"

namespace kelpie::bag {

/// What readers of a file share whose messages stand one right behind the other: damage is noted,
/// and reading goes on at the next place that is sound.
class FileReader : public BagReader {
 public:
  /// `bytes` is the file's content and has to outlive the reader; messages call it `file`.
  FileReader(std::span<const std::byte> bytes, const std::string& file, ReadMode mode)
      : BagReader(mode, file), bytes_(bytes), region_{.file = file, .part = ""} {}

  bool next(Message& message) final;
  Place place() const final;

 protected:
  /// Takes what begins at at_ and steps behind it; true where it was a message, which note() was
  /// told of. Throws InputError on damage.
  virtual bool step(Message& message) = 0;
  /// Steps behind at_, to the next place that is sound, or to the end.
  virtual void pass_damage() = 0;

  /// A message of this topic stands at this offset.
  void note(std::size_t topic, std::size_t offset);
  bool has_noted() const { return last_topic_ != kNoTopic; }

  static constexpr std::size_t kNoTopic = static_cast<std::size_t>(-1);

  std::span<const std::byte> bytes_;
  Region region_;
  std::size_t at_ = 0;

 private:
  // The message given last: for place(), which is asked only when something is wrong.
  std::size_t last_topic_ = kNoTopic;
  std::size_t last_offset_ = 0;
};

/// A reader of bytes, with the file that they are of. It must not shrink meanwhile.
template <typename Reader>
class OfFile final : private MappedFile, public Reader {
 public:
  OfFile(const std::filesystem::path& file, ReadMode mode)
      : MappedFile(file), Reader(MappedFile::bytes(), file.string(), mode) {}
};

}  // namespace kelpie::bag
