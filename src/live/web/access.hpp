// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kelpie::web {

/// Parts of a request that decide about access; empty: absent.
struct AccessRequest {
  bool changes_state = false;   ///< a button, not a look
  std::string host{};           ///< header Host
  std::string origin{};         ///< header Origin: the sending page
  std::string site{};           ///< header Sec-Fetch-Site: the sending page beside this one
  std::string token{};          ///< of the query
  std::string cookie{};         ///< header Cookie
  std::string authorization{};  ///< header Authorization
};

enum class AccessDecision : std::uint8_t {
  granted,
  granted_by_query,  ///< the token came with the query; the answer sets a cookie
  unknown_host,      ///< the host name is not this machine's: possibly a foreign page's
  foreign_page,      ///< a button on another page
  no_token,
};

/// Access rules of the page. Without a token: any client that uses a loopback name of this machine
/// (a foreign page's own name would stand in Host). With a token: any client with the token in the
/// query, in a cookie, or as "Authorization: Bearer". Buttons work on the page itself and for
/// programs, not on other pages.
class Access {
 public:
  /// The cookie's name includes the port, for cookies ignore ports. `token` may be empty.
  Access(std::string token, std::uint16_t port);

  AccessDecision decide(const AccessRequest& asked) const;
  const std::string& token() const { return token_; }
  std::string cookie() const;  ///< For Set-Cookie.

 private:
  bool is_token(std::string_view text) const;

  std::string token_;
  std::string cookie_name_;
};

/// 128 random bits in hexadecimal. Throws Failure without random numbers of the system.
std::string new_token();

}  // namespace kelpie::web
