// SPDX-License-Identifier: Apache-2.0
#include "jobs/progress.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace kelpie::progress_jobs_test {
namespace {

TEST(Progress, AStopThatComesWhileItAsksIsNotLost) {
  const std::vector<jobs::Job> list(1);
  jobs::Progress* asked = nullptr;
  const jobs::Run run{.jobs = list, .work = nullptr, .keep_going = [&](double) {
                        asked->stop();
                        return true;
                      }};
  jobs::Progress progress(run);
  asked = &progress;
  EXPECT_FALSE(progress.advance(0, 0.5));
  EXPECT_TRUE(progress.stopped());
}

}  // namespace
}  // namespace kelpie::progress_jobs_test
