// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/dynamics_model.hpp"
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

// reference/limits.md promises to small computers, for a vehicle with three velocities and three
// thrusters.
TEST(ModelSettings, PresetsKeepToTheirMemory) {
  const std::vector<std::string> inputs{"u", "v", "r", "th1", "th2", "th3"};
  const auto bytes = [&](const char* preset) {
    return DynamicsModel::bytes(inputs, ModelSettings::from_preset(preset, 3));
  };
  EXPECT_LE(bytes("default"), 120'000'000U);
  EXPECT_LE(bytes("small"), 17'000'000U);
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
  EXPECT_EQ(
      message_of<InputError>([] { ModelSettings::from_preset("papper", 2); }),
      "preset: 'papper' is no choice (did you mean 'paper'?); there are default, small, paper");
}

TEST(ModelSettings, ARemovedSettingIsRefusedWithWhatToWriteInstead) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  const std::string refusal = message_of<InputError>([&] { settings.assign("s", "0.5"); });
  EXPECT_TRUE(refusal.starts_with("s: this setting was removed")) << refusal;
  EXPECT_NE(refusal.find("fine/s, lambda/s and c·s"), std::string::npos) << refusal;
}

TEST(ModelSettings, ARemovedValueIsRefusedWithItsSuccessorWhichOlderFilesGet) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  EXPECT_EQ(message_of<InputError>([&] { settings.assign("learner", "committee"); }),
            "learner: 'committee' was removed in version 2.0.0 (CHANGELOG.md); write posterior");
  EXPECT_EQ(message_of<InputError>([&] { settings.assign("adapt", "challenger"); }),
            "adapt: 'challenger' was removed in version 2.0.0 (CHANGELOG.md); write follow");
  EXPECT_EQ(present_value("learner", "committee"), "posterior");
  EXPECT_EQ(present_value("adapt", "challenger,none"), "follow,none");
  EXPECT_EQ(present_value("states", "committee, u"), "committee, u");
  EXPECT_TRUE(removed_setting("track"));
}

using Notes = std::vector<std::string>;

Notes notes_of(const std::vector<std::pair<std::string, std::string>>& assignments,
               bool scale_given = false) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  Notes names;
  for (const auto& [name, text] : assignments) {
    settings.assign(name, text);
    names.push_back(name);
  }
  return settings.notes(names, scale_given);
}

TEST(ModelSettings, NotesTellWhatHasNoEffectInItsCompany) {
  EXPECT_EQ(notes_of({{"k", "3"}, {"forget", "fifo"}}),
            Notes{"setting k has no effect with forget = fifo"});
  EXPECT_EQ(notes_of({{"memory", "2"}, {"adapt", "none"}}),
            Notes{"setting memory has no effect with adapt = none"});
  EXPECT_EQ(notes_of({{"outlier_factor", "9"}, {"outlier", "iqr,none"}}),
            Notes{"setting outlier_factor has no effect with outlier = iqr,none"});
  EXPECT_EQ(notes_of({{"lambda", "1"}, {"terms", "none"}}),
            Notes{"setting lambda has no effect with terms = none"});
  EXPECT_EQ(notes_of({{"learner", "svr"}, {"warmup", "60"}}, true),
            Notes{"setting warmup has no effect with a given scale"});
  EXPECT_EQ(notes_of({{"warmup", "60"}}),
            Notes{"setting warmup has no effect with learner = posterior"});
  EXPECT_EQ(notes_of({{"learner", "svr"}, {"adapt", "follow"}}),
            Notes{"setting adapt has no effect with learner = svr"});
}

TEST(ModelSettings, NoNoteOfWhatHasAnEffectIsOffOrWasNotGiven) {
  EXPECT_EQ(notes_of({{"k", "3"}, {"forget", "fifo,age"}}), Notes{}) << "on one axis it has";
  EXPECT_EQ(notes_of({{"lambda", "0"}, {"terms", "none"}}), Notes{}) << "both are off";
  EXPECT_EQ(notes_of({{"adapt", "none"}}), Notes{}) << "nobody asked for a memory";
  EXPECT_EQ(notes_of({{"learner", "svr"}, {"warmup", "50"}}), Notes{});
}

// A rule with a misspelt name or value would never be true.
TEST(SettingDocs, WhatLeavesASettingIdleIsASettingAndAValueOfIt) {
  std::size_t rules = 0;
  const auto check = [&rules](const auto& field) {
    if (!field.idle.values.empty()) {
      ModelSettings settings = ModelSettings::from_preset("default", 1);
      for (const std::string& value : split_text(field.idle.values, ',')) {
        EXPECT_NO_THROW(settings.assign(field.idle.with, value)) << field.name;
        ++rules;
      }
      EXPECT_EQ(settings.notes(Notes{std::string(field.name)}, false).size(), 1U) << field.name;
    }
  };
  std::ranges::for_each(shared_fields(), [&](const auto& field) { check(field); });
  std::ranges::for_each(online_svr_fields(), [&](const auto& field) { check(field); });
  EXPECT_GE(rules, 6U);
}

TEST(SettingDocs, SectionsHoldEverySettingOnceTheEssentialOnesFirst) {
  std::set<std::string> names;
  std::size_t shown = 0;
  const std::vector<SettingSection> sections = setting_sections();
  for (const SettingSection& section : sections) {
    EXPECT_FALSE(section.title.empty()) << section.settings.front().name;
    for (const SettingText& doc : section.settings) {
      names.insert(doc.name);
      ++shown;
    }
  }
  EXPECT_EQ(sections.front().title, kEssential);
  EXPECT_EQ(sections.front().settings.front().name, "preset");
  EXPECT_LE(sections.front().settings.size(), 10U);
  EXPECT_EQ(names.size(), setting_docs().size());
  EXPECT_EQ(shown, names.size());
}

TEST(SettingDocs, TellEveryFieldOnce) {
  const std::vector<SettingText> docs = setting_docs();
  EXPECT_EQ(docs.size(), 1 + shared_fields().size() + online_svr_fields().size());
  for (const SettingText& doc : docs) {
    EXPECT_FALSE(doc.meaning.empty()) << doc.name;
    EXPECT_FALSE(doc.allowed.empty()) << doc.name;
    EXPECT_EQ(doc.presets.size(), preset_names().size()) << doc.name;
  }
}

}  // namespace
}  // namespace kelpie::settings_test
