// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "lab/contenders.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::lab {

/// The rows of the published experiment of Tesnar, Wehbe & Valdenegro-Toro 2025 (arXiv:2504.04583)
/// on the log of AUV Dagon: the first row is dropped; of the others every fifth, starting with the
/// second, is for testing; of the rest every fourth, starting with the second, for validation; what
/// remains is shown in the order of time.
struct PublishedRows {
  std::vector<std::size_t> stream;  ///< the first kPublishedBuffer of them fill the buffer
  std::vector<std::size_t> validation;
  std::vector<std::size_t> test;
};

inline constexpr std::size_t kPublishedBuffer = 100;
inline constexpr std::size_t kPublishedLogRows = 11'567;

/// Requires rows > kPublishedBuffer. The rule leaves 6,940 of the log's rows to the stream; their
/// run ends one row earlier (6,839 steps after the first 100), and so does ours.
PublishedRows published_rows(std::size_t rows);

/// One learner on that stream. R² is the mean over the axes, on the judged rows.
struct PublishedRun {
  std::string name;
  std::string settings;
  std::vector<std::size_t> steps{};  ///< after the initial buffer, at every look
  std::vector<double> r2{};
  double mean = 0.0;
  double minimum = 0.0;
  double end = 0.0;
  double mean_late = 0.0;  ///< from step 1,000 on; NaN where there are none
  double minimum_late = 0.0;
};

/// What they published, read off their curves.
struct PublishedFigure {
  const char* name;
  double mean;
};
inline constexpr std::array<PublishedFigure, 5> kPublished{{{"FIFO", 0.081},
                                                            {"first in, random out", 0.367},
                                                            {"random in, random out", 0.527},
                                                            {"greedy", 0.632},
                                                            {"threshold", 0.606}}};
/// Their "threshold" from step 1,000 on, and their off-line model.
inline constexpr double kPublishedLateMean = 0.717;
inline constexpr double kPublishedLateMinimum = 0.506;
inline constexpr double kPublishedEnd = 0.641;
inline constexpr double kPublishedOffline = 0.97;

/// With a buffer of 100, the plain kernel, scaled by the first 100 samples: our learner with the
/// settings that did best of 90 drawn at random on the validation rows; FIFO with these, and with
/// those of the 90 that did best for FIFO; our learner with its default preset.
std::vector<Contender> published_contenders(std::size_t axes);

/// Shows `stream` to one learner per axis and judges them on `judged` after every `every`-th step.
/// `keep_going` as in StreamOptions.
PublishedRun run_published(const log::Dataset& data, const std::vector<std::size_t>& stream,
                           const std::vector<std::size_t>& judged, const Contender& contender,
                           std::size_t every, const std::function<bool(std::size_t)>& keep_going);

}  // namespace kelpie::lab
