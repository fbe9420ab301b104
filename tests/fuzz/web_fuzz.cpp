// SPDX-License-Identifier: Apache-2.0
// libFuzzer's target for what of a request kelpie reads itself: Host, Origin, query, Cookie and
// Authorization, a line each (requests themselves are libmicrohttpd's to read). Nobody gets in who
// shows no token, or comes by another machine's name. CONTRIBUTING.md has the command.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "web/access.hpp"

namespace {

constexpr const char* kToken = "0123456789abcdef";

void require(bool holds) {
  if (!holds) {
    __builtin_trap();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using kelpie::web::AccessDecision;
  std::array<std::string, 6> lines;
  std::size_t line = 0;
  for (std::size_t i = 0; i < size && line < lines.size(); ++i) {
    if (data[i] == '\n') {
      ++line;
    } else {
      lines[line] += static_cast<char>(data[i]);
    }
  }
  const auto& [kind, host, origin, token, cookie, authorization] = lines;
  const kelpie::web::AccessRequest asked{.changes_state = !kind.empty(),
                                         .host = host,
                                         .origin = origin,
                                         .token = token,
                                         .cookie = cookie,
                                         .authorization = authorization};
  for (const char* const wanted : {"", kToken}) {
    const kelpie::web::Access access(wanted, 8080);
    const AccessDecision verdict = access.decide(asked);
    if (verdict != AccessDecision::granted && verdict != AccessDecision::granted_by_query) {
      continue;
    }
    require(!asked.changes_state || origin.empty() || origin == "http://" + host);
    if (*wanted == '\0') {
      require(host.starts_with("localhost") || host.starts_with("127.") ||
              host.starts_with("[::1]"));
    } else {
      require((token + cookie + authorization).find(kToken) != std::string::npos);
    }
  }
  return 0;
}
