// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "file/atomic_file.hpp"
#include "format/comparison_json.hpp"
#include "format/settings_file.hpp"
#include "kelpie/core/error.hpp"
#include "report/comparison_report.hpp"
#include "report/recommendation.hpp"
#include "report/verdicts.hpp"
#include "study/comparison.hpp"

namespace kelpie::cli {
namespace {

// What an expert would try first, one setting each.
constexpr std::array<const char*, 4> kVariants{"learner=svr", "terms=none", "adapt=none",
                                               "preset=paper"};

struct CompareArguments : PlanOptions {
  std::size_t threads = 0;
  std::string out = "out/compare";
  AnswerOptions answer;
};

// The contenders, kelpie first, and those that can't be made.
struct CompareField {
  std::vector<study::Contender> contenders;
  std::vector<std::pair<std::string, std::string>> left_out;
};

// A variant with the same settings as kelpie or an earlier variant is left out silently.
CompareField make_field(const CompareArguments& options, const PlannedLog& log) {
  const study::LearnPlan& plan = log.plan;
  CompareField field;
  print_notes(plan.settings, log.config, options.set);
  std::vector<ModelSettings> known;
  const auto enter = [&](study::ContenderKind kind, const std::string& name,
                         const ModelSettings& settings) {
    const auto same = [&](const ModelSettings& other) {
      return std::ranges::equal(other.values(), settings.values());
    };
    if (std::ranges::none_of(known, same)) {
      field.contenders.push_back(
          study::make_contender(kind, name, plan.data, plan.split, settings));
      known.push_back(settings);
    }
  };
  enter(study::ContenderKind::kelpie, "kelpie", plan.settings);
  for (const std::string variant : kVariants) {
    std::vector<std::string> set = options.set;
    set.push_back(variant);
    try {
      enter(study::ContenderKind::variant, variant,
            format::make_settings(log.config, set, plan.data.target_names.size()));
    } catch (const InputError& error) {
      field.left_out.emplace_back(variant, error.what());
    }
  }
  std::ranges::move(study::baseline_contenders(plan.data), std::back_inserter(field.contenders));
  return field;
}

study::Comparison run_contenders(const CompareArguments& options, const PlannedLog& log) {
  const CompareField field = make_field(options, log);
  const InterruptGuard guard;
  ProgressBar progress("comparing");
  const auto keep_going = [&](double share) {
    progress.at(share);
    return !InterruptGuard::asked();
  };
  study::Comparison comparison = study::compare(log.plan.data, log.plan.split, field.contenders,
                                                {options.threads, keep_going});
  if (InterruptGuard::asked()) {
    throw Failure("interrupted; nothing was written");
  }
  comparison.left_out = field.left_out;
  study::describe(log.plan, comparison.contests.front().stream);
  return comparison;
}

// What to learn with the better variant, if there is one.
std::vector<std::string> next_commands(const CompareArguments& options,
                                       const study::Comparison& comparison) {
  const study::Contest* const better = comparison.better_variant();
  return {fmt::format("kelpie learn {}{}", options.text(options.config),
                      better != nullptr ? " --set " + shell_word(better->name) : "")};
}

void run_compare(const CompareArguments& options) {
  options.answer.begin();
  const PlannedLog log = plan_log(options);
  study::require_held_out(log.plan.split);
  const file::OutFolder out =
      take_out_folder(options.out, {"compare.json", "compare.html"}, options.files());
  const study::Comparison comparison = run_contenders(options, log);
  const std::filesystem::path& folder = out.path();
  const std::string document =
      format::comparison_json(comparison, report::recommendation(comparison));
  file::write_files_whole(
      folder, {{"compare.json", document}, {"compare.html", report::comparison_html(comparison)}});
  give({.verdict = report::comparison_verdict(comparison),
        .tables = report::comparison_table(comparison),
        .document = document,
        .files = {{"result", (folder / "compare.json").string()},
                  {"report", (folder / "compare.html").string()}},
        .next = next_commands(options, comparison)},
       options.answer);
}

}  // namespace

void add_compare(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "compare", "Learn a log with kelpie and with simpler models, and say which to use",
      run_compare);
  options->log.add_to(*command);
  add_split_option(*command, options->split, "held-out rows, the same for all (see `learn`)");
  add_since_option(*command, options->since_s);
  add_align_option(*command, options->align);
  add_current_option(*command, *options);
  add_accept_option(*command, options->accept);
  add_file(command, "--config", options->config, "TOML file with settings of kelpie");
  add_set(command, options->set);
  add_seed(command, options->seed);
  add_threads(command, options->threads);
  add_out(command, options->out, "folder for compare.json and compare.html");
  options->answer.add_to(*command, "compare.json");
  add_examples(command, "compare dive.csv --rate 4",
               "compare dive.bag --config vehicle.toml --split tail");
}

}  // namespace kelpie::cli
