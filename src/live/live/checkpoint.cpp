// SPDX-License-Identifier: Apache-2.0
#include "live/checkpoint.hpp"

#include <algorithm>
#include <utility>

#include "file/json.hpp"
#include "format/model_json.hpp"
#include "format/run_checkpoint.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/kelpie.h"
#include "model/model_axis.hpp"

namespace kelpie::live {
namespace {

format::RunIdentity identity_of(const Configuration& configuration, const Alignment& alignment) {
  return {.kelpie = kelpie_version(),
          .source = "live",
          .units = {},
          .run = configuration.identity(),
          .settings = configuration.settings.values(),
          .inputs = configuration.plan.inputs,
          .targets = configuration.plan.targets,
          .alignment = alignment,
          .scale_given = false};
}

// Earlier checkpoints do not tell some fields. In these the fields have their usual values.
void leave_out_untold(const std::string& header, format::RunIdentity& identity) {
  const file::Json told = file::json_or_discarded(header);
  const file::Json run =
      told.is_object() ? told.value("run", file::Json::object()) : file::Json::object();
  std::erase_if(identity.run, [&](const auto& field) {
    const auto& [key, value] = field;
    const bool is_usual = (key.starts_with("log.scale.") && value == "1") ||
                          (key == "log.armed_only" && value == "false") ||
                          (key == "log.vectors.attitude" && value.empty());
    return is_usual && run.is_object() && !run.contains(key);
  });
}

DynamicsModel fresh_model(const Configuration& configuration) {
  return {configuration.plan.inputs, configuration.plan.targets, configuration.settings};
}

void visit_time(Archive& archive, std::int64_t& time_ns) {
  // Doubled, an archive's whole numbers would reach only 2^53 ns, a hundred days.
  constexpr std::int64_t kPart = 1'000'000'000;
  std::int64_t s = time_ns / kPart;
  std::int64_t ns = time_ns % kPart;
  archive.whole(s, -(std::int64_t{1} << 40), std::int64_t{1} << 40);
  archive.whole(ns, -kPart, kPart);
  time_ns = s * kPart + ns;
}

}  // namespace

double LearningClock::at(double t) {
  if (has_begun_ && t + offset_ - last_ > kLongestPause) {
    offset_ = last_ - t;
  }
  has_begun_ = true;
  last_ = t + offset_;
  return last_;
}

void LearningClock::visit(Archive& archive) {
  archive.number(offset_);
  archive.number(last_);
  archive.flag(has_begun_);
}

void Progress::visit(Archive& archive) {
  visit_time(archive, origin_ns);
  visit_time(archive, received_ns);
  visit_time(archive, recording.origin_ns);
  archive.number(recording.end_s);
  archive.whole(rows);
  archive.whole(learned);
  archive.flag(is_paused);
  archive.text(doubt);
  archive.part("clock", clock);
}

void write_checkpoint(const std::filesystem::path& folder, const Configuration& configuration,
                      const SavedRun& run) {
  Archive archive;
  Progress progress = run.progress;
  progress.visit(archive);
  format::write_checkpoint(folder, format::pack_run(identity_of(configuration, run.alignment),
                                                    {.samples_shown = run.progress.learned,
                                                     .model = run.model,
                                                     .stream = archive.bytes(),
                                                     .file = {}}));
}

std::optional<SavedRun> find_checkpoint(const std::filesystem::path& folder,
                                        const Configuration& configuration) {
  const std::optional<format::FoundCheckpoint> found = format::find_checkpoint(folder);
  if (!found) {
    return std::nullopt;
  }
  const format::SavedModel saved = format::saved_model(*found);
  format::RunIdentity identity = identity_of(configuration, saved.alignment);
  leave_out_untold(found->checkpoint.header, identity);
  format::RunState state = format::unpack_run(*found, identity);
  SavedRun run{.progress = {},
               .alignment = saved.alignment,
               .model = std::move(state.model),
               .file = state.file,
               .note = found->passed_over};
  in_file(state.file, [&] {
    Archive archive(state.stream);
    run.progress.visit(archive);
    archive.finish();
  });
  return run;
}

study::Nominal nominal_of(const Configuration& configuration) {
  if (configuration.live.nominal.empty()) {
    return {};
  }
  return study::nominal_of(format::read_model(configuration.live.nominal),
                           configuration.plan.targets,
                           fresh_model(configuration).mechanisms(0).terms(), "--nominal");
}

DynamicsModel model_to_begin_with(const Configuration& configuration, const study::Nominal& nominal,
                                  const std::optional<SavedRun>& saved) {
  if (!saved) {
    DynamicsModel model = fresh_model(configuration);
    if (!nominal.empty()) {
      study::give(nominal, model);
    }
    return model;
  }
  return in_file(saved->file,
                 [&] { return DynamicsModel::resume(fresh_model(configuration), saved->model); });
}

}  // namespace kelpie::live
