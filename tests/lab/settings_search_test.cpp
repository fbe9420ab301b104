// SPDX-License-Identifier: Apache-2.0
#include "lab/settings_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>

#include "study/small_log.hpp"

namespace kelpie::settings_search_test {
namespace {

// Answers the truth times `scale`, plus `offset`; remembers the times shown.
class Scaled final : public OnlineRegressor {
 public:
  Scaled(const log::Dataset& data, double scale, double offset, std::set<double>& shown)
      : data_(data), scale_(scale), offset_(offset), shown_(shown) {}

  Decision update(std::span<const double> /*x*/, double /*y*/, double t) override {
    EXPECT_GT(t, last_);
    last_ = t;
    shown_.insert(t);
    return {};
  }
  double predict(std::span<const double> x) const override {
    return scale_ * data_.target(testing::row_of(x[1]))[0] + offset_;
  }
  Status status() const override { return {}; }

 private:
  const log::Dataset& data_;
  double scale_;
  double offset_;
  std::set<double>& shown_;
  double last_ = -1.0;
};

TEST(SettingsSearch, FindsTheBestOfEachSettingAndSeesItsRowsAlone) {
  const log::Dataset data = testing::small_log(100);
  const std::vector<std::size_t> rows = testing::all_rows(80);
  const lab::SettingsGrid grid{{"scale", {"0", "2", "1"}}, {"offset", {"5", "0"}}};
  std::set<double> shown;
  const auto make = [&](const log::Dataset& log, std::size_t, const lab::NamedValues& values) {
    return std::make_unique<Scaled>(log, std::stod(values[0].second), std::stod(values[1].second),
                                    shown);
  };
  std::size_t asked = 0;
  const lab::FoundSettings found = lab::search_settings(
      data, rows, 0, {.count = 4, .interleaved = true}, grid, make, [&] { return ++asked > 0; });
  EXPECT_EQ(found.values, (lab::NamedValues{{"scale", "1"}, {"offset", "0"}}));
  EXPECT_DOUBLE_EQ(found.r2, 1.0);
  EXPECT_EQ(found.runs, 16U);  // the start, two scales and an offset more, in four folds
  EXPECT_EQ(asked, found.runs);
  EXPECT_EQ(shown.size(), rows.size());
  EXPECT_LE(*shown.rbegin(), data.times_s[79]);
}

TEST(Folds, DealEveryRowOnce) {
  const std::vector<std::size_t> rows{3, 5, 7, 9, 11, 13, 15};
  for (const bool interleaved : {false, true}) {
    std::vector<std::size_t> held_out;
    for (std::size_t fold = 0; fold < 3; ++fold) {
      const lab::FoldRows dealt = lab::Folds{3, interleaved}.rows(rows, fold);
      EXPECT_EQ(dealt.others.size() + dealt.held_out.size(), rows.size());
      held_out.insert(held_out.end(), dealt.held_out.begin(), dealt.held_out.end());
    }
    EXPECT_EQ(std::ranges::is_sorted(held_out), !interleaved);
    std::ranges::sort(held_out);
    EXPECT_EQ(held_out, rows);
  }
}

}  // namespace
}  // namespace kelpie::settings_search_test
