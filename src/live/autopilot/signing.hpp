// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "mavlink/frame.hpp"

namespace kelpie::autopilot {

using SigningKey = std::array<std::byte, 32>;

/// The key in a file: 64 hexadecimal digits. Throws InputError (file) on other content.
SigningKey read_signing_key(const std::filesystem::path& file);

/// Time of signatures: 10 µs since 1 January 2015.
using SigningTime = std::uint64_t;
SigningTime signing_time_now();  ///< By this machine's clock.

/// Signatures of MAVLink 2 (https://mavlink.io/en/guide/message_signing.html): the first 48 bits of
/// SHA-256 over key, frame, link number and time. For one thread.
class Signing {
 public:
  enum class Verdict : std::uint8_t {
    right,
    absent,  ///< an unsigned frame
    wrong,   ///< another key, or a forgery
    old,     ///< a repeated frame, or a new sender's frame older than Tuning::oldest_signature
    crowded  ///< a new sender beyond Tuning::most_streams
  };

  explicit Signing(const SigningKey& key) : key_(key) {}

  /// The times of one sender (system, component, link) only grow. `now` is a time in the units of
  /// the signatures.
  Verdict check(const mavlink::Frame& frame, SigningTime now);
  /// Appends a signature to a frame with the flag of signed frames.
  void sign(std::vector<std::byte>& frame, SigningTime now);

 private:
  using StreamId = std::tuple<std::uint8_t, std::uint8_t, std::uint8_t>;

  std::array<std::byte, 6> digest(std::span<const std::byte> bytes) const;

  SigningKey key_;
  SigningTime newest_ = 0;  // of all right signatures, own ones included
  std::map<StreamId, SigningTime> streams_;
};

}  // namespace kelpie::autopilot
