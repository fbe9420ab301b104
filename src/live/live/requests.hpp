// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

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

/// Queue of requests to the engine, for any thread. Outputs report the result. A request joins an
/// equal request that waits; of freeze and resume the later request alone waits.
class Requests {
 public:
  void push(Request request);    ///< At most one save, one reset, and one freeze or resume wait.
  std::optional<Request> pop();  ///< The oldest request, if any.

 private:
  std::mutex mutex_;
  std::vector<Request> waiting_;
};

}  // namespace kelpie::live
