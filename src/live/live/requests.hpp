// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string_view>

#include "live/tuning.hpp"

namespace kelpie::live {

/// An operator's request to the learner.
enum class Request : std::uint8_t {
  save,    ///< write checkpoint and model.json now
  freeze,  ///< keep the model as it is and go on predicting, after a restart too
  resume,  ///< learn again
  reset,   ///< start without a model; the alignment of commands stays
};

/// Reads "save", "freeze", "resume" or "reset". Throws InputError (field) on any other text.
Request parse_request(std::string_view text, std::string_view field);
std::string_view request_name(Request request);

/// Queue of requests to the engine, for any thread. Outputs report the result.
class Requests {
 public:
  static constexpr std::size_t kMost = kTuning.queued_requests;  ///< further requests are dropped

  bool push(Request request);    ///< False where the queue is full.
  std::optional<Request> pop();  ///< The oldest request, if any.

 private:
  std::mutex mutex_;
  std::deque<Request> waiting_;
};

}  // namespace kelpie::live
