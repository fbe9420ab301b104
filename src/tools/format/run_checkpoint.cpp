// SPDX-License-Identifier: Apache-2.0
#include "format/run_checkpoint.hpp"

#include <fmt/format.h>

#include <span>

#include "core/text.hpp"
#include "file/crc32.hpp"
#include "file/json.hpp"
#include "files/model_json.hpp"
#include "format/model_parts.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"

namespace kelpie::format {
namespace {

using file::Json;

constexpr const char* kCheckpointFormat = "kelpie-checkpoint";
constexpr std::size_t kMostTargets = 64;

std::string checksum(const log::Dataset& data) {
  std::uint32_t sum = file::crc32_of(std::as_bytes(std::span(data.inputs)));
  sum = file::crc32_of(std::as_bytes(std::span(data.targets)), sum);
  sum = file::crc32_of(std::as_bytes(std::span(data.times_s)), sum);
  const std::vector<char> held_out(data.held_out.begin(), data.held_out.end());
  sum = file::crc32_of(std::as_bytes(std::span(held_out)), sum);
  return fmt::format("{:08x}", file::crc32_of(std::as_bytes(std::span(data.configurations)), sum));
}

// Names the first field that differs. A header of another form differs in all of them.
void require_same(const Json& header, const std::string& group, const RunIdentity::Fields& fields,
                  const std::string& file) {
  const Json theirs = header.value(group, Json::object());
  for (const auto& [name, value] : fields) {
    const bool told = theirs.contains(name) && theirs[name].is_string();
    const std::string there = told ? theirs[name].get<std::string>() : "not told";
    if (there != value) {
      throw InputError(
          {.file = file, .line = 0, .field = name},
          fmt::format("is '{}' there, '{}' in this run; a run goes on only as it began", there,
                      value));
    }
  }
}

RunState state_of(const FoundCheckpoint& found, const Json& header) {
  const auto whole = [&](const char* key) {
    return header.is_object() && header.contains(key) && header[key].is_number_unsigned()
               ? header[key].get<std::size_t>()
               : 0;
  };
  const std::string_view state = found.checkpoint.state;
  const std::size_t model = whole("model_bytes");
  if (!header.is_object() || header.value("format", Json()) != kCheckpointFormat ||
      model > state.size() || whole("stream_bytes") != state.size() - model) {
    throw InputError({.file = found.file.string(), .line = 0, .field = {}},
                     "is no checkpoint of a run");
  }
  return {whole("samples_shown"), std::string(state.substr(0, model)),
          std::string(state.substr(model)), found.file.string()};
}

}  // namespace

RunIdentity identify_run(const log::Dataset& data, const study::Split& split,
                         const ModelSettings& settings, const RunOptions& options) {
  RunIdentity identity{options.kelpie,
                       data.source,
                       {},
                       {},
                       settings.values(),
                       data.input_names,
                       data.target_names,
                       options.alignment,
                       options.scale_given};
  for (const auto& [column, unit] : data.units) {
    identity.units.emplace_back(column, unit.text());
  }
  identity.run = {{"inputs", join_text(data.input_names, ", ")},
                  {"targets", join_text(data.target_names, ", ")},
                  {"log.rows", std::to_string(data.rows())},
                  {"log.first_time_s", number_text(data.times_s.front())},
                  {"log.last_time_s", number_text(data.times_s.back())},
                  {"align", options.align},
                  {"log.checksum", checksum(data)},
                  {"split", split.label},
                  {"seed", std::to_string(options.seed)},
                  {"scales", options.scales},
                  {"from", options.from.empty() ? "the start" : options.from},
                  {"nominal", options.nominal.empty() ? "nothing" : options.nominal},
                  {"validate_every", std::to_string(options.validate_every)}};
  return identity;
}

Checkpoint pack_run(const RunIdentity& identity, const RunState& state) {
  const Json header = {{"format", kCheckpointFormat},
                       {"kelpie", identity.kelpie},
                       {"log", identity.source},
                       {"samples_shown", state.samples_shown},
                       {"units", file::object(identity.units)},
                       {"inputs", identity.inputs},
                       {"targets", identity.targets},
                       {"alignment", alignment_json(identity.alignment)},
                       {"scale_given", identity.scale_given},
                       {"run", file::object(identity.run)},
                       {"settings", file::object(identity.settings)},
                       {"model_bytes", state.model.size()},
                       {"stream_bytes", state.stream.size()}};
  return {file::json_text(header), state.model + state.stream};
}

RunState unpack_run(const FoundCheckpoint& found, const RunIdentity& identity) {
  const std::string file = found.file.string();
  const Json header = file::json_or_discarded(found.checkpoint.header);
  RunState state = state_of(found, header);
  require_same(header, "run", identity.run, file);
  require_same(header, "settings", identity.settings, file);
  return state;
}

SavedModel saved_model(const FoundCheckpoint& found) {
  const std::string file = found.file.string();
  const Json header = file::json_or_discarded(found.checkpoint.header);
  SavedModel saved{.state = state_of(found, header).model};
  const file::JsonNode root(header, file, "");
  saved.inputs = root["inputs"].names(kMostInputs);
  saved.targets = root["targets"].names(kMostTargets);
  saved.settings = read_settings(root["settings"], saved.targets.size());
  saved.alignment = read_alignment(root["alignment"], saved.inputs, saved.targets.size());
  saved.scale_given = root["scale_given"].json() == true;
  return saved;
}

}  // namespace kelpie::format
