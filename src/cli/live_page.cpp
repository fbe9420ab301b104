// SPDX-License-Identifier: Apache-2.0
#include "cli/live_page.hpp"

#include "cli/output.hpp"
#include "kelpie/core/error.hpp"
#ifdef KELPIE_WITH_WEB
#include "web/page.hpp"
#endif

namespace kelpie::cli {

std::unique_ptr<live::Output> page_of(const live::Configuration& configuration,
                                      [[maybe_unused]] live::Requests& requests) {
  if (configuration.live.page.empty()) {
    return nullptr;
  }
#ifdef KELPIE_WITH_WEB
  auto page = std::make_unique<web::Page>(configuration, requests);
  warn("kelpie: page: {}\n", page->address());
  return page;
#else
  throw InputError("live.page", "this kelpie was built without cpp-httplib and has no page");
#endif
}

}  // namespace kelpie::cli
