// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "lab/reproduction_figures.hpp"
#include "lab/reproduction_report.hpp"
#include "lab/reproduction_sections.hpp"
#include "lab/reproduction_views.hpp"

namespace kelpie::lab {
namespace {

constexpr std::array kEverybody{"proposed", "default", "fifo", "sosvr", "rls", "paper"};
constexpr std::array kSmallPair{"proposed_small", "fifo_small"};

std::string title_of(const StreamStudy& study) {
  return fmt::format("{}{}, {}", study.simulated ? "Simulation" : "Real log, configuration 1",
                     study.key == "simulation" || study.key == "real" ? "" : " “" + study.key + "”",
                     study.split);
}

bool of_the_paper(const StreamStudy& study) {
  return !study.offline.empty();
}

std::string opening(const Reproduction& result) {
  const ReproductionPlan& plan = result.plan;
  std::string text = chart::heading(1, "What of the paper kelpie measures again");
  text += chart::paragraph(
      "lead",
      "Wehbe, Hildebrandt & Kirchner, “A Framework for On-line Learning of "
      "Underwater Vehicles Dynamic Models”: its figures, measured with this program.");
  if (plan.quick) {
    text += chart::paragraph(
        "interrupted",
        fmt::format("This is the quick version: simulated phases at {:.0f} % of their length, the "
                    "first {} rows of the real log, {} seed(s), few looks, a coarse grid for the "
                    "off-line baselines, without the longest streams. Its figures are not those of "
                    "the full run.",
                    100.0 * plan.scenario_share, chart::grouped(plan.real_rows), plan.seeds));
  }
  text += chart::paragraph(
      "note",
      result.real_log
          ? "Of the paper's three real configurations only the first is public. Configurations 1 "
            "to 3 below are those of the simulator wherever it says simulation; the simulator is "
            "this project's own, with no part of the paper's."
          : "The real log was not there: everything below is simulation.");
  return text +
         chart::paragraph("note",
                          "Every experiment is made under two splits. Random: a fifth of the rows, "
                          "as in the paper; neighbours in time leak. Blocks: whole blocks of 400 "
                          "rows; harder and more honest. Learners find their scaling on line, from "
                          "the first 200 training samples. R² is 1 − (squared error)/(variance), "
                          "on held-out rows of the configuration then running.");
}

std::string matrix_table(const StreamStudy& study) {
  std::vector<std::string> head{"axis", "trained on"};
  for (const int configuration : study.configurations) {
    head.push_back(fmt::format("tested on {}", configuration + 1));
  }
  head.insert(head.end(), {"γ", "C", "ε", "cross-validated R²", "training rows"});
  std::vector<std::vector<std::string>> rows;
  for (const OfflineMatrix& matrix : study.offline) {
    for (const OfflineModel& model : matrix.models) {
      std::vector<std::string>& row = rows.emplace_back();
      row = {matrix.axis, fmt::format("configuration {}", model.trained_on + 1)};
      for (const double r2 : model.r2) {
        row.push_back(chart::decimal(r2));
      }
      for (const double value : {model.settings.gamma, model.settings.c, model.settings.epsilon}) {
        row.push_back(fmt::format("{}", value));
      }
      row.push_back(chart::decimal(model.cross_validated_r2));
      row.push_back(chart::grouped(model.training_rows));
    }
  }
  return chart::html_table(head, rows);
}

std::string offline_section(const Reproduction& result) {
  std::string text = chart::paragraph(
      "note", fmt::format("LIBSVM on all training rows of one configuration, R² on the held-out "
                          "rows of each. γ, C, ε by {}-fold cross-validation over contiguous "
                          "stretches of every {}th training row; held-out rows have no part in "
                          "it. First seed. Of the real log, configuration 1 alone is public.",
                          result.plan.grid.folds, result.plan.grid.thin));
  for (const StreamStudy& study : result.studies) {
    if (!of_the_paper(study)) {
      continue;
    }
    text += chart::heading(3, title_of(study)) + matrix_table(study);
  }
  return text;
}

template <typename Keys>
std::string curves(const StreamStudy& study, const Keys& wanted) {
  std::vector<std::string> keys;
  for (const char* const key : wanted) {
    if (find_contender(study, key) != nullptr) {
      keys.emplace_back(key);
    }
  }
  std::string text;
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
    text += chart::paragraph("note", study.axes[axis]) + comparison_figure(study, keys, axis);
  }
  return text;
}

std::string ends_table(const StreamStudy& study) {
  std::vector<std::string> head{"R² at the end of configuration"};
  for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
    const int configuration =
        study.contenders.front().seeds.front().front().stages[stage].configuration;
    for (const std::string& axis : study.axes) {
      head.push_back(fmt::format("{}: {}", configuration + 1, axis));
    }
  }
  head.emplace_back("seeds");
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const std::string& name, auto value, const std::string& seeds) {
    std::vector<std::string>& row = rows.emplace_back();
    row.push_back(name);
    for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
      for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
        row.push_back(chart::decimal(value(axis, stage)));
      }
    }
    row.push_back(seeds);
  };
  if (of_the_paper(study)) {
    add(
        "off-line baseline",
        [&](std::size_t axis, std::size_t stage) { return baseline_r2(study, axis, stage); }, "1");
  }
  for (const ContenderRuns& runs : study.contenders) {
    add(
        runs.name, [&](std::size_t axis, std::size_t stage) { return stage_r2(runs, axis, stage); },
        chart::grouped(runs.seeds.size()));
  }
  return chart::html_table(head, rows);
}

std::string validation_section(const Reproduction& result) {
  std::string text = chart::paragraph(
      "note",
      "The proposed learner (the paper's, alone), started from nothing. Line: mean of the "
      "seeds; band: least to greatest. Dashed steps: the off-line baseline of the "
      "configuration then running, on the same held-out rows.");
  for (const StreamStudy& study : result.studies) {
    if (of_the_paper(study)) {
      text += chart::heading(3, title_of(study)) + curves(study, std::array{"proposed"});
    }
  }
  return text;
}

std::string comparison_section(const Reproduction& result) {
  std::string text = chart::paragraph(
      "note", fmt::format("Simulated streams: seed of simulation and split alike. The real log: "
                          "seed of the random split; blocks are the same for every seed, so "
                          "there is one run. RLS is recursive least squares on Fossen's terms. The "
                          "paper's values as written take longest and are run with {} seed(s) at "
                          "most. Where a buffer of 900 never fills, FIFO "
                          "forgets nothing and is the proposed learner; a second pair with a "
                          "buffer of {} shows what forgetting does.",
                          result.plan.paper_seeds, result.plan.small_buffer));
  for (const StreamStudy& study : result.studies) {
    text +=
        chart::heading(3, title_of(study)) +
        (study.note.empty() ? ""
                            : chart::paragraph("note", "These figures are " + study.note + ".")) +
        ends_table(study) + curves(study, kEverybody) + curves(study, kSmallPair);
  }
  return text;
}

std::string prediction_section(const Reproduction& result) {
  std::string text =
      chart::paragraph("note",
                       "Held-out rows as the proposed learner predicts them just before "
                       "the vehicle changes; blocks split, first seed. The stretch is "
                       "picked by its place in the log, not by how well it is predicted. Units: "
                       "m/s², m/s², rad/s².");
  for (const StreamStudy& study : result.studies) {
    if (!of_the_paper(study) || study.split_kind != "blocks") {
      continue;
    }
    for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
      text += chart::heading(
          3, fmt::format("{}, end of configuration {}", study.simulated ? "Simulation" : "Real log",
                         study.configurations[stage] + 1));
      std::vector<std::string> figures;
      for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
        figures.push_back(chart::paragraph("note", study.axes[axis]) +
                          prediction_figure(study, "proposed", axis, stage));
      }
      text += chart::panels(figures);
    }
  }
  return text;
}

std::string provenance(const Reproduction& result) {
  const ReproductionPlan& plan = result.plan;
  chart::Facts facts{{"command", plan.quick ? "kelpie reproduce --quick" : "kelpie reproduce"},
                     {"first seed", fmt::format("{}", plan.first_seed)},
                     {"seeds", fmt::format("{} (further streams {}, paper's values {})", plan.seeds,
                                           std::min(plan.seeds, plan.further_seeds),
                                           std::min(plan.seeds, plan.paper_seeds))},
                     {"looks", fmt::format("every {} training samples", plan.validate_every)}};
  for (const StreamStudy& study : result.studies) {
    facts.emplace_back(
        study.key + ", " + study.split_kind,
        fmt::format("{}; {}; {} rows for training, {} held out", study.source, study.split,
                    chart::grouped(study.training_rows), chart::grouped(study.held_out_rows)));
  }
  if (!result.studies.empty()) {
    for (const ContenderRuns& runs : result.studies.front().contenders) {
      facts.emplace_back(runs.name, runs.settings);
    }
  }
  return chart::facts_table(facts);
}

}  // namespace

std::string reproduction_html(const Reproduction& result) {
  return chart::html_page(
      "kelpie: what of the paper holds", opening(result),
      {{"What of the paper holds, and what does not", claims_section(result)},
       {"Off-line baselines on every configuration (the paper's Fig. “offline”)",
        offline_section(result)},
       {"Accuracy over the stream (the paper's Fig. “validation”)", validation_section(result)},
       {"Learners compared (the paper's Fig. “comparison”)", comparison_section(result)},
       {"Predictions at the end of each configuration (Fig. “prediction”)",
        prediction_section(result)},
       {"Hyper-parameters (the paper's Table I)", parameters_section()},
       {"A published opponent, with a buffer of 100", published_section(result)},
       {"Opponents on streams with what no regressor models, and outliers", peers_section(result)},
       {"Data, seeds and settings", provenance(result)}});
}

}  // namespace kelpie::lab
