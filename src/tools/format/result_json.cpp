// SPDX-License-Identifier: Apache-2.0
#include "format/result_json.hpp"

#include <algorithm>
#include <charconv>
#include <functional>
#include <iterator>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/text.hpp"
#include "format/diagnosis_json.hpp"
#include "format/model_parts.hpp"
#include "study/result_fields.hpp"
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

// The JSON of each type that the tables of study/result_fields.hpp show.
struct Shown {
  static Json of(double value) { return number(value); }
  static Json of(const std::string& text) { return text; }
  template <typename Value>
  static Json of(const std::optional<Value>& value) {
    return value ? of(*value) : Json(nullptr);
  }
  // Null where no sample was predicted with an interval.
  static Json of(const study::Coverage& coverage) {
    return coverage.samples == 0 ? Json(nullptr) : fields(coverage);
  }
  // Null where nobody asked for an alignment.
  static Json of(const AlignmentResult& found) {
    return found.why.empty() ? Json(nullptr)
                             : fields(found, {{"actuators", actuators_json(found.alignment)}});
  }
  // Null where nobody looked for a current, or the log has no heading.
  static Json of(const CurrentResult& found) {
    return found.why.empty() ? Json(nullptr)
                             : Json{{"current", current_json(found.current)},
                                    {"gain", number(found.gain)},
                                    {"why", found.why}};
  }
  static Json of(const Tally& tally) {
    Json totals;
    for (const TallyField& field : tally_fields()) {
      totals[std::string(field.key)] = tally.*field.total;
    }
    return totals;
  }
  // Null where the axis has one learner.
  static Json of(const std::vector<MemberShare>& members) {
    Json shares;
    for (const MemberShare& member : members) {
      shares[member.name] = number(member.share);
    }
    return shares;
  }
  template <typename Item>
  static Json of(const std::vector<Item>& items) {
    if constexpr (study::kInColumns<Item>) {
      return columns(items);
    } else {
      return list(items, [](const Item& item) { return of(item); });
    }
  }
  template <typename Item>
  static Json of(const Item& item) {
    if constexpr (std::is_integral_v<Item>) {
      return item;
    } else {
      return fields(item);
    }
  }

  // An object with the item's table, after what is in it already.
  template <typename Item>
  static Json fields(const Item& item, Json object = Json::object()) {
    each_shown<Item>(
        [&](const auto& field) { place(object, field.key) = of(std::invoke(field.shown, item)); });
    return object;
  }

  // An object with an array for each field.
  template <typename Item>
  static Json columns(const std::vector<Item>& items) {
    Json object = Json::object();
    each_shown<Item>([&](const auto& field) {
      place(object, field.key) =
          list(items, [&](const Item& item) { return of(std::invoke(field.shown, item)); });
    });
    return object;
  }

 private:
  template <typename Item, typename Visit>
  static void each_shown(const Visit& visit) {
    study::for_each_field<Item>([&](const auto& field) {
      if constexpr (!std::is_null_pointer_v<decltype(field.shown)>) {
        visit(field);
      }
    });
  }

  // "r2.final" is `final` of the object `r2`.
  static Json& place(Json& object, std::string_view key) {
    const std::size_t dot = key.find('.');
    return dot == std::string_view::npos
               ? object[std::string(key)]
               : object[std::string(key.substr(0, dot))][std::string(key.substr(dot + 1))];
  }
};

Json axis_object(const study::AxisResult& axis) {
  Json json = Shown::fields(axis);
  json["coefficients"] = coefficients(axis);
  return json;
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
  Json document = Shown::fields(
      result, {{"format", "kelpie-result"}, {"version", 1}, {"dataset", dataset_json(result)}});
  Json& settings = document["settings"] = Json::object();
  for (const auto& [name, value] : result.settings) {
    settings[name] = setting(value);
  }
  document["diagnosis"] = diagnosis_object(result);
  document["axes"] = list(result.axes, axis_object);
  return file::json_text(document);
}

}  // namespace kelpie::format
