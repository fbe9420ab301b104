// SPDX-License-Identifier: Apache-2.0

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/bag_options.hpp"
#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/learn_start.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/settings_notes.hpp"
#include "file/atomic_file.hpp"
#include "file/folder_lock.hpp"
#include "format/memory_json.hpp"
#include "format/model_json.hpp"
#include "format/result_json.hpp"
#include "format/run_checkpoint.hpp"
#include "kelpie/core/text.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "report/html.hpp"
#include "report/table.hpp"
#include "study/baselines.hpp"
#include "study/diagnosis.hpp"
#include "study/split.hpp"
#include "study/stream.hpp"

namespace kelpie::cli {
namespace {

constexpr const char* kDraftName = "log.toml";

format::RunIdentity identity_of(const LearnArguments& options, const log::Dataset& data,
                                const study::Split& split, const ModelSettings& settings,
                                const Alignment& alignment, bool scale_given) {
  return format::identify_run(data, split, settings,
                              {.kelpie = KELPIE_VERSION,
                               .seed = options.seed,
                               .scales = scales_text(options, settings),
                               .scale_given = scale_given,
                               .align = options.align,
                               .alignment = alignment,
                               .from = options.from,
                               .validate_every = options.validate_every});
}

// Nothing is written that couldn't be read again, and the run goes on: numbers can come that nobody
// has thought of.
void say_unless_readable(const std::string& what, const std::function<void()>& write) {
  try {
    write();
  } catch (const InputError& error) {
    warn("kelpie: {} isn't written, it couldn't be read again: {}\n", what, error.what());
  }
}

// Where an earlier run of the same kind stopped; the start, where it left nothing.
format::RunState earlier_run(const std::string& folder, const format::RunIdentity& identity) {
  const std::optional<format::FoundCheckpoint> found = format::find_checkpoint(folder);
  if (!found) {
    warn("kelpie: {} holds no checkpoint; starting from the first sample\n", folder);
    return {};
  }
  if (!found->passed_over.empty()) {
    warn("kelpie: {}; going on from {}\n", found->passed_over, found->file.string());
  }
  return format::unpack_run(*found, identity);
}

// Learns the log, from where `earlier` stopped.
study::StreamResult learn_log(const LearnArguments& options, const log::Dataset& data,
                              const study::Split& split, DynamicsModel& model,
                              const ModelSettings& settings, const format::RunState& earlier,
                              const format::RunIdentity& identity) {
  const InterruptGuard guard;
  ProgressBar progress("learning");
  study::StreamOptions stream;
  stream.validate_every = options.validate_every;
  stream.keep_going = [&](std::size_t shown) {
    progress.at(static_cast<double>(shown) / static_cast<double>(split.training.size()));
    return !InterruptGuard::asked();
  };
  stream.save_every = options.checkpoint_every;
  stream.save = [&](std::size_t shown, const std::string& state) {
    say_unless_readable(fmt::format("checkpoint after {} samples", shown), [&] {
      format::write_checkpoint(options.out,
                               format::pack_run(identity, {shown, model.save(), state, {}}));
    });
  };
  stream.resume = earlier.stream;
  study::StreamResult result = study::run_stream(data, split, model, stream);
  study::add_baselines(data, split, result);
  result.from = options.from;
  result.scales = scales_text(options, settings);
  result.seed = options.seed;
  result.memory_bytes = DynamicsModel::bytes(data.input_names, settings);
  result.settings = settings.values();
  result.diagnosis = study::diagnosis_of(model);
  return result;
}

// Whether there is a model among them.
bool write_results(const std::filesystem::path& folder, const study::StreamResult& result,
                   const DynamicsModel& model, const std::vector<format::LearnedLog>& learned,
                   const std::string& draft) {
  file::FileSet files{{"result.json", format::result_json(result)},
                      {"report.html", report::report_html(result)},
                      {"model.json", std::nullopt}};
  if (model.ready()) {
    TrainedModel trained = model.trained();
    trained.alignment = result.alignment.alignment;
    const std::string text = format::model_json(trained, learned);
    say_unless_readable("model.json", [&] {
      format::parse_model_json(text, "model.json");
      files["model.json"] = text;
    });
  }
  if (!draft.empty()) {
    files[kDraftName] = draft;
  }
  file::write_files_whole(folder, files);
  return files["model.json"].has_value();
}

// Others may have written the file since it was read.
void write_memory(const std::string& file, const format::PastModelsFile& run,
                  const ModelSettings& settings) {
  const file::FolderLock lock(file);
  format::PastModelsFile memory{.inputs = run.inputs, .units = run.units, .axes = {}};
  if (std::filesystem::exists(file)) {
    memory = format::read_memory(file);
  }
  memory.add(run, settings, file);
  const std::string text = format::memory_json(memory);
  say_unless_readable("memory", [&] {
    format::parse_memory_json(text, file);
    file::write_file_whole(file, text);
  });
}

void learn(const LearnArguments& options) {
  require_one_start(options);
  const std::optional<format::Origin> origin =
      options.from.empty() ? std::nullopt : std::optional<format::Origin>(options.from);
  const format::Origin* const from = origin ? &*origin : nullptr;
  const auto [data, split, settings, found, learned, config, draft] =
      open_split_log(options.log, {options.config, options.set, options.split, options.seed,
                                   options.align, options.units, options.more, from});
  print_notes(settings, config, options.set, options.scales != "first");
  std::vector<std::string> written{"result.json", "report.html", "model.json",
                                   format::kCheckpointName, format::kPreviousCheckpointName};
  if (!draft.empty()) {
    written.emplace_back(kDraftName);
  }
  const file::OutFolder folder = take_out_folder(options.out, written, files_read(options));
  if (!options.memory.empty()) {
    std::vector<std::string> others = files_read(options);
    others.pop_back();
    check_output("--memory", options.memory, others);
  }
  const bool scale_given = from != nullptr ? from->scale_given() : options.scales != "first";
  const format::RunIdentity identity =
      identity_of(options, data, split, settings, found.alignment, scale_given);
  const format::RunState earlier =
      options.resume ? earlier_run(options.out, identity) : format::RunState{};
  DynamicsModel model = from != nullptr && !earlier.model.empty()
                            ? from->fresh(settings)
                            : make_model(options, from, data, split, settings);
  const std::vector<format::LearnedLog> known = all_learned(options, learned);
  give_memory(options, data, settings, model);
  study::StreamResult result;
  try {
    if (!earlier.model.empty()) {
      model = DynamicsModel::resume(std::move(model), earlier.model);
    }
    result = learn_log(options, data, split, model, settings, earlier, identity);
  } catch (const InputError& error) {
    throw InputError({.file = earlier.file, .line = 0, .field = {}}, error.what());
  }
  result.alignment = found;
  const bool has_model =
      write_results(folder.path(), result, model,
                    result.interrupted ? std::vector<format::LearnedLog>{} : known, draft);
  if (!options.memory.empty()) {
    write_memory(options.memory, format::PastModelsFile::of(model, data), settings);
  }
  say("{}", report::result_table(result));
  say("model:  {}\nresult: {}\nreport: {}\n",
      has_model       ? (folder.path() / "model.json").string()
      : model.ready() ? "none"
                      : "none: too few samples to learn from",
      (folder.path() / "result.json").string(), (folder.path() / "report.html").string());
  if (!draft.empty()) {
    say("config: {}\n", (folder.path() / kDraftName).string());
  }
}

}  // namespace

void add_learn(CLI::App& app) {
  auto options = std::make_shared<LearnArguments>();
  CLI::App* const command =
      app.add_subcommand("learn", "Learn a log as the vehicle drove, and judge what was learned");
  options->log.add_to(*command);
  command
      ->add_option("more", options->more,
                   "logs of the same columns, learned one after the other after the first")
      ->type_name("FILE");
  command
      ->add_option("--from", options->from,
                   "go on with the model of an earlier run: its model.json or checkpoint.kelpie; "
                   "columns, settings, scale and shift are as there")
      ->type_name("FILE");
  add_split_option(
      *command, options->split,
      "held-out rows: auto (blocks, or pieces where the log is short), blocks (every fifth "
      "of 400 rows), pieces (every fifth of 25), "
      "tail (the last fifth), random (a fifth; neighbours in time leak), "
      "column:NAME (rows with 1 in it), none (all rows are learned)");
  command
      ->add_option("--units", options->units,
                   "units of columns for the report, as in u=m/s,th1=rev/s,udot=m/s^2")
      ->delimiter(',');
  command->add_option("--config", options->config, "TOML file with settings (see `kelpie config`)")
      ->type_name("FILE");
  command->add_option("--set", options->set, "key=value, over the file (repeatable)")
      ->type_name("SETTING");
  command->add_option("--seed", options->seed, "of the random split")->capture_default_str();
  command
      ->add_option("--scales", options->scales,
                   "where the scaling comes from: first (samples), train (all training rows), "
                   "or a model.json")
      ->capture_default_str()
      ->type_name("{first,train,FILE}");
  add_align_option(*command, options->align);
  command->add_option("--validate-every", options->validate_every,
                      "training samples between two validations; 0: 200 in all");
  command->add_option("--checkpoint-every", options->checkpoint_every,
                      "training samples between two checkpoints in the out folder; 0: none");
  command->add_flag("--resume", options->resume,
                    "go on from the checkpoint in the out folder; all else as it was");
  command
      ->add_option("--memory", options->memory,
                   "file of past models: tried when the vehicle changes, and written again at "
                   "the end (see `kelpie memory`)")
      ->type_name("FILE");
  command->add_option("--out", options->out, "folder for result.json, report.html, model.json")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->callback([options] { learn(*options); });
}

}  // namespace kelpie::cli
