// SPDX-License-Identifier: Apache-2.0
#include "health/card_json.hpp"
#include "core/quantile.hpp"

#include "file/json.hpp"

namespace kelpie::health {
namespace {

using file::Json;
using file::number;

constexpr int kVersion = 1;

Json estimate_json(const Estimate& estimate) {
  const double half = kNormal90 * estimate.error;
  return {
      {"value", number(estimate.value)},
      {"interval90", Json::array({number(estimate.value - half), number(estimate.value + half)})}};
}

const char* kind_name(CourseKind kind) {
  switch (kind) {
    case CourseKind::constant:
      return "constant";
    case CourseKind::drift:
      return "drift";
    case CourseKind::step:
      return "step";
    case CourseKind::undecided:
      return "undecided";
    case CourseKind::unknown:
      break;
  }
  return "unknown";
}

Json change_json(const HealthCard& card, const Change& change) {
  const Course& course = change.course;
  Json json{{"quantity", card.table.quantities[change.quantity].name},
            {"baseline", card.baselines[change.baseline].name},
            {"kind", kind_name(course.kind)},
            {"text", change_text(card, change)}};
  if (course.kind == CourseKind::unknown) {
    return json;
  }
  json["before"] = estimate_json(course.before);
  json["change"] = estimate_json(course.change);
  json["evidence_nats"] = number(course.nats);
  json["scatter"] = number(course.scatter);
  if (is_found(course)) {
    json["since_day"] = number(course.since_day);
    json["since_day_interval90"] =
        Json::array({number(course.since_low), number(course.since_high)});
    json["drift_over_step_nats"] = number(course.margin);
    json["rate_per_day"] =
        course.kind == CourseKind::drift ? estimate_json(course.rate) : Json(nullptr);
  }
  return json;
}

Json episode_json(const HealthTable& table, std::size_t i) {
  const Episode& episode = table.episodes[i];
  Json values = Json::object();
  for (std::size_t k = 0; k < table.quantities.size(); ++k) {
    const Estimate& estimate = table.estimates[i][k];
    values[table.quantities[k].name] =
        estimate.error > 0.0 ? estimate_json(estimate) : Json(nullptr);
  }
  return {{"mission", episode.mission},
          {"name", episode.name},
          {"day", number(episode.day)},
          {"hours", number(episode.hours)},
          {"estimates", values}};
}

Json card_json(const HealthCard& card) {
  Json episodes = Json::array();
  for (std::size_t i = 0; i < card.table.episodes.size(); ++i) {
    episodes.push_back(episode_json(card.table, i));
  }
  return {{"vehicle", card.vehicle},
          {"days_since", card.is_dated ? "1970-01-01" : "the first row"},
          {"quantities",
           file::list(
               card.table.quantities,
               [](const Quantity& quantity) {
                 return Json{{"name", quantity.name}, {"unit", file::text_or_null(quantity.unit)}};
               })},
          {"baselines",
           file::list(card.baselines,
                      [](const Baseline& baseline) {
                        return Json{{"name", baseline.name}, {"day", number(baseline.day)}};
                      })},
          {"changes", file::list(card.changes,
                                 [&](const Change& change) { return change_json(card, change); })},
          {"remarks",
           file::list(card.table.remarks, [](const std::string& remark) { return Json(remark); })},
          {"episodes", episodes}};
}

}  // namespace

std::string cards_json(const std::vector<HealthCard>& cards) {
  return file::json_text({{"format", "kelpie health"},
                          {"version", kVersion},
                          {"vehicles", file::list(cards, card_json)}});
}

}  // namespace kelpie::health
