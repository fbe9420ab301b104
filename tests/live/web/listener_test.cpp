// SPDX-License-Identifier: Apache-2.0
#include "web/listener.hpp"

#include <gtest/gtest.h>

#include "kelpie/core/error.hpp"

namespace kelpie::listener_test {
namespace {

TEST(Listener, ItIsKnownWhatLeavesTheMachine) {
  for (const char* const host : {"127.0.0.1", "127.3.2.1", "::1", "localhost"}) {
    EXPECT_TRUE(web::is_loopback(host, "x")) << host;
  }
  for (const char* const host : {"0.0.0.0", "::", "10.0.0.2"}) {
    EXPECT_FALSE(web::is_loopback(host, "x")) << host;
  }
  EXPECT_THROW(web::is_loopback("no such host", "x"), InputError);
}

}  // namespace
}  // namespace kelpie::listener_test
