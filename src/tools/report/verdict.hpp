// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chart/page.hpp"
#include "chart/text_table.hpp"
#include "study/result.hpp"
#include "study/summary.hpp"

namespace kelpie::report {

/// The result in some ten lines for a terminal: what was learned from which inputs, R² of each
/// axis beside simple predictors and in words, changes of the vehicle, warnings. No line is wider
/// than 100 columns, except names.
std::string verdict_text(const study::StreamResult& result);

// The parts, for a page as well.

/// The inputs by what each is taken for: "velocities", "u, v, r"; "commands", "th1, th2; …".
chart::Facts input_facts(const study::StreamResult& result);

/// Changes of the vehicle and since when, at most kTuning.most_changes: named causes first, then
/// other models for no named cause, the axes of one time in one line.
std::vector<std::string> vehicle_lines(const study::StreamResult& result);

/// Reasons against any trust in the model: nothing learned, commands without effect.
std::vector<std::string> warning_lines(const study::StreamResult& result);

/// Reasons why no R² of this result earns a word beyond "fair": held-out stretches that are shorter
/// than the memory of the velocities, or few; no commands among the inputs; the answer among these.
std::vector<std::string> caveat_lines(const study::StreamResult& result);

/// Whether the model is of no use: a warning, or no axis predicted better than by the mean.
bool is_poor(const study::StreamResult& result);

/// How good an axis is, in words: "very good", "least squares is better by 0.06", "no better than
/// the mean", "the commands say nothing to least squares"; where the vehicle changed and the rows
/// `since` then are predicted clearly better than all, "good since 800 s (R² 0.892)". With a
/// `caveat` at most "fair".
std::string verdict_of(const study::AxisResult& axis,
                       const std::optional<study::SinceChange>& since = std::nullopt,
                       bool caveat = false);

/// The axes by how good they are: "Predictions of udot and rdot are very good, of vdot good".
std::string quality_sentence(const study::StreamResult& result);

/// The most important news of the result in one sentence without a full stop: a reason against any
/// trust, or a caveat; else the last named cause of a change, "th2 gives 60 % of its thrust (…)
/// since 1500 s"; else quality_sentence().
std::string headline(const study::StreamResult& result);

/// R² of each axis on held-out rows beside simple predictors, and verdict_of().
chart::TextTable quality_table(const study::StreamResult& result);

}  // namespace kelpie::report
