// SPDX-License-Identifier: Apache-2.0
#include "autopilot/signing.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "kelpie/core/error.hpp"
#include "mavlink/frame_writer.hpp"
#include "mavlink/frames.hpp"
#include "support.hpp"

namespace kelpie::signing_test {
namespace {

using autopilot::Signing;
using autopilot::SigningTime;
using testing::Bytes;
using testing::bytes_of_hex;
using Verdict = Signing::Verdict;

// SHA-256 of "secret", and an ATTITUDE that another implementation signed with this key:
// scripts/mavlink_peer.mjs write.
const std::string kKey = "2bb80d537b1da3e38bd30361aa855686bde0eacd7162fef6a25fe97bf527a25b";
const std::string kSigned =
    "fd1001000407091e0000d20400000000003f00000000000000c0809a0100e06f9e75196223fbd406a2";
constexpr SigningTime kSignedAt = 0x19759E6FE000;

Signing signing() {
  autopilot::SigningKey key{};
  std::ranges::copy(bytes_of_hex(kKey), key.begin());
  return Signing(key);
}

Verdict verdict(Signing& by, const Bytes& bytes, SigningTime now) {
  mavlink::FrameParser parser;
  mavlink::Frame frame;
  parser.add(bytes);
  return parser.next(frame) ? by.check(frame, now) : Verdict::wrong;
}

Bytes written(std::uint8_t system, mavlink::FrameWriter::Signer signer = {}) {
  mavlink::FrameWriter writer(system, 9, std::move(signer));
  const auto frame = writer.begin("ATTITUDE").set("roll", 0.5).finish();
  return {frame.begin(), frame.end()};
}

Bytes signed_at(Signing& by, std::uint8_t system, SigningTime time) {
  return written(system, [&](Bytes& frame) { by.sign(frame, time); });
}

TEST(Signing, KnowsAnotherImplementationsSignature) {
  Signing ours = signing();
  EXPECT_EQ(verdict(ours, bytes_of_hex(kSigned), kSignedAt), Verdict::right);
  Signing others({});
  EXPECT_EQ(verdict(others, bytes_of_hex(kSigned), kSignedAt), Verdict::wrong);
}

// `scripts/mavlink_peer.mjs hear` says of these bytes that the key of "secret" signed them.
TEST(Signing, SignsAsAnotherImplementationReads) {
  Signing ours = signing();
  EXPECT_EQ(signed_at(ours, 7, kSignedAt),
            bytes_of_hex("fd0801000007091e0000000000000000003f8e1a0000e06f9e75195ecfab7dc575"));
}

TEST(Signing, AnyChangeOfAFrameIsFound) {
  const Bytes good = bytes_of_hex(kSigned);
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes bad = good;
      bad[at] ^= std::byte{1} << bit;
      Signing ours = signing();
      EXPECT_NE(verdict(ours, bad, kSignedAt), Verdict::right) << at;
    }
  }
  Signing ours = signing();
  EXPECT_EQ(verdict(ours, written(1), kSignedAt), Verdict::absent);
  EXPECT_EQ(verdict(ours,
                    bytes_of_hex("fe1c0307091ed20400000000003f00000000000000c0"
                                 "000000000000000000000000bf69"),
                    kSignedAt),
            Verdict::absent);
}

TEST(Signing, TheTimesOfASenderOnlyGrow) {
  Signing vehicle = signing();
  const Bytes first = signed_at(vehicle, 1, kSignedAt);
  const Bytes second = signed_at(vehicle, 1, kSignedAt);  // a clock that stands still
  Signing ours = signing();
  EXPECT_EQ(verdict(ours, first, kSignedAt), Verdict::right);
  EXPECT_EQ(verdict(ours, second, kSignedAt), Verdict::right);
  EXPECT_EQ(verdict(ours, second, kSignedAt), Verdict::old);
  EXPECT_EQ(verdict(ours, first, kSignedAt), Verdict::old);
  // Of a new sender a minute is the most.
  constexpr SigningTime kMinute = 6'000'000;
  const Bytes other = signed_at(vehicle, 2, kSignedAt + 2);
  Signing later = signing();
  EXPECT_EQ(verdict(later, other, kSignedAt + 3 + kMinute), Verdict::old);
  EXPECT_EQ(verdict(later, other, kSignedAt + 2 + kMinute), Verdict::old) << "now stays";
  Signing in_time = signing();
  EXPECT_EQ(verdict(in_time, other, kSignedAt + 2 + kMinute), Verdict::right);
}

TEST(Signing, SendersAreBounded) {
  Signing vehicle = signing();
  Signing ours = signing();
  std::size_t heard = 0;
  for (int system = 1; system < 256; ++system) {
    const Bytes frame = signed_at(vehicle, static_cast<std::uint8_t>(system), kSignedAt);
    heard += verdict(ours, frame, kSignedAt) == Verdict::right ? 1 : 0;
  }
  EXPECT_EQ(heard, 16U);
  EXPECT_EQ(verdict(ours, signed_at(vehicle, 1, kSignedAt), kSignedAt), Verdict::right);
}

TEST(Signing, AKeyHas64Digits) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "k", kKey + "\n");
  EXPECT_EQ(autopilot::read_signing_key(folder / "k")[1], std::byte{0xb8});
  for (const std::string& wrong : {std::string(), kKey + "0", kKey.substr(1), "x" + kKey.substr(1),
                                   "+" + kKey.substr(1), std::string("secret")}) {
    testing::write_text(folder / "k", wrong);
    EXPECT_NE(testing::message_of<InputError>([&] {
                autopilot::read_signing_key(folder / "k");
              }).find("64 hexadecimal digits"),
              std::string::npos);
  }
  EXPECT_THROW(autopilot::read_signing_key(folder / "none"), InputError);
}

}  // namespace
}  // namespace kelpie::signing_test
