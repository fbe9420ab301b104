// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fleet/missions.hpp"
#include "fleet/outcome.hpp"
#include "fleet/plan.hpp"
#include "fleet/results.hpp"
#include "jobs/executor.hpp"
#include "support.hpp"

namespace kelpie::testing {

/// A study whose outcomes nobody had to learn. Its vehicles have as many missions as they say.
struct ForgedStudy {
  /// What came of a combination, or words that say why nothing did.
  struct Forged {
    fleet::Outcome outcome;
    std::string error{};
  };
  using Forge = std::function<Forged(const fleet::Combination&)>;

  fleet::Plan plan{.file = "/study/fleet.toml",
                   .name = "forged",
                   .sources = std::vector<fleet::Source>(1),
                   .splits = {{"pieces", 1}},
                   .learners = {{"kelpie", {}}, {"small", {"preset=small"}}}};
  std::vector<fleet::Mission> missions{};
  TemporaryFolder folder{};

  void add_vehicle(const std::string& name, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::string log = fmt::format("{}/dive{}.csv", name, i);
      missions.push_back({.file = "/study/" + log,
                          .log = log,
                          .vehicle = name,
                          .mission = fmt::format("dive{}", i)});
    }
  }

  /// All combinations with what `forge` says of them.
  std::unique_ptr<fleet::Results> results(const Forge& forge) const {
    class Forger final : public jobs::Executor {
     public:
      explicit Forger(std::function<std::string(std::size_t)> result)
          : result_(std::move(result)) {}
      bool run(const jobs::Run& run) override {
        for (std::size_t i = 0; i < run.jobs.size(); ++i) {
          run.done(i, result_(i));
        }
        return true;
      }

     private:
      std::function<std::string(std::size_t)> result_;
    };
    auto results = std::make_unique<fleet::Results>(plan, missions, folder.path());
    Forger forger([&](std::size_t i) {
      const Forged forged = forge(results->combinations()[i]);
      return file::one_line(forged.error.empty() ? fleet::outcome_json(forged.outcome)
                                                 : file::Json{{"error", forged.error}});
    });
    EXPECT_TRUE(results->run(forger, [](double) { return true; }));
    return results;
  }

  /// An outcome with these R² on held-out rows, an axis each; least squares has 0.5 and the mean 0.
  static Forged with_r2(const std::vector<double>& r2) {
    Forged forged;
    forged.outcome.training_rows = 240;
    forged.outcome.held_out_rows = 60;
    forged.outcome.duration_s = 300.0;
    for (std::size_t axis = 0; axis < r2.size(); ++axis) {
      forged.outcome.axes.push_back(
          {fmt::format("axis{}", axis), "", {r2[axis], 0.4, 0.3, 0.9, 0.5, 0.2, 0.0, 0.0, 0.1}});
    }
    return forged;
  }
};

}  // namespace kelpie::testing
