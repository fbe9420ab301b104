// SPDX-License-Identifier: Apache-2.0
#include "report/next_steps.hpp"

namespace kelpie::report {

std::vector<NextStep> after_learning(const std::string& log, const std::string& model) {
  return {{"kelpie rollout " + log + " --model " + model, "how the error grows in open loop"},
          {"kelpie predict LOG --model " + model, "predictions for another log"},
          {"kelpie learn LOG --from " + model, "goes on with another log of the vehicle"}};
}

}  // namespace kelpie::report
