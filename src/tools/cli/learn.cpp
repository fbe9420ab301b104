// SPDX-License-Identifier: Apache-2.0
#include "study/learn.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "file/descriptor.hpp"
#include "format/memory_json.hpp"
#include "format/model_json.hpp"
#include "format/result_json.hpp"
#include "format/run_checkpoint.hpp"
#include "identify/six_axis_fit.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"
#include "motion/signal_names.hpp"
#include "motion/states.hpp"
#include "posterior/tuning.hpp"
#include "report/html.hpp"
#include "report/table.hpp"
#include "report/verdict.hpp"
#include "simulator/scenario_file.hpp"
#include "study/nominal.hpp"
#include "study/six_axes.hpp"
#include "study/split.hpp"

namespace kelpie::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDraftName = "log.toml";

struct LearnArguments : PlanOptions {
  std::string from;
  Words nominal;
  std::string frame;
  std::string scales = "first";
  std::size_t validate_every = 0;
  std::size_t checkpoint_every = 0;
  bool resume = false;
  std::string memory;
  std::string out = "out/learn";
  AnswerOptions answer;
};

// The default --out is where the model of the run before is likely to lie.
void refuse_to_replace_start(const LearnArguments& options) {
  std::error_code none;  // where there is no such folder yet
  for (const char* const name :
       {"model.json", format::kCheckpointName, format::kPreviousCheckpointName}) {
    if (!options.from.empty() && fs::equivalent(options.from, fs::path(options.out) / name, none)) {
      throw InputError(
          {.file = options.from, .line = 0, .field = "--from"},
          "would be overwritten by the new model; choose another folder, as in --out " +
              options.out + "_next");
    }
  }
}

// Two options may not both say what a run begins with.
void require_one_start(const LearnArguments& options) {
  if (!options.from.empty() && options.scales != "first") {
    throw InputError("--scales", "is fixed by the model of --from; remove --scales");
  }
  if (!options.from.empty() && !options.memory.empty()) {
    throw InputError("--memory",
                     "searches the past models, --from names the model; give one of the two");
  }
  if (!options.from.empty() && !options.nominal.empty()) {
    throw InputError("--nominal",
                     "is the start of a new model, --from goes on with an earlier "
                     "model; give one of the two");
  }
  static_cast<void>(body_frame(options.frame, false));
  const bool turns = std::ranges::any_of(
      options.nominal, [](const auto& file) { return fs::path(file).extension() == ".toml"; });
  require(options.frame.empty() || turns, "--frame",
          "says how a vehicle file of --nominal is turned; there is none");
  refuse_to_replace_start(options);
}

// What is known of the vehicle before the log, of one file.
study::Nominal nominal_of(const std::string& file, const LearnArguments& options,
                          const study::LearnPlan& plan) {
  const log::Dataset& data = plan.data;
  const SharedSettings& settings = plan.settings.shared;
  const TermSet terms = TermSet::from(settings.terms, data.input_names, data.target_names.size());
  if (fs::path(file).extension() != ".toml") {
    return study::nominal_of(format::read_model(file), data.target_names, terms, "--nominal");
  }
  const std::size_t states =
      find_states(settings.states, data.input_names, data.target_names.size()).size();
  const double neutral = plan.alignment.alignment.actuators.empty() ? kNeutralPulseUs : 0.0;
  return study::nominal_of(simulator::read_vehicle(file), data, settings.states, terms,
                           body_frame(options.frame, states == kSixAxes), neutral);
}

// Of all files together.
void give_nominal(const LearnArguments& options, const study::LearnPlan& plan,
                  DynamicsModel& model) {
  std::vector<study::Nominal> all;
  for (const std::string& file : options.nominal) {
    all.push_back(nominal_of(file, options, plan));
  }
  study::give(study::mean_of(all), model);
}

std::vector<AxisScaling> saved_scales(const std::string& file, const log::Dataset& data) {
  const TrainedModel model = format::read_model(file);
  std::vector<AxisScaling> scales;
  const std::vector<std::string> targets = model.target_names();
  for (const TrainedModel::Axis& axis : model.axes) {
    scales.push_back(axis.scaling);
  }
  if (model.input_names != data.input_names || targets != data.target_names) {
    throw InputError({.file = file, .line = 0, .field = "--scales"},
                     "is a model of " + join_text(model.input_names, ",") + " → " +
                         join_text(targets, ",") + "; this log is read as " +
                         join_text(data.input_names, ",") + " → " +
                         join_text(data.target_names, ","));
  }
  return scales;
}

// All logs that the model will have learned, in this run (`now`) and before; none where an
// earlier log isn't known (--from a file without them, a --memory with past models), or no row is
// held out.
std::vector<format::LearnedLog> all_learned(const LearnArguments& options,
                                            const format::Origin* from,
                                            const std::vector<format::LearnedLog>& now) {
  if (!options.memory.empty() && fs::exists(options.memory)) {
    return {};
  }
  std::vector<format::LearnedLog> logs;
  if (from != nullptr) {
    logs = from->learned();
    if (logs.empty()) {
      return {};
    }
  }
  logs.insert(logs.end(), now.begin(), now.end());
  const bool holds_out =
      std::ranges::any_of(logs, [](const auto& log) { return !log.held_out.empty(); });
  return holds_out ? logs : std::vector<format::LearnedLog>{};
}

// Skips a file that no reader would accept (with a number out of range), and lets the run go on.
void warn_unless_readable(const std::string& what, const std::function<void()>& write) {
  try {
    write();
  } catch (const InputError& error) {
    warn("kelpie: {} is not written, because it could not be read back: {}\n", what, error.what());
  }
}

// State of the earlier run in the out folder; the start where it left none.
format::RunState earlier_run(const std::string& folder, const format::RunIdentity& identity) {
  const std::optional<format::FoundCheckpoint> found = format::find_checkpoint(folder);
  if (!found) {
    warn("kelpie: {} holds no checkpoint; starting from the first sample\n", folder);
    return {};
  }
  if (!found->passed_over.empty()) {
    warn("kelpie: {}; resuming from {}\n", found->passed_over, found->file.string());
  }
  return format::unpack_run(*found, identity);
}

// The model as the run begins, past models included; nothing of `earlier` in it.
DynamicsModel first_model(const LearnArguments& options, const format::Origin* from,
                          study::LearnPlan& plan, bool resumes) {
  if (options.scales != "first" && options.scales != "train") {
    plan.given_scales = saved_scales(options.scales, plan.data);
  }
  require(options.scales == "first" || plan.settings.shared.learner == LearnerKind::svr, "--scales",
          "'learner = posterior' takes no scale; remove --scales, or add --set learner=svr");
  DynamicsModel model = from == nullptr ? study::make_model(plan)
                        : resumes       ? from->fresh(plan.settings)
                                        : from->model(plan.settings, plan.data.times_s.front());
  if (!options.nominal.empty()) {
    give_nominal(options, plan, model);
  }
  if (!options.memory.empty() && fs::exists(options.memory)) {
    format::read_memory(options.memory).give_to(model, plan.data, plan.settings, options.memory);
  }
  return model;
}

// Learns the log from the point where `earlier` stopped, with a checkpoint now and then.
study::StreamResult learn_with_progress(const LearnArguments& options, const study::LearnPlan& plan,
                                        DynamicsModel& model, const format::RunState& earlier,
                                        const format::RunIdentity& identity) {
  const InterruptGuard guard;
  ProgressBar progress("learning");
  study::StreamOptions stream;
  stream.validate_every = options.validate_every;
  stream.keep_going = [&](std::size_t shown) {
    progress.at(static_cast<double>(shown) / static_cast<double>(plan.split.training.size()));
    return !InterruptGuard::asked();
  };
  stream.save_every = options.checkpoint_every;
  stream.save = [&](std::size_t shown, const std::string& state) {
    warn_unless_readable(fmt::format("checkpoint after {} samples", shown), [&] {
      format::write_checkpoint(options.out,
                               format::pack_run(identity, {shown, model.save(), state, {}}));
    });
  };
  stream.resume = earlier.stream;
  stream.resume_file = earlier.file;
  return study::learn(plan, model, stream);
}

// The model as the checkpoint of the earlier run has it.
DynamicsModel resumed_model(DynamicsModel fresh, const format::RunState& earlier) {
  return in_file(earlier.file,
                 [&] { return DynamicsModel::resume(std::move(fresh), earlier.model); });
}

// Returns whether a model is among the results.
bool write_results(const fs::path& folder, const study::StreamResult& result,
                   const DynamicsModel& model, const std::vector<format::LearnedLog>& learned,
                   const PlannedLog& log, const std::vector<report::NextStep>& next) {
  file::FileSet files{{"result.json", format::result_json(result)},
                      {"report.html", report::report_html(result, next)},
                      {"model.json", std::nullopt}};
  if (model.ready()) {
    TrainedModel trained = model.trained();
    trained.alignment = result.alignment.alignment;
    const std::string text =
        format::model_json(trained, {format::unit_texts(log.plan.data.units), log.doubt, learned});
    warn_unless_readable("model.json", [&] {
      format::parse_model_json(text, "model.json");
      files["model.json"] = text;
    });
  }
  if (!log.draft.empty()) {
    files[kDraftName] = log.draft;
  }
  file::write_files_whole(folder, files);
  return files["model.json"].has_value();
}

// Adds to the file as it is now: another program may have written it since it was read.
void write_memory(const std::string& file, const format::PastModelsFile& run,
                  const ModelSettings& settings) {
  const file::FolderLock lock(file);
  format::PastModelsFile memory{
      .inputs = run.inputs, .units = run.units, .terms = run.terms, .axes = {}};
  if (fs::exists(file)) {
    memory = format::read_memory(file);
  }
  memory.add(run, settings, file);
  const std::string text = format::memory_json(memory);
  warn_unless_readable("memory", [&] {
    format::parse_memory_json(text, file);
    file::write_file_whole(file, text);
  });
}

file::OutFolder take_learn_folder(const LearnArguments& options, std::vector<std::string> read,
                                  bool has_draft) {
  std::vector<std::string> written{"result.json", "report.html", "model.json",
                                   format::kCheckpointName, format::kPreviousCheckpointName};
  if (has_draft) {
    written.emplace_back(kDraftName);
  }
  read.push_back(options.memory);
  return take_out_folder(options.out, written, read);
}

// The options of `kelpie plan`, which holds no rows out and knows no current; none where a column
// says which rows are held out, which would be an input there.
std::optional<std::string> planning_text(PlanOptions options) {
  if (!study::parse_split(options.split, options.seed).column.empty()) {
    return std::nullopt;
  }
  options.split = PlanOptions().split;
  options.seed = PlanOptions().seed;
  options.has_current = false;
  return options.learning_text(options.config);
}

// The log for the next commands; learned anew only where no other log follows, of other times.
// `draft`: file of the guessed configuration, or empty. A model's inputs are a choice, with which
// nothing is guessed.
report::LogWords words_of(const LearnArguments& options, const std::string& draft) {
  PlanOptions read = options;
  read.config = draft.empty() ? options.config : draft;
  report::LogWords words{.file = shell_word(options.log.source.path),
                         .learning = {},
                         .judging = {},
                         .reading = read.reading_text()};
  if (options.split != "none") {
    words.judging = read.judging_text(read.config);
  }
  if (options.more.empty()) {
    words.planning = planning_text(options);
    PlanOptions again = options;
    again.since_s.reset();
    std::string text = again.learning_text(options.config);
    for (const std::string& file : options.nominal) {
      text += " --nominal " + shell_word(file);
    }
    text += options.frame.empty() ? "" : " --frame " + options.frame;
    words.learning =
        text + (options.scales == "first" ? "" : " --scales " + shell_word(options.scales));
  }
  return words;
}

// What was written and what a user of a new model needs next.
Answer answer_of(const LearnArguments& options, const study::StreamResult& result, bool has_model,
                 bool has_draft, const std::vector<report::NextStep>& next) {
  const fs::path folder = options.out;
  const std::string model = (folder / "model.json").string();
  Answer answer{.verdict = report::verdict_text(result),
                .tables = options.answer.verbose ? report::result_table(result) : "",
                .document = options.answer.json ? format::result_json(result) : "",
                .files = {{"model", has_model ? model : "none"},
                          {"result", (folder / "result.json").string()},
                          {"report", (folder / "report.html").string()}},
                .next = {}};
  if (has_draft) {
    answer.files.emplace_back("config", (folder / kDraftName).string());
  }
  for (const report::NextStep& step : next) {
    answer.next.push_back(fmt::format("{}   ({})", step.command, step.purpose));
  }
  return answer;
}

[[noreturn]] void refuse_without_model(const study::LearnPlan& plan) {
  const std::size_t rows = plan.split.training.size();
  const bool has_scale = plan.settings.shared.learner == LearnerKind::svr;
  const int least =
      has_scale ? plan.settings.shared.warmup : static_cast<int>(kPosterior.first_rows);
  const char* const reason = has_scale ? " (setting 'warmup')" : "";
  throw InputError(
      {.file = plan.data.source},
      std::cmp_less(rows, least)
          ? fmt::format("nothing was learned: {} training rows are too few for a model, which "
                        "takes {}{}",
                        rows, least, reason)
          : fmt::format("nothing was learned: fewer than {}{} of {} training rows have inputs that "
                        "move and targets that can be believed",
                        least, reason, rows));
}

void learn(const LearnArguments& options) {
  options.answer.begin();
  require_one_start(options);
  const std::optional<format::Origin> origin =
      options.from.empty() ? std::nullopt : std::optional<format::Origin>(options.from);
  const format::Origin* const from = origin ? &*origin : nullptr;
  std::vector<std::string> read = options.files();
  read.insert(read.end(), {options.scales, options.from});
  read.insert(read.end(), options.nominal.begin(), options.nominal.end());
  if (!options.memory.empty()) {
    check_output("--memory", options.memory, read);
  }
  PlannedLog log = plan_log(options, from);
  study::LearnPlan& plan = log.plan;
  plan.scales = options.scales;
  plan.nominal = join_text(options.nominal, ", ");
  print_notes(plan.settings, log.config, options.set, options.scales != "first");
  const file::OutFolder folder = take_learn_folder(options, read, !log.draft.empty());
  const format::RunIdentity identity = format::identify_run(
      plan.data, plan.split, plan.settings,
      {.kelpie = KELPIE_VERSION,
       .seed = options.seed,
       .scales = plan.scales_text(),
       .scale_given = from != nullptr ? from->scale_given() : options.scales != "first",
       .align = options.align,
       .alignment = plan.alignment.alignment,
       .from = options.from,
       .nominal = plan.nominal,
       .validate_every = options.validate_every});
  const format::RunState earlier =
      options.resume ? earlier_run(options.out, identity) : format::RunState{};
  DynamicsModel model = first_model(options, from, plan, !earlier.model.empty());
  if (!earlier.model.empty()) {
    model = resumed_model(std::move(model), earlier);
  }
  const std::vector<format::LearnedLog> learned = all_learned(options, from, log.learned);
  const study::StreamResult result = learn_with_progress(options, plan, model, earlier, identity);
  std::vector<report::NextStep> next;
  if (model.ready() && report::is_poor(result)) {
    next =
        report::after_poor_model(shell_word(options.log.source.path), options.text(options.config));
  } else if (model.ready()) {
    const std::string draft = log.draft.empty() ? "" : (folder.path() / kDraftName).string();
    next = report::after_learning(result, words_of(options, draft),
                                  shell_word((folder.path() / "model.json").string()));
  }
  const bool has_model =
      write_results(folder.path(), result, model,
                    result.interrupted ? std::vector<format::LearnedLog>{} : learned, log, next);
  if (!options.memory.empty()) {
    write_memory(options.memory, format::PastModelsFile::of(model, plan.data, plan.settings),
                 plan.settings);
  }
  if (!model.ready() && !result.interrupted) {
    refuse_without_model(plan);
  }
  give(answer_of(options, result, has_model, !log.draft.empty(), next), options.answer);
}

}  // namespace

void add_learn(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "learn", "Learn a log as the vehicle drove, and judge what was learned", learn);
  options->log.add_to(*command);
  add_files(command, "more", options->more,
            "logs of the same columns, learned one after the other after the first");
  add_file(command, "--from", options->from,
           "go on with the model of an earlier run: its model.json or checkpoint.kelpie; "
           "columns, settings, scale and shift are as there");
  add_files(command, "--nominal", options->nominal,
            "what is known of the vehicle beforehand: a vehicle file (.toml), or model.json of "
            "earlier drives or of like vehicles; of several files the mean");
  add_frame_option(*command, options->frame);
  add_split_option(
      *command, options->split,
      "held-out rows: auto (blocks, or pieces where the log is short), blocks (every fifth "
      "of 400 rows), pieces (every fifth of 25), "
      "tail (the last fifth), random (a fifth; neighbours in time leak), "
      "column:NAME (rows with 1 in it), none (all rows are learned)");
  add_file(command, "--config", options->config, "TOML file with settings (see `kelpie config`)");
  add_set(command, options->set);
  add_seed(command, options->seed);
  command
      ->add_option("--scales", options->scales,
                   "where the scaling comes from: first (samples), train (all training rows), "
                   "or a model.json")
      ->capture_default_str()
      ->type_name("{first,train,FILE}");
  add_since_option(*command, options->since_s);
  add_align_option(*command, options->align);
  add_current_option(*command, *options);
  add_accept_option(*command, options->accept);
  command->add_option("--validate-every", options->validate_every,
                      "training samples between two validations; 0: 200 in all");
  command->add_option("--checkpoint-every", options->checkpoint_every,
                      "training samples between two checkpoints in the out folder; 0: none");
  command->add_flag("--resume", options->resume,
                    "go on from the checkpoint in the out folder; all else as it was");
  add_file(command, "--memory", options->memory,
           "file of past models: tried when the vehicle changes, and written again at "
           "the end (see `kelpie memory`)");
  add_out(command, options->out, "folder for result.json, report.html, model.json");
  options->answer.add_to(*command, "result.json");
  add_examples(command, "learn dive.csv --rate 4",
               "learn dive.bag --config vehicle.toml --split tail --out out/tail");
}

}  // namespace kelpie::cli
