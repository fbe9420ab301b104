// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/settings.hpp"

#include <gtest/gtest.h>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::settings_test {
namespace {

using testing::message_of;

TEST(ModelSettings, OneValueForAllAxesOrOnePerAxis) {
  ModelSettings settings = ModelSettings::from_preset("default", 3);
  settings.assign("gamma", "0.5");
  settings.assign("epsilon", "0.1, 0.2 ,0.3");
  settings.assign("forget", "fifo,age,paper");
  EXPECT_EQ(settings.axes[2].gamma, 0.5);
  EXPECT_EQ(settings.axes[1].epsilon, 0.2);
  EXPECT_EQ(settings.axes[0].forget, ForgetRule::fifo);
  EXPECT_EQ(message_of<InputError>([&] { settings.assign("c", "1,2"); }),
            "c: 2 values for 3 targets; give one, or one per target");
}

TEST(ModelSettings, ValuesReadBackToTheSameSettings) {
  for (const std::string_view preset : preset_names()) {
    ModelSettings settings = ModelSettings::from_preset(preset, 3);
    settings.assign("gamma", "0.1,0.30000000000000004,7");
    ModelSettings copy = ModelSettings::from_preset("default", 3);
    for (const auto& [name, value] : settings.values()) {
      if (name != "preset") {
        copy.assign(name, value);
      }
    }
    copy.preset = settings.preset;
    EXPECT_EQ(copy.values(), settings.values());
  }
}

// Table I of the paper, γ as its reciprocal.
TEST(ModelSettings, PaperPresetIsTheTable) {
  const ModelSettings paper = ModelSettings::from_preset("paper", 3);
  EXPECT_EQ(paper.shared.scaling, ScalingKind::full);
  EXPECT_EQ(paper.axes[0].gamma, 0.01);
  EXPECT_EQ(paper.axes[1].gamma, 0.025);
  EXPECT_EQ(paper.axes[2].gamma, 0.05);
  EXPECT_EQ(paper.axes[1].epsilon, 0.001);
  EXPECT_EQ(paper.axes[2].k, 1.0);
  EXPECT_EQ(paper.axes[0].outlier, OutlierRule::iqr);
  EXPECT_EQ(paper.axes[0].forget, ForgetRule::paper);
  EXPECT_NE(message_of<InputError>([] { ModelSettings::from_preset("paper", 4); }), "");
}

TEST(ModelSettings, RefusalsNameTheSetting) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  EXPECT_EQ(message_of<InputError>([&] { settings.assign("gama", "1"); }).substr(0, 47),
            "gama: unknown setting (did you mean 'gamma'?); ");
  settings.assign("buffer", "0");
  EXPECT_EQ(message_of<InputError>([&] { settings.validate(); }),
            "buffer: 0 is out of range; it has to be 2 to 20000");
  EXPECT_EQ(message_of<InputError>([] { ModelSettings::from_preset("papper", 2); }),
            "preset: 'papper' is not one of default, paper (did you mean 'paper'?)");
}

TEST(SettingDocs, TellEveryFieldOnce) {
  const std::vector<SettingDoc> docs = setting_docs();
  EXPECT_EQ(docs.size(), 1 + shared_fields().size() + online_svr_fields().size());
  for (const SettingDoc& doc : docs) {
    EXPECT_FALSE(doc.meaning.empty()) << doc.name;
    EXPECT_FALSE(doc.allowed.empty()) << doc.name;
    EXPECT_EQ(doc.presets.size(), preset_names().size()) << doc.name;
  }
}

}  // namespace
}  // namespace kelpie::settings_test
