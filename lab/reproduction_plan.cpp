// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "lab/reproduction.hpp"

namespace kelpie::lab {

void ReproductionPlan::validate() const {
  require(seeds >= 1 && seeds <= 1000, "seeds",
          std::to_string(seeds) + " is out of range; it has to be 1 to 1000");
  for (const double share : {scenario_share, further_share}) {
    require(share > 0.0 && share <= 1.0, "scenario_share",
            number_text(share) + " is out of range; it has to be more than 0, up to 1");
  }
  require(validate_every >= 1, "validate_every", "0 is out of range; it has to be >= 1");
  require(published_every >= 1, "published_every", "0 is out of range; it has to be >= 1");
  grid.validate();
}

ReproductionPlan full_plan() {
  ReproductionPlan plan;
  plan.grid = {.gamma = {0.03, 0.1, 0.3}, .c = {10.0, 100.0}, .epsilon = {0.03, 0.1}, .thin = 8};
  return plan;
}

ReproductionPlan quick_plan() {
  ReproductionPlan plan;
  plan.quick = true;
  plan.seeds = 1;
  plan.further.clear();
  plan.paper_seeds = 1;
  plan.scenario_share = 0.2;
  plan.further_share = 0.4;
  plan.real_rows = 4000;
  plan.validate_every = 100;
  plan.published_every = 50;
  plan.grid = {.gamma = {0.1, 0.3}, .c = {10.0}, .epsilon = {0.03, 0.1}, .folds = 3, .thin = 8};
  plan.peers = false;
  return plan;
}

}  // namespace kelpie::lab
