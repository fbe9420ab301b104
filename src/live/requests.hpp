// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string_view>

namespace kelpie::live {

/// What an operator may ask of the learner while it runs.
enum class Request : std::uint8_t {
  save,    ///< checkpoint and model.json, now
  freeze,  ///< the model stays as it is and goes on predicting, also after a restart
  resume,  ///< learn again
  reset,   ///< begin anew, without a model; the shift of commands stays
};

/// "save", "freeze", "resume" or "reset". Throws InputError (field) on anything else.
Request parse_request(std::string_view text, std::string_view field);
std::string_view request_name(Request request);

/// Requests on their way to the engine: anybody may ask, in any thread. What comes of it is said to
/// the outputs.
class Requests {
 public:
  static constexpr std::size_t kMost = 64;  ///< that wait; a flood of them is dropped

  /// False where too many wait.
  bool push(Request request);
  /// The first that waits, if any.
  std::optional<Request> pop();

 private:
  std::mutex mutex_;
  std::deque<Request> waiting_;
};

}  // namespace kelpie::live
