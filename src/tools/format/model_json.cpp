// SPDX-License-Identifier: Apache-2.0
#include "format/model_json.hpp"

#include <cmath>
#include <vector>

#include "file/content.hpp"
#include "file/json.hpp"
#include "file/tuning.hpp"
#include "files/model_json.hpp"
#include "format/checkpoint_file.hpp"
#include "format/model_parts.hpp"
#include "format/steady_json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/unit.hpp"
#include "model/snapshot.hpp"

namespace kelpie::format {
namespace {

using file::Json;
using file::JsonNode;

std::vector<double> numbers(std::span<const double> values) {
  return {values.begin(), values.end()};
}

Json scaling_json(const AxisScaling& scaling) {
  const InputScaling& input = scaling.input;
  Json rows = Json::array();
  for (std::size_t row = 0; row < input.whitening.rows(); ++row) {
    rows.push_back(input.whitening.row(row));
  }
  return {{"input_mean", input.mean},
          {"whitening", rows},
          {"target_mean", scaling.target.mean},
          {"target_scale", scaling.target.scale},
          {"term_scale", scaling.term_scale}};
}

Json kernel_json(const MixedKernel& kernel) {
  return {{"type", "squared_exponential_and_terms"},
          {"gamma", kernel.local().gamma()},
          {"s", kernel.weights().s},
          {"fine", kernel.weights().fine},
          {"lambda", kernel.weights().lambda}};
}

Json rows_json(const SampleStore& samples) {
  Json rows = Json::array();
  std::vector<double> z(samples.dimension());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.get(i, z);
    rows.push_back(z);
  }
  return rows;
}

Json known_json(const KnownPlaces& known) {
  return {{"bandwidth", known.density.bandwidth()},
          {"sums", numbers(known.density.sums())},
          {"places", rows_json(known.samples)}};
}

Json member_json(const FunctionMix::Member& member) {
  return {{"name", member.name},
          {"share", member.share},
          {"kernel", kernel_json(member.function.kernel())},
          {"bias", member.function.bias()},
          {"term_weights", numbers(member.function.term_weights())},
          {"beta", numbers(member.function.beta())},
          {"support_vectors", rows_json(member.function.support_vectors())}};
}

Json range_json(const ValueRange& range) {
  return std::isfinite(range.low) ? Json{range.low, range.high} : Json(nullptr);
}

Json axis_json(const TrainedModel::Axis& axis) {
  const Limits& limits = axis.function.limits;
  return {{"target", axis.name},
          {"scaling", scaling_json(axis.scaling)},
          {"steady", steady_json(axis.steady)},
          {"kkt_gap", axis.kkt_gap},
          {"half_width", file::number(axis.half_width)},
          {"known", axis.known ? known_json(*axis.known) : Json(nullptr)},
          {"bounds", range_json({limits.low, limits.high})},
          {"caution", limits.caution},
          {"term_ranges", file::list(axis.function.term_ranges, range_json)},
          {"nominal", numbers(axis.function.nominal)},
          {"members", file::list(axis.function.members, member_json)}};
}

// A unit that cannot be read is named with its column.
ColumnUnits units_in(const JsonNode& node, const Json& json) {
  node.require(json.is_object(), "has to be an object of columns and units");
  ColumnUnits units;
  for (const auto& [column, unit] : json.items()) {
    units[column] = node[column].text();
    try {
      static_cast<void>(Unit::parse(units[column]));
    } catch (const InputError& error) {
      node[column].require(false, error.what());
    }
  }
  return units;
}

}  // namespace

ColumnUnits unit_texts(const std::map<std::string, Unit>& units) {
  ColumnUnits texts;
  for (const auto& [column, unit] : units) {
    texts.emplace(column, unit.text());
  }
  return texts;
}

std::string model_json(const TrainedModel& model, const ModelInfo& info) {
  Json json{{"format", kModelFormat},
            {"version", kModelVersion},
            {"inputs", model.input_names},
            {"settings", file::object(model.settings.values())},
            {"alignment", alignment_json(model.alignment)},
            {"axes", file::list(model.axes, axis_json)}};
  if (!info.learned.empty()) {
    json["learned"] = learned_json(info.learned);
  }
  if (!info.units.empty()) {
    json["units"] = info.units;
  }
  if (!info.doubt.empty()) {
    json["doubt"] = info.doubt;
  }
  return file::json_text(json, 1);
}

TrainedModel parse_model_json(const std::string& text, const std::string& source, ModelInfo* info) {
  const Json json = file::parse_json(text, source);
  TrainedModel model = trained_model(json, source);
  const JsonNode root(json, source, "");
  ModelInfo read{
      .units = json.contains("units") ? units_in(root["units"], json["units"]) : ColumnUnits{},
      .doubt = json.contains("doubt") ? root["doubt"].text() : "",
      .learned =
          json.contains("learned") ? read_learned(root["learned"]) : std::vector<LearnedLog>{}};
  if (info != nullptr) {
    *info = std::move(read);
  }
  return model;
}

TrainedModel read_model(const std::filesystem::path& file, ModelInfo* info) {
  std::error_code none;
  if (std::filesystem::exists(file, none) && is_checkpoint(file)) {
    throw InputError({.file = file.string(), .line = 0, .field = "file"},
                     "is a checkpoint, which `kelpie learn --from` goes on with; give the "
                     "model.json beside the checkpoint");
  }
  return parse_model_json(file::read_content(file, "a model.json as `kelpie learn` writes it",
                                             file::kTuning.document_bytes),
                          file.string(), info);
}

}  // namespace kelpie::format
