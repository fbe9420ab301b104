// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kelpie::web {

/// What of a request decides whether it is answered; empty: it has no such thing.
struct AccessRequest {
  bool changes_state = false;   ///< a button: it changes something
  std::string host{};           ///< Host
  std::string origin{};         ///< Origin: the page that sends it, as browsers say
  std::string token{};          ///< of the query
  std::string cookie{};         ///< Cookie
  std::string authorization{};  ///< Authorization
};

/// What becomes of it.
enum class AccessDecision : std::uint8_t {
  granted,
  granted_by_query,  ///< the token came with the query: from now on a cookie has it
  unknown_host,      ///< by a name that isn't this machine's: another page may be behind it
  foreign_page,      ///< a button on another page
  no_token,
};

/// Who may look and press buttons. Without a token: whoever reaches this machine by one of its own
/// names (a foreign page can have a name of its own lead here, but that is then in Host). With a
/// token: whoever has it, in the query, in a cookie, or as "Authorization: Bearer". Buttons can
/// only be pressed on the page itself, or by who is no page.
class Access {
 public:
  /// The cookie's name has the port in it: cookies don't tell ports apart. `token` may be empty.
  Access(std::string token, std::uint16_t port);

  AccessDecision decide(const AccessRequest& asked) const;
  const std::string& token() const { return token_; }
  std::string cookie() const;  ///< For Set-Cookie.

 private:
  bool is_token(std::string_view text) const;

  std::string token_;
  std::string cookie_name_;
};

/// One that nobody guesses. Throws Failure where the system gives no random numbers.
std::string new_token();

/// Whether all addresses of a host are of the loopback interface. Throws InputError (field) where
/// it has none.
bool is_loopback(const std::string& host, const std::string& field);

}  // namespace kelpie::web
