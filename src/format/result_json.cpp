// SPDX-License-Identifier: Apache-2.0
#include "format/result_json.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <vector>

#include "format/diagnosis_json.hpp"
#include "kelpie/core/text.hpp"
#include "study/summary.hpp"
#include "study/terms.hpp"

namespace kelpie::format {
namespace {

using file::Json;
using file::list;
using file::number;
using file::text_or_null;

// A number where the text is one (whole numbers stay whole), else null.
Json number_in(const std::string& text) {
  std::int64_t whole = 0;
  const char* const end = text.data() + text.size();
  if (const auto [stop, error] = std::from_chars(text.data(), end, whole);
      error == std::errc{} && stop == end) {
    return whole;
  }
  double value = 0.0;
  return parse_number(text, value) ? number(value) : Json(nullptr);
}

Json setting(const std::string& text) {
  const std::vector<std::string> parts = split_text(text, ',');
  Json numbers = Json::array();
  for (const std::string& part : parts) {
    numbers.push_back(number_in(part));
    if (numbers.back().is_null()) {
      return text;
    }
  }
  return parts.size() == 1 ? numbers.front() : numbers;
}

Json change(const study::ChangeFound& found) {
  return {{"samples", found.samples},
          {"time_s", found.time_s},
          {"since_s", found.since_s},
          {"recalled", found.recalled},
          {"withdrawn", found.withdrawn}};
}

Json outliers(const std::vector<study::OutliersFound>& steps) {
  using Found = study::OutliersFound;
  return {{"samples", list(steps, [](const Found& found) { return Json(found.samples); })},
          {"time_s", list(steps, [](const Found& found) { return number(found.time_s); })},
          {"target", list(steps, [](const Found& found) { return number(found.target); })}};
}

Json decisions(const Tally& tally) {
  Json totals;
  for (const TallyField& field : tally_fields()) {
    totals[std::string(field.key)] = tally.*field.total;
  }
  return totals;
}

Json validation(const std::vector<study::ValidationPoint>& points) {
  using Point = study::ValidationPoint;
  return {{"samples", list(points, [](const Point& p) { return Json(p.samples); })},
          {"time_s", list(points, [](const Point& p) { return number(p.time_s); })},
          {"r2", list(points, [](const Point& p) { return number(study::served_r2(p)); })},
          {"buffer", list(points, [](const Point& p) { return Json(p.status.buffer); })},
          {"support_vectors",
           list(points, [](const Point& p) { return Json(p.status.support_vectors); })},
          {"configuration", list(points, [](const Point& p) { return Json(p.configuration); })}};
}

// Null where the learner has none.
Json coefficients(const study::AxisResult& axis) {
  if (axis.terms.empty()) {
    return nullptr;
  }
  using Point = study::ValidationPoint;
  std::vector<Point> points;
  std::ranges::copy_if(axis.validation, std::back_inserter(points),
                       [](const Point& p) { return !p.coefficients.empty(); });
  const std::vector<study::TermView> views = study::term_views(axis);
  Json values = Json::array();
  Json errors = Json::array();
  for (std::size_t k = 0; k < axis.terms.size(); ++k) {
    values.push_back(list(points, [k](const Point& p) { return number(p.coefficients[k]); }));
    errors.push_back(list(points, [k](const Point& p) { return number(p.errors[k]); }));
  }
  return {
      {"terms", list(axis.terms, [](const study::TermInfo& term) { return Json(term.formula); })},
      {"units",
       list(axis.terms, [](const study::TermInfo& term) { return text_or_null(term.unit); })},
      {"term_rms", list(axis.terms, [](const study::TermInfo& term) { return number(term.rms); })},
      {"error", list(axis.terms, [](const study::TermInfo& term) { return number(term.error); })},
      {"final", list(views, [](const study::TermView& view) { return number(view.value); })},
      {"samples", list(points, [](const Point& p) { return Json(p.samples); })},
      {"time_s", list(points, [](const Point& p) { return number(p.time_s); })},
      {"configuration", list(points, [](const Point& p) { return Json(p.configuration); })},
      {"values", values},
      {"errors", errors}};
}

// Null where no sample was predicted with an interval.
Json intervals(const study::Coverage& coverage) {
  if (coverage.samples == 0) {
    return nullptr;
  }
  return {{"samples", coverage.samples},
          {"held", number(coverage.share)},
          {"lowest_of_500", number(coverage.lowest)},
          {"mean_width", number(coverage.mean_width)},
          {"median_width", number(coverage.median_width)}};
}

// One step ahead with it.
Json disturbance(const study::AxisResult& axis) {
  return {{"prequential_r2", number(axis.corrected_r2)},
          {"intervals", intervals(axis.corrected_coverage)}};
}

Json novelty(const std::vector<study::NoveltyBin>& bins) {
  return list(bins, [](const study::NoveltyBin& bin) {
    return Json{{"from", bin.from},
                {"to", bin.to},
                {"rows", bin.rows},
                {"rms_error", number(bin.rms_error)},
                {"held", number(bin.held)}};
  });
}

Json baselines(const study::Baselines& baselines) {
  const auto both = [](const study::Baseline& baseline) {
    return Json{{"r2_final", number(baseline.r2_final)},
                {"prequential_r2", number(baseline.prequential_r2)}};
  };
  return {{"least_squares", both(baselines.least_squares)},
          {"mean", both(baselines.mean)},
          {"last_value", both(baselines.last_value)}};
}

// Null where there is one learner.
Json members(const study::AxisResult& axis) {
  Json shares;
  for (const MemberShare& member : axis.members) {
    shares[member.name] = number(member.share);
  }
  return shares;
}

// Null where nobody asked for one.
Json alignment(const AlignmentFound& found) {
  if (found.why.empty()) {
    return nullptr;
  }
  return {{"shift_s", found.alignment.lag_s},
          {"rows", found.alignment.rows},
          {"commands", found.alignment.commands},
          {"gain", number(found.gain)},
          {"why", found.why}};
}

Json axis_object(const study::AxisResult& axis) {
  const study::Quantiles times = study::quantiles_of(axis.update_us);
  return {
      {"name", axis.name},
      {"unit", text_or_null(axis.unit)},
      {"r2",
       {{"final", number(axis.r2_final)},
        {"mean", number(axis.r2_mean)},
        {"min_after_1000", number(axis.r2_min_after_1000)}}},
      {"prequential_r2", number(axis.prequential_r2)},
      {"yardsticks", baselines(axis.baselines)},
      {"intervals", intervals(axis.coverage)},
      {"disturbance", disturbance(axis)},
      {"members", members(axis)},
      {"novelty", novelty(axis.novelty)},
      {"buffer", axis.status.buffer},
      {"support_vectors", axis.status.support_vectors},
      {"update_us",
       {{"median", number(times.median)}, {"p99", number(times.p99)}, {"max", number(times.max)}}},
      {"kkt_gap", number(study::served_gap(axis.status))},
      {"decisions", decisions(axis.status.tally)},
      {"changes", list(axis.changes, change)},
      {"outliers", outliers(axis.outliers)},
      {"validation", validation(axis.validation)},
      {"coefficients", coefficients(axis)}};
}

}  // namespace

Json dataset_json(const study::StreamResult& result) {
  return {{"path", result.source},
          {"rows", result.rows_read},
          {"rows_skipped", result.rows_skipped},
          {"rate_hz", number(result.rate_hz)},
          {"inputs", result.input_names}};
}

std::string result_json(const study::StreamResult& result) {
  Json settings = Json::object();
  for (const auto& [name, value] : result.settings) {
    settings[name] = setting(value);
  }
  const Json memory = result.memory_bytes > 0 ? Json(result.memory_bytes) : Json(nullptr);
  const Json document = {{"format", "kelpie-result"},
                         {"version", 1},
                         {"dataset", dataset_json(result)},
                         {"split", result.split},
                         {"seed", result.seed},
                         {"from", file::text_or_null(result.from)},
                         {"scales", result.scales},
                         {"alignment", alignment(result.alignment)},
                         {"training_rows", result.training_rows},
                         {"held_out_rows", result.held_out_rows},
                         {"samples_shown", result.samples_shown},
                         {"interrupted", result.interrupted},
                         {"memory_bytes", memory},
                         {"settings", settings},
                         {"diagnosis", diagnosis_object(result)},
                         {"axes", list(result.axes, axis_object)}};
  return file::json_text(document);
}

}  // namespace kelpie::format
