// SPDX-License-Identifier: Apache-2.0

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "core/text.hpp"
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
#include "report/verdicts.hpp"

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
  std::optional<std::string> part;
  bool merge = false;
  AnswerOptions answer;
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
    warn("going on with {} of {} runs\n", before, results.assigned());
  }
  const InterruptGuard guard;
  ProgressBar progress("study");
  const bool complete = results.run(executor, [&](double share) {
    progress.at(share);
    return !InterruptGuard::asked();
  });
  if (!complete) {
    throw Failure(fmt::format("interrupted after {} of {} runs; the same command goes on from here",
                              results.done(), results.assigned()));
  }
}

std::string failed_text(const fleet::Results& results) {
  return results.failures().empty()
             ? ""
             : fmt::format("{} of {} runs failed, the first of them: {}", results.failures().size(),
                           results.assigned(), results.failures().begin()->second);
}

// What makes the exit code 1, though the study ran to its end.
std::string complaints(const StudyArguments& options, const fleet::Results& results,
                       const fleet::StudyChange* change) {
  std::string text = failed_text(results);
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

void write_study(const StudyArguments& options, const fleet::Results& results,
                 std::optional<fleet::EarlierStudy> earlier, const file::OutFolder& out) {
  const fleet::StudySummary summary = fleet::summarise(results);
  std::optional<fleet::StudyChange> change;
  if (earlier) {
    change = fleet::compare_studies(results, *std::move(earlier));
  }
  const fleet::StudyChange* const changed = change ? &*change : nullptr;
  const report::StudyView view{results, summary, changed};
  const file::Content document = fleet::study_json(results, summary, changed);
  file::write_files_whole(out.path(),
                          {{kStudyJson, document}, {kStudyHtml, report::study_html(view)}});
  const std::string result = (out.path() / kStudyJson).string();
  give({.verdict = report::study_verdict(view),
        .tables = report::study_table(view),
        .document = document,
        .files = {{"result", result}, {"report", (out.path() / kStudyHtml).string()}},
        .next = {fmt::format("kelpie study {} --out FOLDER --against {}   (after a change)",
                             shell_word(options.file), shell_word(result))}},
       options.answer);
  if (const std::string text = complaints(options, results, changed); !text.empty()) {
    throw Failure(text);
  }
}

file::OutFolder take_study_folder(const StudyArguments& options) {
  return take_out_folder(options.out, {kStudyJson, kStudyHtml}, {options.file, options.against});
}

void run_whole(const StudyArguments& options, jobs::Executor& executor, StudyInput input) {
  find_input(options, input);
  const file::OutFolder out = take_study_folder(options);
  fleet::Results results(input.plan, input.missions, out.path());
  run_missing(results, executor);
  write_study(options, results, std::move(input.earlier), out);
}

void run_part(const StudyArguments& options, jobs::Executor& executor, StudyInput input) {
  const fleet::Part part = fleet::Part::parse(*options.part);
  find_input(options, input);
  fleet::Results results(input.plan, input.missions, options.out, fleet::Access::run, part);
  run_missing(results, executor);
  say("part {}: {} of {} runs are done; when all parts are, `kelpie study {} --merge --out {}` "
      "writes the result\n",
      part.text(), results.done(), results.assigned(), shell_word(options.file),
      shell_word(options.out));
  if (const std::string text = failed_text(results); !text.empty()) {
    throw Failure(text);
  }
}

void require_no_missing(const fleet::Results& results) {
  const std::map<fleet::Part, std::size_t> missing = results.missing();
  std::size_t runs = 0;
  std::vector<std::string> parts;
  for (const auto& [part, count] : missing) {
    runs += count;
    parts.push_back(fmt::format("{} ({})", part.text(), count));
  }
  if (runs > 0) {
    throw Failure(
        fmt::format("{} of {} runs are missing, so nothing was written; run these parts "
                    "again: --part {}",
                    runs, results.assigned(), join_text(parts, ", ")));
  }
}

void merge_parts(const StudyArguments& options, StudyInput input) {
  find_input(options, input);
  const file::OutFolder out = take_study_folder(options);
  const fleet::Results results(input.plan, input.missions, out.path(), fleet::Access::read);
  require_no_missing(results);
  write_study(options, results, std::move(input.earlier), out);
}

void run_study(const StudyArguments& options) {
  options.answer.begin();
  StudyInput input{.plan = fleet::read_plan(options.file), .missions = {}, .earlier = {}};
  if (options.merge) {
    return merge_parts(options, std::move(input));
  }
  if (options.part) {
    return run_part(options, *jobs::make_thread_executor(options.threads), std::move(input));
  }
  run_whole(options, *jobs::make_executor(options.threads), std::move(input));
}

}  // namespace

void add_study(CLI::App& app) {
  auto options = std::make_shared<StudyArguments>();
  CLI::App* const command = app.add_subcommand(
      "study", "Learn the logs of a fleet with several settings, and say who does how well");
  command->add_option("file", options->file, "TOML file: which logs, learners and splits")
      ->required()
      ->type_name("FILE");
  add_threads(command, options->threads);
  CLI::Option* const against =
      command
          ->add_option("--against", options->against,
                       "study.json of an earlier study: what has become better and worse since")
          ->type_name("FILE");
  CLI::Option* const worse =
      command
          ->add_option("--fail-if-worse", options->fail_if_worse,
                       "exit code 1 where R² of a learner on an axis of a vehicle, held out, has "
                       "become worse by more than this (median over its runs)")
          ->check(within(0.0, 1e9))
          ->type_name("R2");
  command
      ->add_option("--out", options->out,
                   "folder for study.json, study.html and the journal to go on from")
      ->capture_default_str()
      ->type_name("FOLDER");
  CLI::Option* const part =
      command
          ->add_option(
              "--part", options->part,
              "run part k of n alone, into a journal of its own; parts run at any time, on "
              "any machine that sees the folder")
          ->type_name("K/N");
  CLI::Option* const merge = command->add_flag(
      "--merge", options->merge, "run nothing; write the result of parts that have ended");
  options->answer.add_to(*command, kStudyJson);
  part->excludes(merge)->excludes(against)->excludes(worse);
  command->callback([options] { run_study(*options); });
  add_examples(command, "study fleet.toml",
               "study fleet.toml --against out/before/study.json --fail-if-worse 0.02");
}

}  // namespace kelpie::cli
