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

Json current_json(const Current& current) {
  return current.none() ? Json(nullptr)
                        : Json{{"heading", current.heading},   {"unit_rad", current.unit},
                               {"surge", current.surge},       {"sway", current.sway},
                               {"yaw_rate", current.yaw_rate}, {"targets", current.targets},
                               {"times_s", current.times_s},   {"velocity_m_s", current.velocity}};
}

Json alignment_json(const Alignment& alignment) {
  if (alignment.none()) {
    return nullptr;
  }
  Json json{{"shift_s", alignment.lag_s},
            {"rows", alignment.rows},
            {"commands", alignment.commands},
            {"actuators", actuators_json(alignment)}};
  if (!alignment.water.none()) {
    json["current"] = current_json(alignment.water);
  }
  return json;
}

}  // namespace kelpie::format
