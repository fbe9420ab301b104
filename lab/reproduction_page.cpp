// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "kelpie/model/settings.hpp"
#include "lab/claims.hpp"
#include "lab/reproduction_report.hpp"
#include "lab/reproduction_views.hpp"
#include "report/stream_figures.hpp"

namespace kelpie::lab {
namespace {

constexpr double kLowestR2 = -0.2;
constexpr std::size_t kBaselineStyle = 6;

// Beyond which a figure would show nothing but a learner's first steps.
double lowest_of(const std::vector<MeanCurve>& curves, bool& clipped) {
  double low = 0.8;
  for (const MeanCurve& curve : curves) {
    for (const chart::Point& point : curve.low) {
      low = std::fmin(low, point.y);
    }
  }
  clipped = low < kLowestR2;
  return std::clamp(std::floor(5.0 * low) / 5.0, kLowestR2, 0.8);
}

// The contender's look is the same in every figure: by its place in the study, pairs alike.
std::size_t style_of(const StreamStudy& study, const std::string& key) {
  const auto found = std::ranges::find(study.contenders, key, &ContenderRuns::key);
  const auto place = static_cast<std::size_t>(found - study.contenders.begin());
  return key == "proposed_small" ? 0 : key == "fifo_small" ? 1 : place;
}

std::vector<chart::Point> baseline_steps(const StreamStudy& study, std::size_t axis) {
  std::vector<chart::Point> steps;
  double from = 0.0;
  for (std::size_t stage = 0; stage < stages_of(study); ++stage) {
    const auto to =
        static_cast<double>(study.contenders.front().seeds.front().front().stages[stage].samples);
    const double r2 = baseline_r2(study, axis, stage);
    steps.push_back({from, r2});
    steps.push_back({to - 0.5, r2});
    from = to;
  }
  return steps;
}

void add_band(chart::Figure& figure, const MeanCurve& curve, std::size_t style) {
  std::vector<chart::Point> middle;
  std::vector<double> half;
  for (std::size_t i = 0; i < curve.low.size(); ++i) {
    middle.push_back({curve.low[i].x, 0.5 * (curve.low[i].y + curve.high[i].y)});
    half.push_back(0.5 * (curve.high[i].y - curve.low[i].y));
  }
  figure.band(middle, half, style);
}

// R² of contenders on an axis over the stream: mean of the seeds as a line, least to greatest as a
// band, the off-line baseline as steps. The figure ends at −0.2; the caption mentions lower
// values.
std::string comparison_figure(const StreamStudy& study, const std::vector<std::string>& keys,
                              std::size_t axis) {
  std::vector<MeanCurve> curves;
  curves.reserve(keys.size());
  for (const std::string& key : keys) {
    curves.push_back(mean_curve(*find_contender(study, key), axis));
  }
  bool clipped = false;
  const double low = lowest_of(curves, clipped);
  chart::Figure figure({"training samples shown"}, {"R² on held-out rows", chart::Extent{low, 1.0}},
                       study.axes[axis] + ": validation R² over the stream, " + study.split);
  figure.link(study.key + study.split_kind);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (find_contender(study, keys[i])->seeds.size() > 1) {
      add_band(figure, curves[i], style_of(study, keys[i]));
    }
  }
  if (!study.offline.empty()) {
    figure.line(baseline_steps(study, axis), kBaselineStyle, "off-line baseline");
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    figure.line(curves[i].mean, style_of(study, keys[i]), find_contender(study, keys[i])->name);
  }
  const std::vector<study::StageEnd>& stages = study.contenders.front().seeds.front()[axis].stages;
  for (std::size_t stage = 1; stage < stages.size(); ++stage) {
    figure.mark(static_cast<double>(stages[stage - 1].samples),
                fmt::format("configuration {}", stages[stage].configuration + 1));
  }
  return figure.html(clipped ? "What lies below −0.2 is outside the figure." : "");
}

// The first seed's held-out rows at the end of a stage, true and predicted, over time.
std::string prediction_figure(const StreamStudy& study, std::string_view key, std::size_t axis,
                              std::size_t stage) {
  const study::AxisResult& run = find_contender(study, key)->seeds.front()[axis];
  const study::StageEnd& end = run.stages[stage];
  const chart::Extent span = chart::range_of(end.time_s);
  const report::Clock clock{span.low, {0.0, span.high - span.low}};
  chart::Figure figure(clock.axis(), {run.name},
                       run.name + ": held-out rows, true and predicted, over time");
  figure.link(fmt::format("{} stage {}", study.key, stage));
  figure.line(report::over_time(clock, end.time_s, end.truth), 0, "true");
  figure.line(report::over_time(clock, end.time_s, end.predicted), 1, "predicted");
  return figure.html(fmt::format("R² {} on all {} held-out rows of configuration {}.",
                                 chart::decimal(end.r2), chart::grouped(end.truth.size()),
                                 end.configuration + 1));
}

// R² on the published test rows over the steps.
std::string published_figure(const std::vector<PublishedRun>& runs) {
  chart::Figure figure({"steps after the first 100 samples"},
                       {"R² on the test rows, mean of three axes", chart::Extent{kLowestR2, 1.0}},
                       "R² over the steps of the published protocol");
  std::vector<std::vector<chart::Point>> lines;
  double last = 1.0;
  for (const PublishedRun& run : runs) {
    std::vector<chart::Point>& line = lines.emplace_back();
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
      line.push_back({static_cast<double>(run.steps[i]), run.r2[i]});
      last = std::max(last, line.back().x);
    }
  }
  const auto level = [&](double r2, std::size_t style, const std::string& name) {
    figure.line(std::vector<chart::Point>{{0.0, r2}, {last, r2}}, style, name);
  };
  level(kPublished[3].mean, 3, "published, greedy: mean of the run");
  level(kPublished[0].mean, 4, "published, FIFO: mean of the run");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    figure.line(lines[i], i, runs[i].name);
  }
  return figure.html("What lies below −0.2 is outside the figure.");
}

std::string note(const std::string& text) {
  return chart::paragraph("note", text);
}

using Rows = std::vector<std::vector<std::string>>;

Rows published_rows_of(const Reproduction& result) {
  Rows rows;
  for (const PublishedRun& run : result.published) {
    rows.push_back({run.name, chart::decimal(run.mean), chart::decimal(run.minimum),
                    chart::decimal(run.mean_late), chart::decimal(run.minimum_late),
                    chart::decimal(run.end)});
  }
  for (const PublishedFigure& figure : kPublished) {
    const bool threshold = std::string_view(figure.name) == "threshold";
    rows.push_back({fmt::format("published: {}", figure.name), chart::decimal(figure.mean), "",
                    threshold ? chart::decimal(kPublishedLateMean) : "",
                    threshold ? chart::decimal(kPublishedLateMinimum) : "",
                    threshold ? chart::decimal(kPublishedEnd) : ""});
  }
  rows.push_back(
      {"published: off-line network", "", "", "", "", chart::decimal(kPublishedOffline)});
  return rows;
}

std::string peer_table(const Reproduction& result, std::string_view stream) {
  std::vector<std::string> head{"learner", "update µs, median / p99"};
  head.insert(head.end(), kPeerMarks.begin(), kPeerMarks.end());
  Rows rows;
  for (const PeerRun& run : result.peers) {
    if (run.stream != stream) {
      continue;
    }
    std::vector<std::string>& row = rows.emplace_back();
    row = {run.learner, fmt::format("{:.0f} / {:.0f}", run.median_us, run.p99_us)};
    for (const double r2 : run.r2) {
      row.push_back(chart::decimal(r2));
    }
  }
  return chart::html_table(head, rows);
}

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

// A claim counts once for each stream and split.
std::string headline(const std::vector<Claim>& claims) {
  const auto count = [&](ClaimState finding) {
    return std::ranges::count(claims, finding, &Claim::finding);
  };
  return fmt::format("Claims of the paper, measured again: {} hold, {} hold in part, {} do not",
                     count(ClaimState::holds), count(ClaimState::in_part),
                     count(ClaimState::fails));
}

std::string opening(const Reproduction& result) {
  const ReproductionPlan& plan = result.plan;
  const std::vector<Claim> claims = claims_of(result);
  std::string text = chart::heading(1, headline(claims));
  text += chart::paragraph(
      "lead",
      fmt::format("Wehbe, Hildebrandt & Kirchner, “A Framework for On-line Learning of Underwater "
                  "Vehicles Dynamic Models”. Each claim was judged on every stream and split at "
                  "hand; {} could not be judged.",
                  std::ranges::count(claims, ClaimState::not_judged, &Claim::finding)));
  if (plan.quick) {
    text += chart::paragraph(
        "interrupted",
        fmt::format("This is the quick version: simulated phases at {:.0f} % of their length, the "
                    "first {} rows of the real log, {} seed(s), few looks, a coarse grid for the "
                    "off-line baselines, without the longest streams. Its figures are not those of "
                    "the full run.",
                    100.0 * plan.scenario_share, chart::grouped(plan.real_rows), plan.seeds));
  }
  text += note(
      result.real_log
          ? "Of the paper's three real configurations only the first is public. Configurations 1 "
            "to 3 below are those of the simulator wherever it says simulation; the simulator is "
            "this project's own, with no part of the paper's."
          : "The real log was not there: everything below is simulation.");
  return text + note(
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
  std::string text =
      note(fmt::format("LIBSVM on all training rows of one configuration, R² on the held-out "
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
  std::vector<std::string> figures;
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
    figures.push_back(note(study.axes[axis]) + comparison_figure(study, keys, axis));
  }
  return chart::panels(figures);
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
  std::string text = note(
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
  std::string text =
      note(fmt::format("Simulated streams: seed of simulation and split alike. The real log: "
                       "seed of the random split; blocks are the same for every seed, so "
                       "there is one run. RLS is recursive least squares on Fossen's terms. The "
                       "paper's values as written take longest and are run with {} seed(s) at "
                       "most. Where a buffer of 900 never fills, FIFO "
                       "forgets nothing and is the proposed learner; a second pair with a "
                       "buffer of {} shows what forgetting does.",
                       result.plan.paper_seeds, result.plan.small_buffer));
  for (const StreamStudy& study : result.studies) {
    text += chart::heading(3, title_of(study)) +
            (study.note.empty() ? "" : note("These figures are " + study.note + ".")) +
            ends_table(study) + curves(study, kEverybody) + curves(study, kSmallPair);
  }
  return text;
}

std::string prediction_section(const Reproduction& result) {
  std::string text = note(
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
        figures.push_back(note(study.axes[axis]) +
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

std::string parameters_section() {
  constexpr std::array kTableOne{"epsilon", "c", "gamma", "buffer", "k", "a", "b", "xi"};
  constexpr std::array kPrinted{"0.1, 0.001, 0.1", "10, 10, 10", "100, 40, 20", "900, 900, 900",
                                "10, 10, 1",       "0.99",       "0.01",        "0.99"};
  std::vector<std::vector<std::string>> rows;
  const auto paper = std::ranges::find(preset_names(), "paper") - preset_names().begin();
  for (const SettingText& doc : setting_docs()) {
    const auto* const found = std::ranges::find(kTableOne, doc.name);
    rows.push_back({doc.name, doc.presets.at(0), doc.presets.at(static_cast<std::size_t>(paper)),
                    found == kTableOne.end()
                        ? "–"
                        : kPrinted.at(static_cast<std::size_t>(found - kTableOne.begin()))});
  }
  return note(
             "Surge, sway, yaw. γ as eq. (6) has it, κ = exp(−γ d²); the table's 100, 40, 20 "
             "make a kernel so narrow that only neighbours in time help, and work when read "
             "as κ = exp(−d²/γ): the preset holds the reciprocals.") +
         chart::html_table({"setting", "ours (default)", "paper's preset", "printed in Table I"},
                           rows, "words");
}

std::string claims_section(const Reproduction& result) {
  std::string body;
  std::string last;
  for (const Claim& claim : claims_of(result)) {
    if (claim.paper != last) {
      body += fmt::format("<tr><td colspan=\"3\"><strong>{}</strong><br/>{}</td></tr>\n",
                          chart::escape_markup(claim.paper),
                          chart::escape_markup("Rule: " + claim.rule));
      last = claim.paper;
    }
    const char* const css = claim.finding == ClaimState::holds     ? "holds"
                            : claim.finding == ClaimState::in_part ? "part"
                            : claim.finding == ClaimState::fails   ? "fails"
                                                                   : "note";
    body += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"verdict {}\">{}</td></tr>\n",
                        chart::escape_markup(claim.where), chart::escape_markup(claim.measured),
                        css, finding_text(claim.finding));
  }
  return note(
             "The verdicts are computed from the figures by the rule beside each claim; the "
             "rules are ours, the paper gives no thresholds.") +
         "<div class=\"scroll\">\n<table class=\"words\">\n<thead><tr><th>where</th>"
         "<th>measured</th><th>verdict</th></tr></thead>\n<tbody>\n" +
         body + "</tbody>\n</table>\n</div>\n";
}

std::string published_section(const Reproduction& result) {
  std::string text = note(
      "Tesnar, Wehbe & Valdenegro-Toro 2025 (arXiv:2504.04583): neural networks with "
      "an uncertainty-driven buffer, on the real log. The first row is dropped; every "
      "fifth of the others, from the second, is for testing; every fourth of the rest, "
      "from the second, for validation; what remains streams in order. The score is the "
      "mean of the three axes' R² on the test rows. Test rows lie between training rows "
      "in time, so that, too, is a split that leaks.");
  if (result.published.empty()) {
    return text + note("Not measured: the whole log of 11,567 rows was not there.");
  }
  text +=
      note(fmt::format("Scored after every {}. of the steps that follow the first 100 samples. "
                       "Settings chosen on the protocol's validation rows "
                       "(docs/measured/reproduction.md): {}",
                       result.plan.published_every, result.published.front().settings));
  return text +
         chart::html_table(
             {"learner", "mean", "minimum", "mean from step 1,000", "minimum from 1,000", "end"},
             published_rows_of(result)) +
         published_figure(result.published);
}

std::string peers_section(const Reproduction& result) {
  std::string text = note(
      "Simulated streams of this project, 10,000 rows of each of two configurations, target du. R² "
      "on held-out rows at the given samples. docs/measured/reproduction.md has other learners, as "
      "measured earlier.");
  if (result.peers.empty()) {
    return text + note(result.plan.peers
                           ? "Skipped: the streams (peer_streams/*.csv) were not there."
                           : "Skipped in this version of the run.");
  }
  for (const std::string_view stream : kPeerStreams) {
    text += chart::heading(3, stream) + peer_table(result, stream);
  }
  return text;
}

}  // namespace

std::string reproduction_html(const Reproduction& result) {
  return chart::html_page(
      "kelpie: the claims of the paper, measured again", opening(result),
      {{"Claims", claims_section(result)},
       {"Off-line baselines (Fig. “offline”)", offline_section(result)},
       {"Accuracy over the stream (Fig. “validation”)", validation_section(result)},
       {"Learners compared (Fig. “comparison”)", comparison_section(result)},
       {"Predictions (Fig. “prediction”)", prediction_section(result)},
       {"Hyper-parameters (Table I)", parameters_section()},
       {"A published opponent", published_section(result)},
       {"Opponents on hostile streams", peers_section(result)},
       {"Data, seeds and settings", provenance(result)}});
}

}  // namespace kelpie::lab
