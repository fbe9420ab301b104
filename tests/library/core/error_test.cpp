// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace kelpie::error_test {
namespace {

TEST(InputError, SaysWhereAsFarAsItIsKnown) {
  const auto text = [](const Place& place) { return std::string(InputError(place, "bad").what()); };
  EXPECT_EQ(text({.file = "log.csv", .line = 7, .field = "u"}), "log.csv:7: u: bad");
  EXPECT_EQ(text({.file = "log.csv", .line = 0, .field = "u"}), "log.csv: u: bad");
  EXPECT_EQ(text({.file = "", .line = 0, .field = "gamma"}), "gamma: bad");
  EXPECT_EQ(text({.file = "", .line = 3, .field = ""}), "line 3: bad");
  EXPECT_EQ(text({}), "bad");
}

TEST(InputError, DoesNotEndAtANulOfTheInput) {
  EXPECT_STREQ(InputError(std::string("\0name", 5), "bad").what(), "?name: bad");
}

TEST(InputError, NamesTheFileOnceWhereverItIsCaught) {
  const auto caught = [](const Place& place) {
    try {
      in_file("log.csv", [&] { throw InputError(place, "bad"); });
    } catch (const InputError& error) {
      EXPECT_EQ(error.message(), "bad");
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(caught({.file = "", .line = 7, .field = "u"}), "log.csv:7: u: bad");
  EXPECT_EQ(caught({.file = "other.csv", .line = 0, .field = "u"}), "other.csv: u: bad");
  EXPECT_EQ(in_file("log.csv", [] { return 3; }), 3);
}

}  // namespace
}  // namespace kelpie::error_test
