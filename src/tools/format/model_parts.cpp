// SPDX-License-Identifier: Apache-2.0
#include "format/model_parts.hpp"

namespace kelpie::format {

using file::Json;

Json actuators_json(const Alignment& alignment) {
  Json list = Json::array();
  for (std::size_t k = 0; k < alignment.actuators.size(); ++k) {
    Json entry{{"command", alignment.commands[k]}};
    for (const Actuator::Field& field : Actuator::fields()) {
      entry[std::string(field.name)] = alignment.actuators[k].*field.number;
    }
    list.push_back(entry);
  }
  return list;
}

Json alignment_json(const Alignment& alignment) {
  return alignment.none() ? Json(nullptr)
                          : Json{{"shift_s", alignment.lag_s},
                                 {"rows", alignment.rows},
                                 {"commands", alignment.commands},
                                 {"actuators", actuators_json(alignment)}};
}

}  // namespace kelpie::format
