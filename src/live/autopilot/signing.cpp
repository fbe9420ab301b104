// SPDX-License-Identifier: Apache-2.0
#include "autopilot/signing.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <string>

#include "autopilot/tuning.hpp"
#include "file/content.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::autopilot {
namespace {

constexpr std::size_t kTimeBytes = 6;
constexpr std::size_t kSignatureBytes = 6;
constexpr std::byte kLink{0};  // of own frames

SigningTime time_of(std::span<const std::byte> bytes) {
  SigningTime time = 0;
  for (std::size_t i = 0; i < kTimeBytes; ++i) {
    time |= static_cast<SigningTime>(bytes[i]) << 8U * i;
  }
  return time;
}

}  // namespace

SigningKey read_signing_key(const std::filesystem::path& file) {
  std::string text = file::read_content(file, "a key", kTuning.key_bytes);
  text.resize(text.find_last_not_of(" \t\r\n") + 1);
  SigningKey key{};
  bool is_key = text.size() == 2 * key.size();
  for (std::size_t i = 0; is_key && i < key.size(); ++i) {
    unsigned value = 0;
    const char* const digits = text.data() + 2 * i;
    is_key = std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2;
    key[i] = static_cast<std::byte>(value);
  }
  if (!is_key) {
    throw InputError(file.string(), "is no key; a key has 64 hexadecimal digits");
  }
  return key;
}

SigningTime signing_time_now() {
  using std::chrono::sys_days;
  using Units = std::chrono::duration<std::int64_t, std::ratio<1, 100'000>>;
  constexpr sys_days kBegin{std::chrono::year{2015} / 1 / 1};
  const auto since = std::chrono::system_clock::now() - kBegin;
  return static_cast<SigningTime>(
      std::max<std::int64_t>(0, std::chrono::duration_cast<Units>(since).count()));
}

std::array<std::byte, kSignatureBytes> Signing::digest(std::span<const std::byte> bytes) const {
  std::vector<std::byte> all(key_.begin(), key_.end());
  all.insert(all.end(), bytes.begin(), bytes.end());
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  unsigned size = 0;
  if (::EVP_Digest(all.data(), all.size(), hash.data(), &size, ::EVP_sha256(), nullptr) != 1) {
    throw Failure("SHA-256 isn't available");
  }
  std::array<std::byte, kSignatureBytes> first{};
  std::ranges::copy(std::as_bytes(std::span(hash)).first<kSignatureBytes>(), first.begin());
  return first;
}

Signing::Verdict Signing::check(const mavlink::Frame& frame, SigningTime now) {
  if (!frame.is_signed) {
    return Verdict::absent;
  }
  const auto [signed_bytes, signature] = std::pair(
      frame.bytes.first(frame.bytes.size() - kSignatureBytes), frame.bytes.last(kSignatureBytes));
  if (!std::ranges::equal(digest(signed_bytes), signature)) {
    return Verdict::wrong;
  }
  const std::span<const std::byte> link_and_time = signed_bytes.last(1 + kTimeBytes);
  const SigningTime time = time_of(link_and_time.subspan(1));
  const StreamId id{frame.system, frame.component,
                    static_cast<std::uint8_t>(link_and_time.front())};
  const auto known = streams_.find(id);
  newest_ = std::max(newest_, now);
  const bool is_old =
      known == streams_.end() ? time + kTuning.oldest_signature < newest_ : time <= known->second;
  if (is_old) {
    return Verdict::old;
  }
  if (known == streams_.end() && streams_.size() == kTuning.most_streams) {
    return Verdict::crowded;
  }
  streams_[id] = time;
  newest_ = std::max(newest_, time);
  return Verdict::right;
}

void Signing::sign(std::vector<std::byte>& frame, SigningTime now) {
  newest_ = std::max(newest_ + 1, now);
  frame.push_back(kLink);
  for (std::size_t i = 0; i < kTimeBytes; ++i) {
    frame.push_back(static_cast<std::byte>(newest_ >> 8U * i & 0xFFU));
  }
  const auto signature = digest(frame);
  frame.insert(frame.end(), signature.begin(), signature.end());
}

}  // namespace kelpie::autopilot
