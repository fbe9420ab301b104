// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "study/result.hpp"
#include "study/summary.hpp"

namespace kelpie::study {

// The tables of a StreamResult: a line for each number. The saved state of a stream
// (study/stream.cpp) and result.json (format/result_json.cpp) follow from them, both in the
// order of the lines. docs/reference/files.md explains every key.

/// Version of the saved state of a stream; goes up with every change of a saved number.
inline constexpr const char* kStreamVersion = "1";

/// One line of a table.
template <typename Saved, typename Shown>
struct ResultField {
  std::string_view key;  ///< in result.json, a dot before the key of an inner object; empty: none
  Saved saved;           ///< member in the saved state; nullptr: derived, not saved
  Shown shown;           ///< member or function of the item for result.json; nullptr: not shown
  bool finite = true;    ///< the saved number can't be NaN or infinite
};

/// A number of the saved state and of result.json, which may differ where `shown` is given.
template <typename Member>
constexpr ResultField<Member, Member> saved(std::string_view key, Member member) {
  return {key, member, member};
}
template <typename Member, typename Shown>
constexpr ResultField<Member, Shown> saved_or_nan(std::string_view key, Member member,
                                                  Shown shown) {
  return {key, member, shown, false};
}

/// A number of the saved state alone.
template <typename Member>
constexpr ResultField<Member, std::nullptr_t> state(Member member) {
  return {{}, member, nullptr, false};
}

/// A number of result.json alone: a member, or a function of the item.
template <typename Shown>
constexpr ResultField<std::nullptr_t, Shown> shown(std::string_view key, Shown what) {
  return {key, nullptr, what};
}

inline std::optional<std::string> unless_empty(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

/// The table of an Item.
template <typename Item>
inline constexpr auto kFields = std::tuple<>();

/// Whether result.json has a list of Items as an array for each field.
template <typename Item>
inline constexpr bool kInColumns = false;

template <>
inline constexpr auto kFields<ChangeFound> = std::tuple{
    saved("samples", &ChangeFound::samples),     saved("time_s", &ChangeFound::time_s),
    saved("since_s", &ChangeFound::since_s),     saved("recalled", &ChangeFound::recalled),
    saved("withdrawn", &ChangeFound::withdrawn),
};

template <>
inline constexpr bool kInColumns<OutliersFound> = true;
template <>
inline constexpr auto kFields<OutliersFound> = std::tuple{
    saved("samples", &OutliersFound::samples),
    saved("time_s", &OutliersFound::time_s),
    saved_or_nan("target", &OutliersFound::target, &OutliersFound::target),
};

template <>
inline constexpr auto kFields<StageEnd> = std::tuple{
    state(&StageEnd::configuration), state(&StageEnd::samples), state(&StageEnd::r2),
    state(&StageEnd::time_s),        state(&StageEnd::truth),   state(&StageEnd::predicted),
};

template <>
inline constexpr bool kInColumns<ValidationPoint> = true;
template <>
inline constexpr auto kFields<ValidationPoint> = std::tuple{
    saved("samples", &ValidationPoint::samples),
    saved("time_s", &ValidationPoint::time_s),
    saved_or_nan("r2", &ValidationPoint::r2, served_r2),
    shown("buffer", [](const ValidationPoint& point) { return point.status.buffer; }),
    shown("support_vectors",
          [](const ValidationPoint& point) { return point.status.support_vectors; }),
    saved("configuration", &ValidationPoint::configuration),
    state(&ValidationPoint::status),
    state(&ValidationPoint::coefficients),
    state(&ValidationPoint::errors),
};

template <>
inline constexpr auto kFields<Coverage> = std::tuple{
    shown("samples", &Coverage::samples),           shown("held", &Coverage::share),
    shown("lowest_of_500", &Coverage::lowest),      shown("mean_width", &Coverage::mean_width),
    shown("median_width", &Coverage::median_width),
};

template <>
inline constexpr auto kFields<Baseline> = std::tuple{
    shown("r2_final", &Baseline::r2_final),
    shown("prequential_r2", &Baseline::prequential_r2),
};

template <>
inline constexpr auto kFields<Baselines> = std::tuple{
    shown("least_squares", &Baselines::least_squares),
    shown("without_commands", &Baselines::without_commands),
    shown("mean", &Baselines::mean),
    shown("last_value", &Baselines::last_value),
};

template <>
inline constexpr auto kFields<NoveltyBin> = std::tuple{
    shown("from", &NoveltyBin::from), shown("to", &NoveltyBin::to),
    shown("rows", &NoveltyBin::rows), shown("rms_error", &NoveltyBin::rms_error),
    shown("held", &NoveltyBin::held),
};

template <>
inline constexpr auto kFields<Quantiles> = std::tuple{
    shown("median", &Quantiles::median),
    shown("p99", &Quantiles::p99),
    shown("max", &Quantiles::max),
};

template <>
inline constexpr auto kFields<AlignmentResult> = std::tuple{
    shown("shift_s", [](const AlignmentResult& found) { return found.alignment.lag_s; }),
    shown("rows", [](const AlignmentResult& found) { return found.alignment.rows; }),
    shown("commands", [](const AlignmentResult& found) { return found.alignment.commands; }),
    shown("gain", &AlignmentResult::gain),
    shown("why", &AlignmentResult::why),
};

/// Its `coefficients` stand behind these, in format/result_json.cpp.
template <>
inline constexpr auto kFields<AxisResult> = std::tuple{
    shown("name", &AxisResult::name),
    shown("unit", [](const AxisResult& axis) { return unless_empty(axis.unit); }),
    shown("r2.final", &AxisResult::r2_final),
    shown("r2.mean", &AxisResult::r2_mean),
    shown("r2.min_after_1000", &AxisResult::r2_min_after_1000),
    shown("prequential_r2", &AxisResult::prequential_r2),
    shown("yardsticks", &AxisResult::baselines),
    shown("intervals", &AxisResult::coverage),
    shown("disturbance.prequential_r2", &AxisResult::corrected_r2),
    shown("disturbance.intervals", &AxisResult::corrected_coverage),
    shown("members", &AxisResult::members),
    shown("novelty", &AxisResult::novelty),
    shown("buffer", [](const AxisResult& axis) { return axis.status.buffer; }),
    shown("support_vectors", [](const AxisResult& axis) { return axis.status.support_vectors; }),
    shown("update_us", [](const AxisResult& axis) { return quantiles_of(axis.update_us); }),
    shown("kkt_gap", [](const AxisResult& axis) { return served_gap(axis.status); }),
    shown("decisions", [](const AxisResult& axis) { return axis.status.tally; }),
    shown("changes", &AxisResult::changes),
    shown("outliers", &AxisResult::outliers),
    shown("validation", &AxisResult::validation),
};

/// Its `settings`, `diagnosis` and `axes` stand behind these, in format/result_json.cpp.
template <>
inline constexpr auto kFields<StreamResult> = std::tuple{
    shown("split", &StreamResult::split),
    shown("seed", &StreamResult::seed),
    shown("from", [](const StreamResult& result) { return unless_empty(result.from); }),
    shown("nominal", [](const StreamResult& result) { return unless_empty(result.nominal); }),
    shown("scales", &StreamResult::scales),
    shown("alignment", &StreamResult::alignment),
    shown("current", &StreamResult::current),
    shown("training_rows", &StreamResult::training_rows),
    shown("held_out_rows", &StreamResult::held_out_rows),
    shown("samples_shown", &StreamResult::samples_shown),
    shown("interrupted", &StreamResult::interrupted),
    shown("memory_bytes",
          [](const StreamResult& result) {
            return result.memory_bytes > 0 ? std::optional(result.memory_bytes) : std::nullopt;
          }),
};

/// Calls `visit` with every line of an Item's table.
template <typename Item, typename Visit>
constexpr void for_each_field(const Visit& visit) {
  std::apply([&](const auto&... fields) { (visit(fields), ...); }, kFields<Item>);
}

}  // namespace kelpie::study
