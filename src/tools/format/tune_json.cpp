// SPDX-License-Identifier: Apache-2.0
#include "format/tune_json.hpp"

#include "file/json.hpp"

namespace kelpie::format {
namespace {

// Adds what the tuned settings are compared with.
void add_scores(file::Json& json, const study::TuneResult& result,
                const study::TuneScores& scores) {
  file::Json references = file::Json::object();
  for (std::size_t i = 0; i < result.references.size(); ++i) {
    references[result.references[i].first] = file::number(scores.references[i]);
  }
  json["base"] = file::number(scores.base);
  json["references"] = references;
  json["least_squares"] = file::number(scores.least_squares);
  json["mean"] = file::number(scores.mean);
}

file::Json tuned_axis_json(const study::TuneResult& result, const study::TunedAxis& axis) {
  file::Json json = {{"name", axis.name}, {"score", file::number(axis.score)}, {"rung", axis.rung}};
  add_scores(json, result, axis.all);
  return json;
}

file::Json evaluation_json(const study::Evaluation& one) {
  return {{"log", one.key.log},
          {"axis", one.key.axis},
          {"rung", one.key.rung},
          {"settings", one.key.settings},
          {"score", file::number(one.result.score)},
          {"stretches", file::numbers(one.result.stretches)},
          {"iterations_per_row", one.result.iterations_per_row},
          {"given_up", one.result.given_up}};
}

file::Json rung_json(const study::Rung& rung) {
  const auto window_json = [](const study::Window& window) {
    return file::Json{
        {"begin", window.begin}, {"judged_from", window.judged_from}, {"end", window.end}};
  };
  return {{"rows", rung.rows}, {"windows", file::list(rung.windows, window_json)}};
}

file::Json log_json(const study::TuneResult& result, std::size_t log) {
  const study::TunedLog& one = result.logs[log];
  const auto axis_json = [&](const study::TunedAxis& axis) {
    file::Json json = {{"name", axis.name}, {"score", file::number(axis.logs[log].tuned)}};
    add_scores(json, result, axis.logs[log]);
    return json;
  };
  return {{"name", one.name},
          {"rows", one.rows},
          {"axes", file::list(result.axes, axis_json)},
          {"rungs", file::list(one.rungs, rung_json)}};
}

}  // namespace

std::string tune_json(const study::TuneResult& result, const study::TuneJournal::Header& header) {
  const auto axis = [&](const study::TunedAxis& one) { return tuned_axis_json(result, one); };
  file::Json logs = file::Json::array();
  for (std::size_t log = 0; log < result.logs.size(); ++log) {
    logs.push_back(log_json(result, log));
  }
  const file::Json document = {{"format", "kelpie-tune"},
                               {"version", 2},
                               {"search", file::object(header)},
                               {"interrupted", result.interrupted},
                               {"tuned", file::object(result.tuned.values())},
                               {"axes", file::list(result.axes, axis)},
                               {"logs", logs},
                               {"evaluations", file::list(result.evaluations, evaluation_json)}};
  return file::json_text(document);
}

}  // namespace kelpie::format
