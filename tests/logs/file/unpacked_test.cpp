// SPDX-License-Identifier: Apache-2.0
#include "file/unpacked.hpp"

#include <gtest/gtest.h>
#include <zlib.h>
#include <zstd.h>

#include <random>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::unpacked_test {
namespace {

using testing::message_of;

std::string gzip_of(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  std::string copy = text;
  stream.next_in = reinterpret_cast<Bytef*>(copy.data());     // NOLINT: bytes as text
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());  // NOLINT: bytes as text
  stream.avail_in = static_cast<uInt>(copy.size());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

std::string zstd_of(const std::string& text) {
  std::string packed(ZSTD_compressBound(text.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), text.data(), text.size(), 3));
  return packed;
}

std::string refusal(const std::string& content) {
  return message_of<InputError>([&] { file::unpacked(content, "log.csv.gz"); });
}

std::string long_text() {
  std::mt19937 random(19);
  std::string text = "u,v\n";
  while (text.size() < 1'000'000) {
    text += std::to_string(random()) + "," + std::to_string(random()) + "\n";
  }
  return text;
}

TEST(Unpacked, GivesBackWhatWasPacked) {
  for (const std::string& text :
       {std::string("u\n1\n"), std::string(), long_text(), std::string(5'000'000, 'u')}) {
    for (const std::string& packed : {gzip_of(text), zstd_of(text)}) {
      EXPECT_TRUE(file::unpacked(packed, "x") == text) << text.size();
      EXPECT_TRUE(file::unpacked(packed + packed, "x") == text + text) << text.size();
    }
    EXPECT_TRUE(file::unpacked(text, "x") == text);
  }
}

TEST(Unpacked, CutOffAnywhereIsNamed) {
  for (const std::string& packed : {gzip_of("u,v\n1,2\n3,4\n"), zstd_of("u,v\n1,2\n3,4\n")}) {
    for (std::size_t size = 4; size < packed.size(); ++size) {
      EXPECT_NE(refusal(packed.substr(0, size)).find("content is cut off"), std::string::npos)
          << size << " " << refusal(packed.substr(0, size));
    }
  }
  const std::string packed = gzip_of(long_text());
  EXPECT_EQ(refusal(packed.substr(0, packed.size() / 2)),
            "log.csv.gz: its gzip content is cut off");
}

TEST(Unpacked, DamageIsNamed) {
  for (std::string packed : {gzip_of(long_text()), zstd_of(long_text())}) {
    packed[packed.size() / 2] = static_cast<char>(~packed[packed.size() / 2]);
    packed[packed.size() / 2 + 9] = static_cast<char>(~packed[packed.size() / 2 + 9]);
    // zstd has a checksum only where it was asked for.
    if (packed.starts_with("\x1F\x8B")) {
      EXPECT_NE(refusal(packed).find("content is damaged"), std::string::npos) << refusal(packed);
    } else {
      refusal(packed);
    }
  }
  EXPECT_NE(refusal(gzip_of("u\n1\n") + "and more").find("is damaged"), std::string::npos);
  EXPECT_NE(refusal(zstd_of("u\n1\n") + "and more").find("is damaged"), std::string::npos);
}

// 300 MB of one letter.
TEST(Unpacked, WhatUnpacksWithoutEndIsRefused) {
  const std::string letters(10'000'000, 'u');  // NOLINT(bugprone-string-constructor)
  const std::string gzip_part = gzip_of(letters);
  const std::string zstd_part = zstd_of(letters);
  std::string gzip;
  std::string zstd;
  for (int k = 0; k < 30; ++k) {
    gzip += gzip_part;
    zstd += zstd_part;
  }
  EXPECT_NE(refusal(gzip).find("unpacks to more than 32 MB,"), std::string::npos);
  EXPECT_NE(refusal(zstd).find("unpacks to more than 32 MB,"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::unpacked_test
