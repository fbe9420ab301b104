// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/log_options.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/settings_notes.hpp"
#include "file/atomic_file.hpp"
#include "format/comparison_json.hpp"
#include "format/settings_file.hpp"
#include "kelpie/core/error.hpp"
#include "report/comparison_report.hpp"
#include "report/recommendation.hpp"
#include "study/comparison.hpp"

namespace kelpie::cli {
namespace {

// What an expert would try first, one setting each.
constexpr std::array<const char*, 4> kVariants{"learner=svr", "terms=none", "adapt=none",
                                               "preset=paper"};

struct CompareArguments {
  LogOptions log;
  std::string config;
  std::vector<std::string> set;
  std::string split = "auto";
  std::string align = "auto";
  std::uint64_t seed = 1;
  std::size_t threads = 0;
  std::string out = "out/compare";
};

// Who takes part, kelpie first, and who can't.
struct CompareField {
  std::vector<study::Contender> contenders;
  std::vector<std::pair<std::string, std::string>> left_out;
  ModelSettings settings;
};

// A variant that is the same as kelpie or an earlier one is passed over.
CompareField make_field(const CompareArguments& options, const SplitLog& log) {
  const format::SettingsFile& file = log.config;
  const std::size_t axes = log.data.target_names.size();
  CompareField field{{}, {}, log.settings};
  print_notes(field.settings, file, options.set);
  std::vector<ModelSettings> known;
  const auto enter = [&](study::ContenderKind kind, const std::string& name,
                         const ModelSettings& settings) {
    const auto same = [&](const ModelSettings& other) {
      return std::ranges::equal(other.values(), settings.values());
    };
    if (std::ranges::none_of(known, same)) {
      field.contenders.push_back(study::make_contender(kind, name, log.data, log.split, settings));
      known.push_back(settings);
    }
  };
  enter(study::ContenderKind::kelpie, "kelpie", field.settings);
  for (const std::string variant : kVariants) {
    std::vector<std::string> set = options.set;
    set.push_back(variant);
    try {
      enter(study::ContenderKind::variant, variant, format::make_settings(file, set, axes));
    } catch (const InputError& error) {
      field.left_out.emplace_back(variant, error.what());
    }
  }
  for (study::Contender& baseline : study::baseline_contenders(log.data)) {
    field.contenders.push_back(std::move(baseline));
  }
  return field;
}

study::Comparison run_contenders(const CompareArguments& options, const SplitLog& log) {
  const CompareField field = make_field(options, log);
  const InterruptGuard guard;
  ProgressBar progress("comparing");
  const auto keep_going = [&](double share) {
    progress.at(share);
    return !InterruptGuard::asked();
  };
  study::Comparison comparison =
      study::compare(log.data, log.split, field.contenders, {options.threads, keep_going});
  if (InterruptGuard::asked()) {
    throw Failure("interrupted; nothing was written");
  }
  comparison.left_out = field.left_out;
  study::StreamResult& kelpie = comparison.contests.front().stream;
  kelpie.scales = "first " + std::to_string(field.settings.shared.warmup) + " training samples";
  kelpie.seed = options.seed;
  kelpie.alignment = log.alignment;
  kelpie.settings = field.settings.values();
  return comparison;
}

void run_compare(const CompareArguments& options) {
  const SplitLog log = open_split_log(
      options.log, {options.config, options.set, options.split, options.seed, options.align});
  study::require_held_out(log.split);
  const file::OutFolder out = take_out_folder(options.out, {"compare.json", "compare.html"},
                                              {options.log.source.path, options.config});
  const study::Comparison comparison = run_contenders(options, log);
  const std::filesystem::path& folder = out.path();
  file::write_files_whole(
      folder,
      {{"compare.json", format::comparison_json(comparison, report::recommendation(comparison))},
       {"compare.html", report::comparison_html(comparison)}});
  say("{}result: {}\nreport: {}\n", report::comparison_table(comparison),
      (folder / "compare.json").string(), (folder / "compare.html").string());
}

}  // namespace

void add_compare(CLI::App& app) {
  auto options = std::make_shared<CompareArguments>();
  CLI::App* const command = app.add_subcommand(
      "compare", "Learn a log with kelpie and with simpler models, and say which to use");
  options->log.add_to(*command);
  add_split_option(*command, options->split, "held-out rows, the same for all (see `learn`)");
  add_align_option(*command, options->align);
  command->add_option("--config", options->config, "TOML file with settings of kelpie")
      ->type_name("FILE");
  command->add_option("--set", options->set, "key=value, over the file (repeatable)")
      ->type_name("SETTING");
  command->add_option("--seed", options->seed, "of the random split")->capture_default_str();
  command->add_option("--threads", options->threads, "0: one per core")->capture_default_str();
  command->add_option("--out", options->out, "folder for compare.json and compare.html")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->callback([options] { run_compare(*options); });
}

}  // namespace kelpie::cli
