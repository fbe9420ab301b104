// SPDX-License-Identifier: Apache-2.0
#include "format/checkpoint_file.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <span>

#include "file/atomic_file.hpp"
#include "file/content.hpp"
#include "file/crc32.hpp"
#include "file/tuning.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::format {
namespace {

namespace fs = std::filesystem;

// As PNG's: a transfer that changes line ends or drops the eighth bit shows in the first bytes.
constexpr std::string_view kMagic = "\x8BKELPIE\r\n\x1A\n\n";
constexpr std::uint64_t kVersion = 5;
constexpr std::size_t kVersionBytes = 4;
constexpr std::size_t kLengthBytes = 8;
constexpr std::size_t kChecksumBytes = 4;
constexpr std::size_t kFrontBytes = kMagic.size() + kVersionBytes + 2 * kLengthBytes;

std::string little_endian(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) {
    text += static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
  }
  return text;
}

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) {
    value = value << 8U | static_cast<unsigned char>(bytes[i]);
  }
  return value;
}

std::uint32_t checksum(std::string_view bytes) {
  return file::crc32_of(std::as_bytes(std::span(bytes)));
}

}  // namespace

std::string checkpoint_bytes(const Checkpoint& checkpoint) {
  std::string bytes(kMagic);
  bytes.reserve(kFrontBytes + checkpoint.header.size() + checkpoint.state.size() + kChecksumBytes);
  bytes += little_endian(kVersion, kVersionBytes);
  bytes += little_endian(checkpoint.header.size(), kLengthBytes);
  bytes += little_endian(checkpoint.state.size(), kLengthBytes);
  bytes += checkpoint.header;
  bytes += checkpoint.state;
  bytes += little_endian(checksum(bytes), kChecksumBytes);
  return bytes;
}

Checkpoint parse_checkpoint(std::string_view bytes, const std::string& source) {
  const auto require = [&](bool good, const std::string& otherwise) {
    if (!good) {
      throw InputError({.file = source, .line = 0, .field = {}}, otherwise);
    }
  };
  require(!bytes.empty(), "is empty");
  require(bytes.substr(0, kMagic.size()) == kMagic.substr(0, bytes.size()),
          "is no checkpoint of kelpie");
  require(bytes.size() >= kFrontBytes + kChecksumBytes, "is cut short");
  const std::uint64_t version = little_endian(bytes.substr(kMagic.size(), kVersionBytes));
  require(version == kVersion,
          fmt::format("is a checkpoint of version {}; this kelpie reads only version {}", version,
                      kVersion));
  const std::string_view lengths = bytes.substr(kMagic.size() + kVersionBytes);
  const std::uint64_t header = little_endian(lengths.substr(0, kLengthBytes));
  const std::uint64_t state = little_endian(lengths.substr(kLengthBytes, kLengthBytes));
  const std::size_t held = bytes.size() - kFrontBytes - kChecksumBytes;
  require(header <= held && state <= held - header, "is cut short");
  require(header + state == held, "is longer than it says");
  const std::size_t end = bytes.size() - kChecksumBytes;
  require(checksum(bytes.substr(0, end)) == little_endian(bytes.substr(end)),
          "is damaged: its checksum doesn't fit");
  return {std::string(bytes.substr(kFrontBytes, header)),
          std::string(bytes.substr(kFrontBytes + header, state))};
}

void write_checkpoint(const fs::path& folder, const Checkpoint& checkpoint) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Failure(fmt::format("{}: cannot be written: {}", folder.string(), error.message()));
  }
  file::write_file_keeping(folder / kCheckpointName, checkpoint_bytes(checkpoint),
                           folder / kPreviousCheckpointName);
}

bool is_checkpoint(const fs::path& file) {
  return file::beginning_of(file, kMagic.size()) == kMagic;
}

FoundCheckpoint read_checkpoint(const fs::path& file) {
  const std::string bytes =
      file::read_content(file, "a checkpoint of kelpie", file::kTuning.document_bytes);
  return {parse_checkpoint(bytes, file.string()), file, {}};
}

std::optional<FoundCheckpoint> find_checkpoint(const fs::path& folder) {
  std::string passed_over;
  for (const char* const name : {kCheckpointName, kPreviousCheckpointName}) {
    const fs::path file = folder / name;
    if (!fs::exists(file)) {
      continue;
    }
    try {
      FoundCheckpoint found = read_checkpoint(file);
      found.passed_over = passed_over;
      return found;
    } catch (const InputError& error) {
      passed_over += (passed_over.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  if (passed_over.empty()) {
    return std::nullopt;
  }
  throw InputError(passed_over + "; there is no other checkpoint to go on from");
}

}  // namespace kelpie::format
