// SPDX-License-Identifier: Apache-2.0
#include "format/steady_json.hpp"

namespace kelpie::format {

using file::Json;

Json steady_json(const SteadyModel& steady) {
  if (!steady.ready()) {
    return nullptr;
  }
  return {{"weights", steady.weights},
          {"error", steady.error},
          {"error_time_s", steady.error_time_s},
          {"noise", steady.noise},
          {"share", steady.share},
          {"off", steady.off},
          {"kept", steady.kept},
          {"seen", file::list(steady.seen, [](const Extremes& range) {
             return Json{range.low, range.high};
           })}};
}

}  // namespace kelpie::format
