// SPDX-License-Identifier: Apache-2.0
#include "web/access.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "kelpie/core/error.hpp"

namespace kelpie::web {
namespace {

constexpr std::string_view kScheme = "http://";
constexpr std::string_view kBearer = "Bearer ";

bool is_digit(char c) {
  return '0' <= c && c <= '9';
}

// "localhost:8080" without its port.
std::string_view name_of(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  if (colon != std::string_view::npos && colon + 1 < host.size() &&
      std::ranges::all_of(host.substr(colon + 1), is_digit)) {
    host = host.substr(0, colon);
  }
  return host;
}

// Names and addresses that never leave the machine.
bool is_own_name(std::string_view host) {
  const std::string_view name = name_of(host);
  if (name == "localhost" || name == "[::1]") {
    return true;
  }
  return name.starts_with("127.") && std::ranges::count(name, '.') == 3 &&
         std::ranges::all_of(name, [](char c) { return is_digit(c) || c == '.'; });
}

// By the browser's word; programs send neither header.
bool is_of_another_page(const AccessRequest& asked) {
  const bool has_own_origin = asked.origin.starts_with(kScheme) && !asked.host.empty() &&
                              std::string_view(asked.origin).substr(kScheme.size()) == asked.host;
  const bool is_own_site = asked.site == "same-origin" || asked.site == "none";
  return (!asked.origin.empty() && !has_own_origin) || (!asked.site.empty() && !is_own_site);
}

}  // namespace

Access::Access(std::string token, std::uint16_t port)
    : token_(std::move(token)), cookie_name_(fmt::format("kelpie_{}", port)) {}

AccessDecision Access::decide(const AccessRequest& asked) const {
  if (asked.changes_state && is_of_another_page(asked)) {
    return AccessDecision::foreign_page;
  }
  if (token_.empty()) {
    return is_own_name(asked.host) ? AccessDecision::granted : AccessDecision::unknown_host;
  }
  if (is_token(asked.token)) {
    return asked.changes_state ? AccessDecision::granted : AccessDecision::granted_by_query;
  }
  const std::string_view authorization = asked.authorization;
  if (authorization.starts_with(kBearer) && is_token(authorization.substr(kBearer.size()))) {
    return AccessDecision::granted;
  }
  for (std::string_view left = asked.cookie; !left.empty();) {
    const std::string_view one = left.substr(0, left.find(';'));
    left.remove_prefix(std::min(left.size(), one.size() + 1));
    const std::size_t begin = std::min(one.find_first_not_of(' '), one.size());
    const std::size_t equals = one.find('=', begin);
    if (equals != std::string_view::npos && one.substr(begin, equals - begin) == cookie_name_ &&
        is_token(one.substr(equals + 1))) {
      return AccessDecision::granted;
    }
  }
  return AccessDecision::no_token;
}

std::string Access::cookie() const {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", cookie_name_, token_);
}

// In constant time, whatever part of the text is right.
bool Access::is_token(std::string_view text) const {
  unsigned differing = text.size() == token_.size() ? 0 : 1;
  for (std::size_t i = 0; i < text.size() && i < token_.size(); ++i) {
    differing |= static_cast<unsigned char>(text[i]) ^ static_cast<unsigned char>(token_[i]);
  }
  return differing == 0 && !token_.empty();
}

std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw Failure("no token can be made: " + std::generic_category().message(errno));
  }
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

}  // namespace kelpie::web
