// SPDX-License-Identifier: Apache-2.0
#include "file/json.hpp"
#include "format/parameters.hpp"

namespace kelpie::format {
namespace {

using file::Json;
using file::number;

Json interval(double low, double high) {
  return {number(low), number(high)};
}

Json parameter_json(const study::Identification& found, std::size_t place) {
  const FittedParameter& parameter = found.fit().parameters[place];
  Json json{{"name", parameter.name},
            {"unit", parameter_unit(found, place)},
            {"state", state_word(parameter.state)}};
  if (parameter.state != ParameterState::not_told) {
    const double half = half_width90(parameter);
    json["value"] = number(parameter.value);
    json["error"] = number(parameter.error);
    json["interval90"] = interval(parameter.value - half, parameter.value + half);
  }
  return json;
}

Json correlations_json(const study::Identification& found) {
  const std::vector<std::size_t> told = identified_places(found);
  return {{"names",
           file::list(told, [&](std::size_t i) { return Json(found.fit().parameters[i].name); })},
          {"matrix", file::list(told, [&](std::size_t a) {
             return file::list(
                 told, [&](std::size_t b) { return number(found.fit().correlation(a, b)); });
           })}};
}

}  // namespace

std::string parameters_json(const study::Identification& found, Frame frame) {
  Json json{{"format", kParametersFormat},
            {"version", kParametersVersion},
            {"log", found.source},
            {"frame", found.six || frame == Frame::frd ? "FRD" : "FLU"},
            {"training_rows", found.training_rows},
            {"split", found.split},
            {"scale", scale_text(found)},
            {"misfit", number(found.fit().misfit)}};
  if (found.mass_kg) {
    json["mass_kg"] = *found.mass_kg;
  }
  if (!found.held_out.times_s.empty()) {
    Json& scores = json["held_out_r2"] = Json::object();
    for (std::size_t axis = 0; axis < found.targets.size(); ++axis) {
      scores[found.targets[axis]] = {{"vehicle", number(found.held_out.r2[axis])},
                                     {"same_terms_untied", number(found.held_out.free_r2[axis])}};
    }
  }
  json["actuators"] = file::list(found.lags, [](const LagInterval& lag) {
    return Json{{"command", lag.command},
                {"unit", "s"},
                {"lag", lag.lag_s},
                {"interval90", interval(lag.low_s, lag.high_s)}};
  });
  Json& parameters = json["parameters"] = Json::array();
  for (std::size_t i = 0; i < found.fit().parameters.size(); ++i) {
    parameters.push_back(parameter_json(found, i));
  }
  json["correlations"] = correlations_json(found);
  return file::json_text(json);
}

}  // namespace kelpie::format
