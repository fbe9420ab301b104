// SPDX-License-Identifier: Apache-2.0
#include "fleet/study_json.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include "file/json.hpp"
#include "kelpie/kelpie.h"

namespace kelpie::fleet {
namespace {

using file::Json;
using file::number;

Json spread_json(const Spread& spread) {
  return {{"runs", spread.runs},
          {"least", number(spread.least)},
          {"p10", number(spread.tenth)},
          {"median", number(spread.median)},
          {"p90", number(spread.ninetieth)}};
}

Json duel_json(const Duel& duel) {
  return {{"better", duel.better}, {"worse", duel.worse}};
}

Json learner_json(const std::string& name, const LearnerSummary& learner) {
  return {{"learner", name},
          {"r2_final", spread_json(learner.r2_final)},
          {"r2_mean", spread_json(learner.r2_mean)},
          {"one_step", spread_json(learner.one_step)},
          {"coverage", spread_json(learner.coverage)},
          {"against_least_squares", duel_json(learner.least_squares)},
          {"against_mean", duel_json(learner.mean)},
          {"best", learner.best},
          {"shortfall", spread_json(learner.shortfall)}};
}

Json trend_json(const Trend& trend, std::size_t tested) {
  return {{"missions", trend.missions.size()},
          {"early", number(trend.early)},
          {"late", number(trend.late)},
          {"chance", number(trend.chance)},
          {"stands_out", stands_out(trend, tested)}};
}

Json times_json(const LearnerTimes& times) {
  return {{"update_us", spread_json(times.update_us)},
          {"update_us_p99", spread_json(times.p99_us)},
          {"real_time_share", spread_json(times.share)},
          {"memory_bytes", spread_json(times.memory_bytes)}};
}

// A run's names, as --against looks for them.
Json place_json(const Results& results, std::size_t i) {
  const Plan& plan = results.plan();
  const Combination one = results.combinations()[i];
  const Mission& mission = results.missions()[one.mission];
  return {{"log", mission.log},
          {"vehicle", mission.vehicle},
          {"mission", mission.mission},
          {"split", plan.splits[one.split].split},
          {"seed", plan.splits[one.split].seed},
          {"learner", plan.learners[one.learner].name}};
}

class StudyWriter {
 public:
  StudyWriter(const Results& results, const StudySummary& summary)
      : results_(results), summary_(summary) {}

  Json head(const StudyChange* change) const {
    const Plan& plan = results_.plan();
    const auto learner = [](const LearnerConfig& one) {
      return Json{{"name", one.name}, {"set", one.set}};
    };
    const auto split = [](const SplitOptions& one) {
      return Json{{"split", one.split}, {"seed", one.seed}};
    };
    return {{"format", kStudyFormat},
            {"version", kStudyVersion},
            {"kelpie", kelpie_version()},
            {"name", plan.name},
            {"learners", file::list(plan.learners, learner)},
            {"splits", file::list(plan.splits, split)},
            {"missions", results_.missions().size()},
            {"failures", failures()},
            {"overall", overall()},
            {"vehicles", file::list(summary_.vehicles,
                                    [&](const VehicleSummary& one) { return vehicle(one); })},
            {"against", change == nullptr ? Json(nullptr) : change_json(*change)}};
  }

  // A line each: the document has as many as there are runs.
  void tell_runs(const file::Content::Write& write) const {
    write("[\n");
    bool is_first = true;
    for (std::size_t i = 0; i < results_.combinations().size(); ++i) {
      const std::optional<Outcome> outcome = results_.outcome(i);
      if (outcome) {
        Json run = place_json(results_, i);
        run.update(outcome_json(*outcome));
        write((is_first ? "" : ",\n") + file::one_line(run));
        is_first = false;
      }
    }
    write("\n]");
  }

 private:
  Json failures() const {
    Json list = Json::array();
    for (const auto& [i, why] : results_.failures()) {
      Json failure = place_json(results_, i);
      failure["error"] = why;
      list.push_back(std::move(failure));
    }
    return list;
  }

  Json overall() const {
    Json learners = Json::array();
    for (std::size_t i = 0; i < summary_.learners.size(); ++i) {
      const LearnerOverall& one = summary_.learners[i];
      learners.push_back({{"learner", results_.plan().learners[i].name},
                          {"judged", one.judged},
                          {"best", one.best},
                          {"against_least_squares", duel_json(one.least_squares)},
                          {"against_mean", duel_json(one.mean)},
                          {"shortfall", spread_json(one.shortfall)},
                          {"times", times_json(one.times)}});
    }
    return learners;
  }

  Json axis(const AxisSummary& one) const {
    Json learners = Json::array();
    for (std::size_t i = 0; i < one.learners.size(); ++i) {
      learners.push_back(learner_json(results_.plan().learners[i].name, one.learners[i]));
    }
    return {{"name", one.name},
            {"unit", file::text_or_null(one.unit)},
            {"learners", learners},
            {"least_squares", spread_json(one.least_squares)},
            {"mean", spread_json(one.mean)},
            {"least_squares_one_step", spread_json(one.least_squares_one_step)},
            {"last_value_one_step", spread_json(one.last_value_one_step)},
            {"trend", trend_json(one.trend, summary_.trends)}};
  }

  Json vehicle(const VehicleSummary& one) const {
    Json times = Json::array();
    for (std::size_t i = 0; i < one.learners.size(); ++i) {
      Json taken = {{"learner", results_.plan().learners[i].name}};
      taken.update(times_json(one.learners[i]));
      times.push_back(std::move(taken));
    }
    return {{"name", one.name},
            {"missions", one.missions},
            {"failed", one.failed},
            {"hours", one.hours},
            {"axes", file::list(one.axes, [&](const AxisSummary& each) { return axis(each); })},
            {"times", times}};
  }

  Json change_json(const StudyChange& change) const {
    const auto gain = [](const Gain& one) {
      return Json{{"vehicle", one.vehicle},   {"axis", one.axis},
                  {"learner", one.learner},   {"difference", spread_json(one.difference)},
                  {"better", one.now.better}, {"worse", one.now.worse},
                  {"lost", one.lost}};
    };
    const auto run = [&](const ChangedRun& one) {
      Json json = place_json(results_, one.combination);
      json["axis"] = one.axis;
      json["then"] = number(one.then);
      json["now"] = number(one.now);
      return json;
    };
    return {{"file", change.file},
            {"kelpie", change.kelpie},
            {"matched", change.matched},
            {"only_now", change.only_now},
            {"only_then", change.only_then},
            {"gains", file::list(change.gains, gain)},
            {"worst", file::list(change.worst, run)}};
  }

  const Results& results_;
  const StudySummary& summary_;
};

}  // namespace

file::Content study_json(const Results& results, const StudySummary& summary,
                         const StudyChange* change) {
  return file::Content([&results, &summary, change](const file::Content::Write& write) {
    const StudyWriter writer(results, summary);
    std::string head = file::json_text(writer.head(change));
    head.resize(head.rfind("\n}"));
    write(head + ",\n  \"" + kRunsKey + "\": ");
    writer.tell_runs(write);
    write("\n}\n");
  });
}

}  // namespace kelpie::fleet
