// SPDX-License-Identifier: Apache-2.0

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "file/atomic_file.hpp"
#include "fleet/earlier_study.hpp"
#include "fleet/missions.hpp"
#include "fleet/plan.hpp"
#include "fleet/results.hpp"
#include "fleet/study_json.hpp"
#include "fleet/summary.hpp"
#include "jobs/make_executor.hpp"
#include "kelpie/core/error.hpp"
#include "report/study_report.hpp"

namespace kelpie::cli {
namespace {

constexpr const char* kStudyJson = "study.json";
constexpr const char* kStudyHtml = "study.html";

struct StudyArguments {
  std::string file;
  std::size_t threads = 0;
  std::string against;
  std::optional<double> fail_if_worse;
  std::string out = "out/study";
};

// All that can be wrong before anything is run.
struct StudyInput {
  fleet::Plan plan;
  std::vector<fleet::Mission> missions;
  std::optional<fleet::EarlierStudy> earlier;
};

void find_input(const StudyArguments& options, StudyInput& input) {
  input.missions = fleet::find_missions(input.plan);
  if (!options.against.empty()) {
    input.earlier = fleet::read_earlier_study(options.against);
  }
  if (options.fail_if_worse && !input.earlier) {
    throw InputError("--fail-if-worse", "needs --against, the study.json of an earlier study");
  }
}

void run_missing(fleet::Results& results, jobs::Executor& executor) {
  const std::size_t before = results.done();
  if (before > 0) {
    warn("going on with {} of {} runs\n", before, results.combinations().size());
  }
  const InterruptGuard guard;
  ProgressBar progress("study");
  const bool complete = results.run(executor, [&](double share) {
    progress.at(share);
    return !InterruptGuard::asked();
  });
  if (!complete) {
    throw Failure(fmt::format("interrupted after {} of {} runs; the same command goes on from here",
                              results.done(), results.combinations().size()));
  }
}

// What makes the exit code 1, though the study ran to its end.
std::string complaints(const StudyArguments& options, const fleet::Results& results,
                       const fleet::StudyChange* change) {
  std::string text;
  if (!results.failures().empty()) {
    const auto& [i, why] = *results.failures().begin();
    text = fmt::format("{} of {} runs failed, the first of them: {}", results.failures().size(),
                       results.combinations().size(), why);
  }
  if (options.fail_if_worse) {
    const std::vector<fleet::Gain> worse = fleet::losses(*change, *options.fail_if_worse);
    if (!worse.empty()) {
      text += fmt::format("{}{} vehicles' axes are worse than in {}, most of all {} of {} with {}",
                          text.empty() ? "" : "; ", worse.size(), change->file, worse.front().axis,
                          worse.front().vehicle, worse.front().learner);
    }
  }
  return text;
}

void lead_study(const StudyArguments& options, jobs::Executor& executor, StudyInput input) {
  find_input(options, input);
  const file::OutFolder out =
      take_out_folder(options.out, {kStudyJson, kStudyHtml}, {options.file, options.against});
  fleet::Results results(input.plan, input.missions, out.path());
  run_missing(results, executor);
  const fleet::StudySummary summary = fleet::summarise(results);
  std::optional<fleet::StudyChange> change;
  if (input.earlier) {
    change = fleet::compare_studies(results, *std::move(input.earlier));
  }
  const fleet::StudyChange* const changed = change ? &*change : nullptr;
  const report::StudyView view{results, summary, changed};
  file::write_files_whole(out.path(), {{kStudyJson, fleet::study_json(results, summary, changed)},
                                       {kStudyHtml, report::study_html(view)}});
  say("{}result: {}\nreport: {}\n", report::study_table(view), (out.path() / kStudyJson).string(),
      (out.path() / kStudyHtml).string());
  if (const std::string text = complaints(options, results, changed); !text.empty()) {
    throw Failure(text);
  }
}

void run_study(const StudyArguments& options) {
  StudyInput input{.plan = fleet::read_plan(options.file), .missions = {}, .earlier = {}};
  const std::unique_ptr<jobs::Executor> executor = jobs::make_executor(options.threads);
  if (executor->leads()) {
    return lead_study(options, *executor, std::move(input));
  }
  const InterruptGuard guard;
  fleet::help(input.plan, *executor, [](double) { return !InterruptGuard::asked(); });
}

}  // namespace

void add_study(CLI::App& app) {
  auto options = std::make_shared<StudyArguments>();
  CLI::App* const command = app.add_subcommand(
      "study", "Learn the logs of a fleet with several settings, and say who does how well");
  command->add_option("file", options->file, "TOML file: which logs, learners and splits")
      ->required()
      ->type_name("FILE");
  command->add_option("--threads", options->threads, "0: one per core")->capture_default_str();
  command
      ->add_option("--against", options->against,
                   "study.json of an earlier study: what has become better and worse since")
      ->type_name("FILE");
  command
      ->add_option("--fail-if-worse", options->fail_if_worse,
                   "exit code 1 where R² of a learner on an axis of a vehicle, held out, has "
                   "become worse by more than this (median over its runs)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("R2");
  command
      ->add_option("--out", options->out,
                   "folder for study.json, study.html and the journal to go on from")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->callback([options] { run_study(*options); });
}

}  // namespace kelpie::cli
