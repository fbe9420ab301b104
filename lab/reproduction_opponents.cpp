// SPDX-License-Identifier: Apache-2.0
#include "lab/reproduction_sections.hpp"

#include <fmt/format.h>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "lab/reproduction_figures.hpp"

namespace kelpie::lab {
namespace {

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
  for (const PeerFigure& figure : peer_figures()) {
    std::vector<std::string> row{std::string(figure.learner), std::string(figure.update_us)};
    const auto add = [&](std::initializer_list<std::string_view> cells) {
      row.insert(row.end(), cells.begin(), cells.end());
    };
    if (stream == "unmodelled") {
      const auto& r2 = figure.unmodelled;
      add({r2[0], r2[1], r2[2], r2[3], "", r2[4]});
    } else {
      const auto& r2 = figure.outliers;
      add({"", r2[0], "", r2[1], "", r2[2]});
    }
    if (stream != "both") {
      rows.push_back(std::move(row));
    }
  }
  return chart::html_table(head, rows);
}

}  // namespace

std::string published_section(const Reproduction& result) {
  std::string text = chart::paragraph(
      "note",
      "Tesnar, Wehbe & Valdenegro-Toro 2025 (arXiv:2504.04583): neural networks with "
      "an uncertainty-driven buffer, on the real log. The first row is dropped; every "
      "fifth of the others, from the second, is for testing; every fourth of the rest, "
      "from the second, for validation; what remains streams in order. The score is the "
      "mean of the three axes' R² on the test rows. Test rows lie between training rows "
      "in time, so that, too, is a split that leaks.");
  if (result.published.empty()) {
    return text +
           chart::paragraph("note", "Not measured: the whole log of 11,567 rows was not there.");
  }
  text += chart::paragraph(
      "note", fmt::format("Scored after every {}. of the steps that follow the first 100 samples. "
                          "Settings chosen on the protocol's validation rows "
                          "(docs/reproduction.md): {}",
                          result.plan.published_every, result.published.front().settings));
  return text +
         chart::html_table(
             {"learner", "mean", "minimum", "mean from step 1,000", "minimum from 1,000", "end"},
             published_rows_of(result)) +
         published_figure(result.published);
}

std::string peers_section(const Reproduction& result) {
  std::string text = chart::paragraph(
      "note",
      "Simulated streams of this project, 10,000 rows of each of two configurations, "
      "target du. R² on held-out rows at the given samples. Above: measured now. Below: "
      "as measured by the project earlier, one core; its times are of that machine.");
  if (result.peers.empty()) {
    return text + chart::paragraph("note",
                                   result.plan.peers
                                       ? "Skipped: the streams (peer_streams/*.csv) were not there."
                                       : "Skipped in this version of the run.");
  }
  for (const std::string_view stream : kPeerStreams) {
    text += chart::heading(3, stream) + peer_table(result, stream);
  }
  return text + chart::paragraph(
                    "note",
                    "On “both”, as measured earlier (end of 0 / 2,000 after the switch; opponents "
                    "tuned again for outliers): recursive least squares with a Huber clip 0.66 / "
                    "0.48, KRLS-T 300 0.91 / 0.82, GP window 0.85 / 0.78, neural network with "
                    "replay 0.94 / 0.85, SVR on the last 900 (C 100) 0.961 / 0.967, the paper's "
                    "learner without its outlier rule (C 100) 0.989 / 0.941.");
}

}  // namespace kelpie::lab
