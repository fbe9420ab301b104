// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
#include "kelpie/model/settings.hpp"
#include "lab/claims.hpp"
#include "lab/reproduction_report.hpp"

namespace kelpie::lab {
namespace {

using chart::TextTable;
using file::Json;

constexpr double kLowestR2 = -0.2;
constexpr std::size_t kBaselineStyle = 6;
constexpr const char* kTitle = "The paper, measured again";

// A part of the page: words, tables, and figures, which HTML alone has.
struct Part {
  std::string title;
  std::vector<std::string> words;
  std::vector<TextTable> tables{};
  std::vector<std::string> figures{};
  bool folded = false;
};

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

bool of_the_paper(const Json& study) {
  return !study["offline"].empty();
}

std::string title_of(const Json& study) {
  const std::string key = text_of(study["stream"]);
  return fmt::format("{}, {} split",
                     key == "real"         ? "real log, configuration 1"
                     : key == "simulation" ? "simulation"
                                           : "simulation “" + key + "”",
                     text_of(study["split"]));
}

std::vector<const Json*> studies_of_the_paper(const Json& document) {
  std::vector<const Json*> found;
  for (const Json& study : document["streams"]) {
    if (of_the_paper(study)) {
      found.push_back(&study);
    }
  }
  return found;
}

double mean_of_ends(const Json& study, const Json& row) {
  double sum = 0.0;
  for (std::size_t stage = 0; stage < study["stages"].size(); ++stage) {
    sum += mean_end(row, stage) / static_cast<double>(study["stages"].size());
  }
  return sum;
}

// "holds", or how often a claim that was judged several times holds.
std::string verdict_on(const std::vector<const Json*>& claims, const char* who) {
  std::array<std::size_t, 4> counts{};
  std::size_t judged = 0;
  for (const Json* const claim : claims) {
    for (std::size_t i = 0; i < 3 && !(*claim)[who].is_null(); ++i) {
      const bool is = (*claim)[who]["finding"] == finding_text(static_cast<ClaimState>(i));
      counts.at(i) += is ? 1U : 0U;
      judged += is ? 1U : 0U;
    }
  }
  if (judged == 0) {
    return "–";
  }
  if (counts[0] == judged || counts[2] == judged) {
    return fmt::format("{} ({} of {})", counts[0] == judged ? "holds" : "does not hold", judged,
                       judged);
  }
  return fmt::format("in part ({} hold, {} in part, {} not)", counts[0], counts[1], counts[2]);
}

// Each claim with its verdicts on all streams.
TextTable claims_table(const Json& document) {
  TextTable table{"", {"the paper says", "for the paper's learner", "for kelpie's default"}, {}};
  table.left = {0, 1, 2};
  std::vector<const Json*> same;
  for (const Json& claim : document["claims"]) {
    same.push_back(&claim);
    const Json* const next = &claim == &document["claims"].back() ? nullptr : &claim + 1;
    if (next == nullptr || (*next)["claim"] != claim["claim"]) {
      table.rows.push_back(
          {text_of(claim["claim"]), verdict_on(same, "paper"), verdict_on(same, "kelpie")});
      same.clear();
    }
  }
  return table;
}

TextTable verdicts_table(const Json& document) {
  TextTable table{"", {"claim", "where", "the paper's learner", "", "kelpie's default", ""}, {}};
  table.left = {0, 1, 2, 3, 4, 5};
  for (const Json& claim : document["claims"]) {
    const Json& ours = claim["kelpie"];
    table.rows.push_back({text_of(claim["claim"]), text_of(claim["where"]),
                          text_of(claim["paper"]["measured"]), text_of(claim["paper"]["finding"]),
                          ours.is_null() ? "–" : text_of(ours["measured"]),
                          ours.is_null() ? "" : text_of(ours["finding"])});
  }
  return table;
}

// Mean R² of a row on every stream of the paper; `gains`: and the difference from the paper's row.
TextTable gains_table(const Json& document, bool gains) {
  TextTable table{"", {"R² at the end, mean of axes and configurations"}, {}};
  const std::vector<const Json*> studies = studies_of_the_paper(document);
  for (const Json* const study : studies) {
    table.head.push_back(fmt::format("{}, {}",
                                     (*study)["simulated"].get<bool>() ? "simulation" : "real log",
                                     text_of((*study)["split"])));
  }
  for (const Json& row : (*studies.front())["rows"]) {
    std::vector<std::string>& cells = table.rows.emplace_back(1, text_of(row["name"]));
    for (const Json* const study : studies) {
      const double r2 = mean_of_ends(*study, *find_row(*study, text_of(row["key"])));
      const double gain = r2 - mean_of_ends(*study, *find_row(*study, "paper"));
      cells.push_back(chart::decimal(r2) + (!gains        ? ""
                                            : gain >= 0.0 ? " (+" + chart::decimal(gain) + ")"
                                                          : " (" + chart::decimal(gain) + ")"));
    }
  }
  return table;
}

// R² of every row at the end of each configuration, by axis.
TextTable ends_table(const Json& study) {
  TextTable table{title_of(study) + (study["note"] == "" ? "" : ": " + text_of(study["note"])),
                  {"R² at the end of configuration"},
                  {}};
  for (const Json& configuration : study["stages"]) {
    table.head.push_back(fmt::format("{}", configuration.get<int>() + 1));
  }
  table.head.emplace_back("seeds");
  for (const Json& row : study["rows"]) {
    std::vector<std::string>& cells = table.rows.emplace_back(1, text_of(row["name"]));
    for (std::size_t stage = 0; stage < study["stages"].size(); ++stage) {
      std::vector<std::string> axes;
      for (std::size_t axis = 0; axis < study["axes"].size(); ++axis) {
        axes.push_back(chart::decimal(end_of(row, stage, axis)));
      }
      cells.push_back(join_text(axes, " / "));
    }
    cells.push_back(fmt::format("{}", row["ends"].size()));
  }
  return table;
}

TextTable matrix_table(const Json& study) {
  TextTable table{title_of(study), {"axis", "trained on"}, {}};
  for (const Json& configuration : study["configurations"]) {
    table.head.push_back(fmt::format("tested on {}", configuration.get<int>() + 1));
  }
  table.head.insert(table.head.end(), {"γ", "C", "ε", "cross-validated R²", "training rows"});
  for (const Json& matrix : study["offline"]) {
    for (const Json& model : matrix["models"]) {
      std::vector<std::string>& cells = table.rows.emplace_back(1, text_of(matrix["axis"]));
      cells.push_back(fmt::format("{}", model["trained_on"].get<int>() + 1));
      for (const Json& r2 : model["r2"]) {
        cells.push_back(chart::decimal(number_of(r2)));
      }
      for (const char* const key : {"gamma", "c", "epsilon"}) {
        cells.push_back(text_of(model[key]));
      }
      cells.push_back(chart::decimal(number_of(model["cross_validated_r2"])));
      cells.push_back(text_of(model["training_rows"]));
    }
  }
  return table;
}

// Bars of each model, as in Fig. 3: beside each other over the configuration that it is tested on.
std::string matrix_figure(const Json& study, std::size_t axis) {
  chart::PlotAxis tested{"tested on configuration"};
  for (const Json& configuration : study["configurations"]) {
    tested.names.push_back(fmt::format("{}", configuration.get<int>() + 1));
  }
  const auto count = static_cast<double>(tested.names.size());
  tested.range = chart::Extent{-0.5, count - 0.5};
  chart::Figure figure(tested, {"R² on held-out rows", chart::Extent{kLowestR2, 1.0}},
                       text_of(study["axes"][axis]) + ": off-line models on each configuration");
  const Json& models = study["offline"][axis]["models"];
  for (std::size_t i = 0; i < models.size(); ++i) {
    // A place for the bar of every model, so that bars are as wide as a place.
    std::vector<chart::Point> bars;
    for (std::size_t k = 0; k < models.size(); ++k) {
      for (std::size_t j = 0; j < models.size(); ++j) {
        const double place = 0.25 * (static_cast<double>(j) - 0.5 * (count - 1.0));
        bars.push_back({static_cast<double>(k) + place,
                        j == i ? number_of(models[i]["r2"][k]) : std::nan("")});
      }
    }
    figure.bars(bars, i, fmt::format("trained on {}", i + 1));
  }
  return figure.html(text_of(study["axes"][axis]) + ", " + title_of(study) + ".");
}

std::vector<chart::Point> points_of(const Json& x, const Json& y) {
  std::vector<chart::Point> points;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    points.push_back({number_of(x[i]), number_of(y[i])});
  }
  return points;
}

// R² of rows on an axis over the time: mean of the seeds as a line, least to greatest as a band,
// the off-line baseline as steps.
std::string stream_figure(const Json& study, const std::vector<std::string>& keys,
                          std::size_t axis) {
  chart::Figure figure({"time [s]"}, {"R² on held-out rows", chart::Extent{kLowestR2, 1.0}},
                       text_of(study["axes"][axis]) + ": R² over the stream, " + title_of(study));
  figure.link(title_of(study));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Json& row = *find_row(study, keys[i]);
    const Json& curve = row["curves"][axis];
    std::vector<chart::Point> middle;
    std::vector<double> half;
    for (std::size_t k = 0; k < curve["low"].size(); ++k) {
      const double low = number_of(curve["low"][k]);
      const double high = number_of(curve["high"][k]);
      middle.push_back({number_of(row["time_s"][k]), 0.5 * (low + high)});
      half.push_back(0.5 * (high - low));
    }
    if (!middle.empty()) {
      figure.band(middle, half, i);
    }
    figure.line(points_of(row["time_s"], curve["r2"]), i, text_of(row["name"]));
  }
  const Json& row = *find_row(study, keys.front());
  std::vector<chart::Point> steps;
  double from = 0.0;
  for (std::size_t stage = 0; stage < study["stages"].size(); ++stage) {
    const auto last = std::ranges::lower_bound(row["samples"], study["stage_samples"][stage]);
    const double to =
        number_of(row["time_s"][static_cast<std::size_t>(last - row["samples"].begin())]);
    if (of_the_paper(study)) {
      const double r2 = end_of(*find_row(study, "offline"), stage, axis);
      steps.insert(steps.end(), {{from, r2}, {to - 0.5, r2}});
    }
    if (stage + 1 < study["stages"].size()) {
      figure.mark(to, fmt::format("configuration {}", study["stages"][stage + 1].get<int>() + 1));
    }
    from = to;
  }
  figure.line(steps, kBaselineStyle, "off-line baseline");
  return figure.html(text_of(study["axes"][axis]) + ", " + title_of(study) +
                     "; the figure ends at −0.2.");
}

// The held-out rows at the end of a stage, true and predicted.
std::string prediction_figure(const Json& study, std::size_t axis, std::size_t stage) {
  const Json& row = *find_row(study, "paper");
  const Json& shown = row["predictions"][axis][stage];
  chart::Figure figure({"time [s]"}, {text_of(study["axes"][axis])},
                       text_of(study["axes"][axis]) + ": held-out rows, true and predicted");
  figure.line(points_of(shown["time_s"], shown["truth"]), 0, "true");
  figure.line(points_of(shown["time_s"], shown["predicted"]), 1, "predicted");
  return figure.html(fmt::format("{}, {}, end of configuration {}; R² {} on all held-out rows.",
                                 text_of(study["axes"][axis]), title_of(study),
                                 study["stages"][stage].get<int>() + 1,
                                 chart::decimal(number_of(row["ends"][0][stage][axis]))));
}

// The words of the paper on Fig. 4 beside the curve measured.
TextTable curve_table(const Json& document) {
  TextTable table{"", {"the paper's curve, real data"}, {}};
  table.rows = {{"0 s: “very low performance”; R² after 200 samples"},
                {"“a gradual increase”; after 1,000 samples"},
                {"to 3,000 s: “comparable to the offline baseline”; end of configuration 1"},
                {"3,000 s: “a drop”; lowest within 1,000 samples"},
                {"5,700 s: “similar behaviour”; end of 2, then lowest"},
                {"8,300 s: again at the baseline; end of 3"}};
  for (const Json* const study : studies_of_the_paper(document)) {
    const Json& row = *find_row(*study, "paper");
    table.head.push_back(title_of(*study));
    double first = 0.0;
    for (const Json& curve : row["curves"]) {
      first += number_of(curve["r2"][0]) / static_cast<double>(row["curves"].size());
    }
    const std::size_t stages = (*study)["stages"].size();
    const auto lowest = [&](std::size_t i) { return number_of(row["switches"][i]["lowest"]); };
    const std::array<std::string, 6> cells{
        chart::decimal(first),
        chart::decimal(number_of(row["start"])),
        chart::decimal(mean_end(row, 0)),
        stages > 1 ? chart::decimal(lowest(0)) : "not public",
        stages > 2 ? chart::decimal(mean_end(row, 1)) + ", " + chart::decimal(lowest(1))
                   : "not public",
        stages > 2 ? chart::decimal(mean_end(row, 2)) : "not public"};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      table.rows[i].push_back(cells.at(i));
    }
  }
  return table;
}

// Table I beside the values found.
TextTable parameters_table(const Json& document) {
  TextTable table{"", {"surge, sway, yaw", "Table I"}, {}};
  table.rows = {
      {"ε", "0.1, 0.001, 0.1"},   {"C", "10, 10, 10"}, {"γ", "100, 40, 20"}, {"buffer size", "900"},
      {"k", "10, 10, 1"},         {"a", "0.99"},       {"b", "0.01"},        {"ξ", "0.99"},
      {"cross-validated R²", "–"}};
  constexpr std::array kNames{"epsilon", "c", "gamma", "buffer", "k", "a", "b", "xi"};
  const auto docs = setting_docs();
  const auto printed = [&](std::string_view name) {
    const auto doc = std::ranges::find(docs, name, &SettingText::name);
    const auto preset = std::ranges::find(preset_names(), "paper") - preset_names().begin();
    return doc->presets.at(static_cast<std::size_t>(preset));
  };
  for (const Json* const study : studies_of_the_paper(document)) {
    table.head.push_back(title_of(*study));
    const Json& found = (*study)["found"]["paper"];
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      std::vector<std::string> values;
      for (const Json& axis : found) {
        values.push_back(i == kNames.size()
                             ? chart::decimal(number_of(axis["cross_validated_r2"]))
                             : text_of(axis["values"].value(kNames.at(i), Json("as printed"))));
      }
      const bool searched = i == kNames.size() || found[0]["values"].contains(kNames.at(i));
      table.rows[i].push_back(searched ? join_text(values, ", ") : printed(kNames.at(i)));
    }
  }
  return table;
}

Part opening(const Json& document) {
  const Json& plan = document["plan"];
  const bool quick = plan["quick"].get<bool>();
  Part part{
      kTitle,
      {"Wehbe, Hildebrandt & Kirchner, “A Framework for On-line Learning of Underwater Vehicles "
       "Dynamic Models”, 2019. The paper proposes an incremental SVR with four nodes around the "
       "training: including (eq. 9, 10), outlier rejection (eq. 11, 12), forgetting by density and "
       "time stamp (eq. 7, 8), and a buffer of 900. “The paper” below is this learner by the "
       "paper's rules, with the plain kernel of eq. 6 and the full covariance; settings are "
       "searched "
       "by cross-validation on the training rows of configuration 1 alone. Two readings were "
       "needed: "
       "targets are standardised, and up to 50 samples without weight stay, since with Σβ = 0 a "
       "first "
       "sample alone has no weight.",
       fmt::format(
           "Command: {} (kelpie {}), seeds {} to {}. reproduction.json holds every number of "
           "this page by stream, split and seed.",
           text_of(document["command"]), text_of(document["kelpie"]), plan["first_seed"].get<int>(),
           plan["first_seed"].get<int>() + plan["seeds"].get<int>() - 1),
       document["real_log"].get<bool>()
           ? "Of the paper's three real configurations only the first is public: configurations 2 "
             "and 3 exist in simulation alone. The simulator is this project's own (30,000 samples "
             "at 1 Hz, thrusters driven by sinusoids of 20 to 70 s, a damaged thruster, more "
             "damping); the paper gives no parameters."
           : "The real log was not there: everything below is simulation, by this project's own "
             "simulator.",
       "Random split: a fifth of the rows, as in the paper; neighbours in time leak. Blocks: the "
       "last of every five blocks of 400 rows; harder and more honest. R² is on held-out rows of "
       "the "
       "configuration then running."}};
  if (plan["seeds"] == 1 && !quick) {
    part.words.emplace_back("A single seed: the spread over seeds is not measured here.");
  }
  if (quick) {
    part.words.push_back(fmt::format(
        "This is the quick version: simulated phases at {:.0f} % of their length, the first {} "
        "rows "
        "of the real log, one seed, few values in each search. It can't show what forgetting does: "
        "on the short real log the buffer never fills, so FIFO equals the paper's learner there; "
        "nor "
        "the spread over seeds, nor the settings of the full run. Its figures are not those of the "
        "full run.",
        100.0 * plan["scenario_share"].get<double>(),
        chart::grouped(plan["real_rows"].get<int>())));
  }
  return part;
}

Part streams_part(const Json& document) {
  Part part{
      "Data and seeds",
      {"Seed N draws simulation and random split alike. The blocks of the real log are the same "
       "for every seed, so there is a single run. Off-line models, searches and Table I as "
       "printed use the first seed. Folds are interleaved for the random split and contiguous "
       "for blocks, so that each search aims at the score of its split; a search goes through "
       "the settings in turn."}};
  TextTable& streams = part.tables.emplace_back(
      TextTable{"", {"stream", "source", "split", "training rows", "held out"}, {}});
  streams.left = {0, 1, 2};
  for (const Json& study : document["streams"]) {
    streams.rows.push_back({title_of(study), text_of(study["source"]), text_of(study["split_rule"]),
                            text_of(study["training_rows"]), text_of(study["held_out_rows"])});
  }
  return part;
}

Part settings_part(const Json& document) {
  Part part{"Settings and times", {}};
  part.folded = true;
  for (const Json& study : document["streams"]) {
    TextTable& table = part.tables.emplace_back(
        TextTable{title_of(study), {"row", "settings", "update, median", "99 %"}, {}});
    table.left = {0, 1};
    for (const Json& row : study["rows"]) {
      table.rows.push_back({text_of(row["name"]), text_of(row["settings"]),
                            chart::duration(number_of(row["update_us"]["median"])),
                            chart::duration(number_of(row["update_us"]["p99"]))});
    }
  }
  return part;
}

std::vector<Part> figure_parts(const Json& document, bool drawn) {
  Part offline{
      "Fig. 3: off-line models on every configuration",
      {"LIBSVM on all training rows of one configuration, R² on the held-out rows of each."}};
  Part online{"Fig. 4: R² over the stream",
              {"The paper's learner from nothing; dashed: the off-line baseline."}};
  Part compared{
      "Fig. 5: learners compared",
      {"The paper's learner, FIFO with the same settings, SOSVR with as large a dictionary "
       "and settings of its own; beside them kelpie's default and the reader's entries. A "
       "second pair with a buffer of 300 shows what forgetting does."}};
  Part predicted{"Fig. 6: predictions",
                 {"The last held-out rows of each configuration, predicted by the paper's learner "
                  "when the configuration ended; blocks split, first seed; m/s², m/s², rad/s²."}};
  online.tables = {curve_table(document)};
  for (const Json* const study : studies_of_the_paper(document)) {
    offline.tables.push_back(matrix_table(*study));
    std::vector<std::string> keys{"paper", "fifo", "sosvr", "default"};
    for (const Json& row : (*study)["rows"]) {
      if (row["kind"] == "entry") {
        keys.push_back(text_of(row["key"]));
      }
    }
    for (std::size_t axis = 0; drawn && axis < (*study)["axes"].size(); ++axis) {
      offline.figures.push_back(matrix_figure(*study, axis));
      online.figures.push_back(stream_figure(*study, {"paper"}, axis));
      compared.figures.push_back(stream_figure(*study, keys, axis));
      compared.figures.push_back(stream_figure(*study, {"paper_small", "fifo_small"}, axis));
      for (std::size_t i = 0; (*study)["split"] == "blocks" && i < (*study)["stages"].size(); ++i) {
        predicted.figures.push_back(prediction_figure(*study, axis, i));
      }
    }
  }
  return {offline, online, compared, predicted};
}

// The whole page; `drawn`: with figures.
std::vector<Part> parts_of(const Json& document, bool drawn) {
  std::vector<Part> parts{
      opening(document),
      {"What holds",
       {"Each claim, on every stream and split (the single verdicts with their rules are below). "
        "Verdicts follow from the figures; the rules are ours, since the paper gives no "
        "thresholds."},
       {claims_table(document)}},
      {"What each addition is worth",
       {"Rows of three kinds. The paper: settings searched, and Table I with γ read as a "
        "reciprocal "
        "and as printed. Additions: the searched settings of the paper's learner with one addition "
        "of "
        "kelpie's, then all additions, then kelpie's learner of one axis with kelpie's own values "
        "(learner = svr; chosen earlier, also on training rows of this log). kelpie's default: "
        "what "
        "kelpie learn runs. Between them the baselines, with the paper's buffer and kernel. In "
        "parentheses the difference from the first row."},
       {gains_table(document, true)}}};
  std::ranges::move(figure_parts(document, drawn), std::back_inserter(parts));
  parts.push_back(
      {"Table I: hyper-parameters",
       {"γ as eq. 6 has it, κ = exp(−γ d²). The printed 100, 40, 20 make a kernel so narrow that "
        "only neighbours in time help; read as reciprocals they work."},
       {parameters_table(document)}});
  Part ends{"Every row, by axis", {"R² surge / sway / yaw, mean of the seeds."}};
  for (const Json& study : document["streams"]) {
    ends.tables.push_back(ends_table(study));
  }
  Part verdicts{"Every verdict", {}, {verdicts_table(document)}};
  std::string last;
  for (const Json& claim : document["claims"]) {
    if (claim["claim"] != last) {
      last = text_of(claim["claim"]);
      verdicts.words.push_back(last + " Rule: " + text_of(claim["rule"]));
    }
  }
  const Part door{
      "A learner of your own",
      {"kelpie-lab reproduce --entry my_learner.py:Sgd puts a class with partial_fit(X, y) "
       "and predict(X) into every table and figure, on the same rows. "
       "python/kelpie/benchmark/README.md has such a class in 20 lines; the open "
       "benchmark runs the class by its track “paper”."}};
  parts.insert(parts.end(),
               {door, ends, verdicts, streams_part(document), settings_part(document)});
  return parts;
}

std::string markdown_of(const TextTable& table) {
  std::string text = table.title.empty() ? "" : "### " + table.title + "\n\n";
  const auto line = [&](const std::vector<std::string>& cells) {
    text += "| " + join_text(cells, " | ") + " |\n";
  };
  line(table.head);
  line(std::vector<std::string>(table.head.size(), "---"));
  std::ranges::for_each(table.rows, line);
  return text + "\n";
}

}  // namespace

std::string reproduction_html(const Json& document) {
  std::vector<Part> parts = parts_of(document, true);
  std::string lead = chart::heading(1, parts.front().title);
  std::vector<chart::Section> sections;
  for (const Part& part : parts) {
    std::string body;
    for (const std::string& words : part.words) {
      body += chart::paragraph("note", words);
    }
    body += chart::html_tables(part.tables) + chart::panels(part.figures);
    if (&part == &parts.front()) {
      lead += body;
    } else {
      sections.push_back({part.title, body, part.folded});
    }
  }
  return chart::html_page(std::string("kelpie: ") + kTitle, lead, sections);
}

std::string reproduction_markdown(const Json& document) {
  std::string text;
  for (const Part& part : parts_of(document, false)) {
    if (part.folded) {
      continue;
    }
    text += (text.empty() ? "# " : "## ") + part.title + "\n\n";
    for (const std::string& words : part.words) {
      text += words + "\n\n";
    }
    for (const TextTable& table : part.tables) {
      text += markdown_of(table);
    }
  }
  text.pop_back();
  return text;
}

std::string reproduction_table(const Json& document) {
  TextTable gains = gains_table(document, false);
  gains.head.front() = "R² at the end, mean";
  std::string said = chart::table_text(gains);
  for (const std::vector<std::string>& cells : claims_table(document).rows) {
    said +=
        fmt::format("{}\n  the paper: {}; kelpie's default: {}\n", cells[0], cells[1], cells[2]);
  }
  return said + (document["plan"]["quick"].get<bool>()
                     ? "\nThe quick version: where the buffer never fills, FIFO equals the paper's "
                       "learner.\n"
                     : "\n");
}

}  // namespace kelpie::lab
