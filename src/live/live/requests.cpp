// SPDX-License-Identifier: Apache-2.0
#include "live/requests.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "kelpie/core/error.hpp"

namespace kelpie::live {
namespace {

constexpr std::array<std::pair<std::string_view, Request>, 4> kNames{{{"save", Request::save},
                                                                      {"freeze", Request::freeze},
                                                                      {"resume", Request::resume},
                                                                      {"reset", Request::reset}}};

}  // namespace

Request parse_request(std::string_view text, std::string_view field) {
  for (const auto& [name, request] : kNames) {
    if (text == name) {
      return request;
    }
  }
  throw InputError(std::string(field), "must be save, freeze, resume or reset");
}

std::string_view request_name(Request request) {
  return kNames[static_cast<std::size_t>(request)].first;
}

void Requests::push(Request request) {
  const std::lock_guard lock(mutex_);
  if (request == Request::freeze || request == Request::resume) {
    std::erase(waiting_, request == Request::freeze ? Request::resume : Request::freeze);
  }
  if (std::ranges::count(waiting_, request) == 0) {
    waiting_.push_back(request);
  }
}

std::optional<Request> Requests::pop() {
  const std::lock_guard lock(mutex_);
  if (waiting_.empty()) {
    return std::nullopt;
  }
  const Request first = waiting_.front();
  waiting_.erase(waiting_.begin());
  return first;
}

}  // namespace kelpie::live
