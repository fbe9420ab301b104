// SPDX-License-Identifier: Apache-2.0
#include "study/tune.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "file/toml.hpp"
#include "format/settings_file.hpp"
#include "format/tune_json.hpp"
#include "jobs/make_executor.hpp"
#include "report/tune_report.hpp"
#include "report/verdicts.hpp"
#include "study/alignment.hpp"
#include "study/split.hpp"

namespace kelpie::cli {
namespace {

constexpr std::size_t kPaperAxes = 3;
constexpr const char* kJournalName = "journal.jsonl";

struct TuneArguments : PlanOptions {
  std::vector<std::string> search;
  std::optional<int> only;
  std::size_t candidates = study::TuneOptions{}.candidates;
  std::size_t threads = 0;
  double most_iterations = study::TuneOptions{}.most_iterations;
  std::string out = "out/tune";
  AnswerOptions answer;
};

// What is fixed isn't searched; a --search goes over the file, as a --set would.
study::SearchSpace make_space(const TuneArguments& options, const format::SettingsFile& file) {
  study::SearchSpace space = study::SearchSpace::standard();
  for (const auto& [name, value] : file.settings) {
    space.fix(name);
  }
  for (const std::string& text : options.search) {
    space.search(text);
  }
  for (const std::string& assignment : options.set) {
    const std::string name = format::key_and_value(assignment).first;
    for (const std::string& text : options.search) {
      if (trimmed(split_text(text, '=').front()) == name) {
        throw InputError({.file = "--search", .line = 0, .field = name},
                         "is fixed by --set " + assignment + "; give one of the two");
      }
    }
    space.fix(name);
  }
  if (space.empty()) {
    throw InputError({.file = "--search", .line = 0, .field = {}},
                     "nothing is left to search: every setting is fixed by --config or --set");
  }
  return space;
}

// The presets to compare with, as they are.
std::vector<std::pair<std::string, ModelSettings>> references(const ModelSettings& base) {
  std::vector<std::pair<std::string, ModelSettings>> list;
  for (const std::string_view preset : preset_names()) {
    if (preset != "paper" || base.axes.size() <= kPaperAxes) {
      list.emplace_back(preset, ModelSettings::from_preset(preset, base.axes.size()));
    }
  }
  return list;
}

// The logs to tune on, and what is said of each.
struct TuneLogs {
  std::vector<study::TuneLog> logs;
  format::SettingsFile config;
  std::string text;
};

// One of the logs; each is a stream of its own.
PlannedLog open_tune_log(const TuneArguments& options, const std::string& path) {
  PlanOptions one = options;
  one.log.source.path = path;
  one.more.clear();
  try {
    return plan_log(one);
  } catch (const InputError& error) {
    if (error.place().field == "states" && error.place().file.empty()) {
      throw InputError({.file = path, .field = "states"}, error.message());  // one of many logs
    }
    throw;
  }
}

TuneLogs open_tune_logs(const TuneArguments& options) {
  require(!options.since_s || options.more.empty(), "--since",
          "is a time of one log; give that log alone");
  TuneLogs opened;
  std::vector<std::string> paths{options.log.source.path};
  paths.insert(paths.end(), options.more.begin(), options.more.end());
  for (const std::string& path : paths) {
    PlannedLog log = open_tune_log(options, path);
    study::LearnPlan& plan = log.plan;
    std::vector<std::size_t> rows = study::training_rows(plan.data, plan.split, options.only);
    opened.text +=
        fmt::format("{}\n{} training rows of configuration {}; split: {}\n{}\n", plan.data.source,
                    rows.size(), plan.data.configurations[rows.front()], plan.split.label,
                    study::alignment_text(plan.alignment, plan.data.rate_hz));
    opened.config = std::move(log.config);
    opened.logs.push_back({std::move(plan.data), std::move(rows), plan.split.label});
  }
  return opened;
}

study::TuneProblem make_problem(const TuneArguments& options, TuneLogs opened) {
  const std::size_t targets = opened.logs.front().data.target_names.size();
  study::TuneProblem problem{.logs = std::move(opened.logs),
                             .base = format::make_settings(opened.config, options.set, targets),
                             .space = make_space(options, opened.config),
                             .references = {}};
  print_notes(problem.base, opened.config, options.set);
  problem.references = references(problem.base);
  problem.validate();
  return problem;
}

study::TuneOptions make_tuning(const TuneArguments& options) {
  study::TuneOptions tuning;
  tuning.candidates = options.candidates;
  tuning.seed = options.seed;
  tuning.most_iterations = options.most_iterations;
  tuning.validate();
  return tuning;
}

std::filesystem::path journal_file(const TuneArguments& options) {
  return std::filesystem::path(options.out) / kJournalName;
}

study::TuneResult search(const TuneArguments& options, const study::TuneProblem& problem,
                         study::TuneOptions& tuning, study::TuneJournal& journal,
                         jobs::Executor& executor) {
  if (journal.size() > 0) {
    warn("resuming with {} evaluations in {}\n", journal.size(), options.out);
  }
  ProgressBar progress("tuning");
  tuning.keep_going = [&](double share) {
    progress.at(share);
    return !InterruptGuard::asked();
  };
  return study::tune(problem, tuning, journal, executor);
}

// A log and the options of a `learn` with what was found: by the file `tuned`, or by --set where
// the [log] of --config is needed.
std::string learn_text(const TuneArguments& options, const ModelSettings& base,
                       const study::TuneResult& result, const std::string& tuned) {
  PlanOptions again = options;
  again.more.clear();  // streams of their own, perhaps of other rates
  if (options.config.empty() || !file::TomlNode::read(options.config).has("log")) {
    again.set.clear();  // the file has them
    return again.text(tuned);
  }
  const auto before = base.values();
  for (const auto& value : result.tuned.values()) {
    if (std::ranges::count(before, value) == 0) {
      again.set.push_back(value.first + "=" + value.second);
    }
  }
  return again.text(options.config);
}

void write_tuned(const TuneArguments& options, const std::string& logs_text,
                 const ModelSettings& base, const study::TuneResult& result,
                 const study::TuneJournal::Header& header) {
  const std::filesystem::path folder = options.out;
  const std::string document = format::tune_json(result, header);
  file::write_files_whole(folder, {{"tuned.toml", report::tuned_toml(result, header)},
                                   {"tune.json", document},
                                   {"tune.html", report::tune_html(result, header)}});
  const std::string tuned = (folder / "tuned.toml").string();
  give({.verdict = report::tune_verdict(result),
        .tables = logs_text + "\n" + report::tune_table(result),
        .document = document,
        .files = {{"tuned", tuned},
                  {"result", (folder / "tune.json").string()},
                  {"report", (folder / "tune.html").string()}},
        .next = {fmt::format("kelpie learn {}", learn_text(options, base, result, tuned))}},
       options.answer);
}

void run_tune(const TuneArguments& options) {
  options.answer.begin();
  const std::unique_ptr<jobs::Executor> executor = jobs::make_executor(options.threads);
  TuneLogs opened = open_tune_logs(options);
  const std::string logs_text = opened.text;
  const study::TuneProblem problem = make_problem(options, std::move(opened));
  study::TuneOptions tuning = make_tuning(options);
  const InterruptGuard guard;
  const file::OutFolder out = take_out_folder(
      options.out, {"tuned.toml", "tune.json", "tune.html", kJournalName}, options.files());
  const study::TuneJournal::Header header = study::journal_header(problem, tuning);
  study::TuneJournal journal(journal_file(options), header);
  const study::TuneResult result = search(options, problem, tuning, journal, *executor);
  write_tuned(options, logs_text, problem.base, result, header);
}

}  // namespace

void add_tune(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "tune",
      "Search the settings that learn one or more logs best, on their training rows alone",
      run_tune);
  options->log.add_to(*command);
  add_files(command, "more", options->more,
            "further logs with the same targets; each counts alike, as a stream of its own");
  add_split_option(*command, options->split, "whose held-out rows stay untouched (see `learn`)");
  add_since_option(*command, options->since_s);
  add_align_option(*command, options->align);
  add_current_option(*command, *options);
  add_accept_option(*command, options->accept);
  command->add_option("--only", options->only,
                      "number of the configuration to tune on; else the first in each log");
  add_file(command, "--config", options->config, "TOML file; what it sets is not searched");
  add_set(command, options->set, "key=value, not searched then (repeatable)");
  command
      ->add_option("--search", options->search,
                   "name=low:high, name=low:high:linear|log|log1m or name=value,value,... "
                   "(repeatable)")
      ->allow_extra_args(false);
  constexpr std::size_t kMostCandidates = 100'000;
  command->add_option("--candidates", options->candidates, "to draw for each target")
      ->check(CLI::Range(std::size_t{1}, kMostCandidates))
      ->capture_default_str();
  add_seed(command, options->seed, "of the candidates and of the random split");
  add_threads(command, options->threads);
  command
      ->add_option("--most-iterations", options->most_iterations,
                   "a candidate whose solver needs more per row is given up")
      ->check(within(1.0, 1e9))
      ->capture_default_str();
  add_out(command, options->out,
          "folder for tuned.toml, tune.json, tune.html and the journal to resume from");
  options->answer.add_to(*command, "tune.json");
  add_examples(command, "tune dive.csv --rate 4 --candidates 20",
               "tune dive1.csv dive2.csv --search gamma=0.05:2:log --set buffer=500");
}

}  // namespace kelpie::cli
