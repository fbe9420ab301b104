// SPDX-License-Identifier: Apache-2.0
#include "web/access.hpp"

#include <gtest/gtest.h>

#include <set>

namespace kelpie::access_test {
namespace {

using web::Access;
using web::AccessDecision;
using web::AccessRequest;

const std::string kToken = "0123456789abcdef";

TEST(Access, WithoutATokenThisMachineIsKnownByItsOwnNamesOnly) {
  const Access access("", 8080);
  for (const char* const host : {"localhost", "localhost:8080", "127.0.0.1:8080", "127.0.0.1",
                                 "127.8.0.1:1", "[::1]:8080", "[::1]"}) {
    EXPECT_EQ(access.decide({.host = host}), AccessDecision::granted) << host;
  }
  for (const char* const host :
       {"", "evil.example:8080", "127.0.0.1.evil.example", "localhost.evil.example:8080",
        "127.evil.example.com", "127.0.0.1:x", "10.0.0.2:8080", "::1",
        "localhost:", "@localhost"}) {
    EXPECT_EQ(access.decide({.host = host}), AccessDecision::unknown_host) << host;
    EXPECT_EQ(access.decide({.changes_state = true, .host = host}), AccessDecision::unknown_host)
        << host;
  }
}

TEST(Access, ButtonsArePressedOnThePageItselfOrByWhoIsNoPage) {
  for (const bool has_token : {false, true}) {
    const Access access(has_token ? kToken : "", 8080);
    const auto press = [&](const std::string& origin, const std::string& host = "localhost:8080") {
      return access.decide({.changes_state = true,
                            .host = host,
                            .origin = origin,
                            .cookie = has_token ? "kelpie_8080=" + kToken : ""});
    };
    EXPECT_EQ(press("http://localhost:8080"), AccessDecision::granted);
    EXPECT_EQ(press(""), AccessDecision::granted);
    for (const char* const origin :
         {"http://evil.example", "http://localhost:8081", "null", "https://localhost:8080",
          "http://localhost:8080.evil.example", "localhost:8080", "http://"}) {
      EXPECT_EQ(press(origin), AccessDecision::foreign_page) << origin;
    }
    EXPECT_EQ(press("http://", ""), AccessDecision::foreign_page);
  }
}

// A browser may say no more than this: a form of another page, at another port of this machine too.
TEST(Access, ABrowserThatNamesAnotherSiteAsTheSenderPressesNoButton) {
  const Access access("", 8080);
  for (const auto& [site, decision] :
       {std::pair("", AccessDecision::granted), std::pair("same-origin", AccessDecision::granted),
        std::pair("none", AccessDecision::granted),
        std::pair("cross-site", AccessDecision::foreign_page),
        std::pair("same-site", AccessDecision::foreign_page),
        std::pair("nonsense", AccessDecision::foreign_page)}) {
    EXPECT_EQ(access.decide({.changes_state = true, .host = "localhost:8080", .site = site}),
              decision)
        << site;
    EXPECT_EQ(access.decide({.host = "localhost:8080", .site = site}), AccessDecision::granted);
  }
}

TEST(Access, WithATokenOnlyWhoHasItSeesAnything) {
  const Access access(kToken, 8080);
  const std::string host = "kelpie.example:8080";
  EXPECT_EQ(access.decide({.host = host, .token = kToken}), AccessDecision::granted_by_query);
  EXPECT_EQ(access.decide({.changes_state = true, .host = host, .token = kToken}),
            AccessDecision::granted);
  EXPECT_EQ(access.decide({.host = host, .authorization = "Bearer " + kToken}),
            AccessDecision::granted);
  for (const std::string& cookie : {"kelpie_8080=" + kToken, "a=b; kelpie_8080=" + kToken,
                                    "a; ;kelpie_8080=" + kToken + "; b="}) {
    EXPECT_EQ(access.decide({.host = host, .cookie = cookie}), AccessDecision::granted) << cookie;
  }
  EXPECT_EQ(
      access.decide({.host = host, .cookie = access.cookie().substr(0, access.cookie().find(';'))}),
      AccessDecision::granted);
  const std::string wrong = "0123456789abcdeF";
  for (const AccessRequest& asked :
       {AccessRequest{.host = "localhost:8080"}, AccessRequest{.host = host, .token = wrong},
        AccessRequest{.host = host, .token = kToken + "0"},
        AccessRequest{.host = host, .token = kToken.substr(1)},
        AccessRequest{.host = host, .cookie = "kelpie_8081=" + kToken},
        AccessRequest{.host = host, .cookie = kToken},
        AccessRequest{.host = host, .cookie = "xkelpie_8080=" + kToken},
        AccessRequest{.host = host, .cookie = "kelpie_8080=" + wrong},
        AccessRequest{.host = host, .authorization = kToken},
        AccessRequest{.host = host, .authorization = "Bearer "}}) {
    EXPECT_EQ(access.decide(asked), AccessDecision::no_token);
  }
}

TEST(Access, TokensAreNewAndLong) {
  std::set<std::string> tokens;
  for (int i = 0; i < 20; ++i) {
    tokens.insert(web::new_token());
  }
  EXPECT_EQ(tokens.size(), 20U);
  EXPECT_EQ(tokens.begin()->size(), 32U);
}

}  // namespace
}  // namespace kelpie::access_test
