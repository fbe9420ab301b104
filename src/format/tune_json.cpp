// SPDX-License-Identifier: Apache-2.0
#include "format/tune_json.hpp"

#include "file/json.hpp"

namespace kelpie::format {
namespace {

file::Json tuned_axis_json(const study::TuneResult& result, const study::TunedAxis& axis) {
  file::Json references = file::Json::object();
  for (std::size_t i = 0; i < result.references.size(); ++i) {
    references[result.references[i].first] = file::number(axis.references[i]);
  }
  return {{"name", axis.name},
          {"score", file::number(axis.score)},
          {"rung", axis.rung},
          {"references", references},
          {"least_squares", file::number(axis.least_squares)},
          {"mean", file::number(axis.mean)}};
}

file::Json evaluation_json(const study::Evaluation& one) {
  return {{"axis", one.key.axis},
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

}  // namespace

std::string tune_json(const study::TuneResult& result, const study::TuneJournal::Header& header) {
  const auto axis = [&](const study::TunedAxis& one) { return tuned_axis_json(result, one); };
  const file::Json document = {{"format", "kelpie-tune"},
                               {"version", 1},
                               {"search", file::object(header)},
                               {"interrupted", result.interrupted},
                               {"tuned", file::object(result.tuned.values())},
                               {"axes", file::list(result.axes, axis)},
                               {"rungs", file::list(result.rungs, rung_json)},
                               {"evaluations", file::list(result.evaluations, evaluation_json)}};
  return file::json_text(document);
}

}  // namespace kelpie::format
