// SPDX-License-Identifier: Apache-2.0
#include "file/crc32c.hpp"

#include <gtest/gtest.h>

#include <string>

namespace kelpie::crc32c_test {
namespace {

// The values of RFC 3720, B.4, and of the CRC catalogue.
TEST(Crc32c, IsThatOfTheStandard) {
  EXPECT_EQ(file::crc32c(""), 0U);
  EXPECT_EQ(file::crc32c("123456789"), 0xE3069283U);
  EXPECT_EQ(file::crc32c(std::string(32, '\0')), 0x8A9136AAU);
  EXPECT_EQ(file::crc32c(std::string(32, '\xFF')), 0x62A8AB43U);
}

TEST(Crc32c, OfPartsIsThatOfTheWhole) {
  const std::string text = "the water horse changes its shape";
  for (std::size_t i = 0; i <= text.size(); ++i) {
    EXPECT_EQ(file::crc32c(text.substr(i), file::crc32c(text.substr(0, i))), file::crc32c(text))
        << i;
  }
}

}  // namespace
}  // namespace kelpie::crc32c_test
