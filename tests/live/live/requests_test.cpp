// SPDX-License-Identifier: Apache-2.0
// What an operator asks for while it runs: save, freeze, resume, reset.
#include "live/requests.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "format/model_json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "live/engine.hpp"
#include "live/mission.hpp"
#include "live/replay.hpp"
#include "plain_user.hpp"
#include "support.hpp"

namespace kelpie::requests_test {
namespace {

namespace fs = std::filesystem;
using live::Request;
using testing::little_mission;
using testing::Recorded;

// A sample that outputs heard of.
struct SignalVerdict {
  double t = 0.0;
  std::vector<double> x;
  std::vector<double> y;
  Decision decision;
  bool is_learned = false;
};

// What was said, in the order of being said; for any thread. And the samples, for the one after.
class Lines final : public live::Output {
 public:
  std::vector<SignalVerdict> samples;

  void learned(const live::LearnedSample& sample) override {
    samples.push_back({.t = sample.t,
                       .x = {sample.x.begin(), sample.x.end()},
                       .y = {sample.y.begin(), sample.y.end()},
                       .decision = sample.decisions[0],
                       .is_learned = sample.is_learned});
  }
  void event(const std::string& line) override {
    const std::lock_guard lock(mutex_);
    text_ += line + "\n";
  }
  void forget() {
    const std::lock_guard lock(mutex_);
    text_.clear();
  }
  bool has(const std::string& text) const {
    const std::lock_guard lock(mutex_);
    return text_.find(text) != std::string::npos;
  }
  std::string text() const {
    const std::lock_guard lock(mutex_);
    return text_;
  }

 private:
  mutable std::mutex mutex_;
  std::string text_;
};

// A vehicle whose operator does something before the message of a number comes.
class Vehicle final : public live::Transport {
 public:
  std::vector<Recorded> messages = little_mission(120.0);
  std::map<std::size_t, std::function<void()>> operator_does;

  const std::vector<bag::Topic>& topics() const override { return testing::mission_topics(); }
  Got next(bag::Message& message, std::chrono::milliseconds /*timeout*/) override {
    if (const auto does = operator_does.find(at_); does != operator_does.end()) {
      const std::function<void()> act = std::move(does->second);
      operator_does.erase(does);
      act();
      return Got::nothing;
    }
    if (at_ == messages.size()) {
      return Got::end;
    }
    message = testing::message_of(messages[at_++]);
    return Got::message;
  }
  void begin() { at_ = 0; }
  std::size_t middle() const { return messages.size() / 2; }
  std::size_t late() const { return messages.size() * 3 / 4; }

 private:
  std::size_t at_ = 0;
};

class LiveRequests : public ::testing::Test {
 protected:
  LiveRequests() {
    auto lines = std::make_unique<Lines>();
    lines_ = lines.get();
    std::vector<std::unique_ptr<live::Output>> list;
    list.push_back(std::move(lines));
    outputs_.use(std::move(list));
    configure("align = \"none\"");
  }

  void configure(const std::string& live) {
    testing::write_text(folder_ / "x.toml", testing::mission_config("clock = \"header\"", live));
    configuration_ = live::read_configuration(folder_ / "x.toml", {});
  }
  fs::path out() const { return folder_ / "out"; }
  std::string model() const { return testing::read_text(out() / "model.json"); }

  void prepare(bool go_on = false) { prepare(vehicle_, go_on); }
  void prepare(live::Transport& transport, bool go_on = false) {
    lines_->forget();
    engine_.reset();
    engine_ = std::make_unique<live::Engine>(
        configuration_, out(), transport,
        go_on ? live::find_checkpoint(out(), configuration_) : std::nullopt, outputs_, requests_);
  }
  void run() {
    engine_->run([] { return live::Engine::Action::proceed; });
  }

  // Asks at a message, and holds further ones back until that was obeyed.
  void ask(
      std::size_t at, Request request, std::function<void()> then = [] {}) {
    static const std::map<Request, std::string> kSaid{{Request::save, "saved, after"},
                                                      {Request::freeze, "learning is frozen"},
                                                      {Request::resume, "learning goes on"},
                                                      {Request::reset, "the model begins anew"}};
    const std::string& said = kSaid.at(request);
    vehicle_.operator_does[at] = [this, at, request, said, then = std::move(then)] {
      requests_.push(request);
      wait(at, said, then);
    };
  }

  // Goes on at a message once something has been said.
  void wait(std::size_t at, const std::string& said, const std::function<void()>& then) {
    vehicle_.operator_does[at] = [this, at, said, then] {
      if (lines_->has(said)) {
        then();
      } else {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        wait(at, said, then);
      }
    };
  }

  // What the model says here and there.
  std::vector<double> says() const {
    std::vector<double> said;
    for (const double u : {-0.5, 0.0, 0.2}) {
      for (const double n : {-8.0, 1.0, 9.0}) {
        live::Engine& engine = *engine_;
        Prediction prediction;
        engine.learner().model()->predict(std::vector<double>{u, n}, std::span(&prediction, 1));
        said.insert(said.end(), {prediction.value, prediction.lower, prediction.upper});
      }
    }
    return said;
  }

  testing::TemporaryFolder folder_;
  live::Configuration configuration_;
  live::Outputs outputs_;
  Lines* lines_ = nullptr;
  live::Requests requests_;
  Vehicle vehicle_;
  std::unique_ptr<live::Engine> engine_;
};

TEST_F(LiveRequests, AFrozenModelSaysTheSameWhateverComesAlsoAfterARestart) {
  for (const char* const align : {"align = \"none\"", "align = 0.3"}) {
    configure(align);
    vehicle_.begin();
    prepare();
    std::vector<double> frozen;
    ask(vehicle_.middle(), Request::freeze, [&] { frozen = says(); });
    run();
    ASSERT_NE(frozen.front(), 0.0);
    EXPECT_EQ(says(), frozen);
    EXPECT_TRUE(engine_->health().learner.is_paused);
    EXPECT_GT(engine_->health().learner.rows_paused, 500U);
    const std::string saved = model();

    vehicle_.begin();  // goes on, with all of that once more
    prepare(true);
    EXPECT_TRUE(lines_->has("learning is frozen, as it was before"));
    EXPECT_EQ(says(), frozen);
    run();
    EXPECT_EQ(says(), frozen);
    EXPECT_EQ(model(), saved);
    EXPECT_TRUE(engine_->health().learner.is_paused);
  }
}

TEST_F(LiveRequests, WhileItIsFrozenOutputsHearOfAllSamples) {
  for (const char* const align : {"align = \"none\"", "align = 0.3", "align = -0.3"}) {
    configure(align);
    vehicle_.begin();
    prepare();
    lines_->samples.clear();
    ask(vehicle_.middle(), Request::freeze);
    ask(vehicle_.late(), Request::resume);
    run();
    // NOLINTBEGIN(misc-const-correctness): both change
    std::vector<bool> frozen;
    for (std::size_t i = 0; i < lines_->samples.size(); ++i) {
      // NOLINTEND(misc-const-correctness)
      const SignalVerdict& sample = lines_->samples[i];
      if (i > 0) {
        EXPECT_NEAR(sample.t - lines_->samples[i - 1].t, 0.1, 1e-9) << align << " " << i;
      }
      if (frozen.empty() ? !sample.is_learned : frozen.back() == sample.is_learned) {
        frozen.push_back(!sample.is_learned);
      }
      if (!sample.is_learned) {
        ASSERT_TRUE(sample.decision.had_model);
        EXPECT_NEAR(sample.decision.prediction.value, sample.y[0], 0.5);
        EXPECT_LT(sample.decision.prediction.lower, sample.decision.prediction.upper);
      }
    }
    EXPECT_EQ(frozen, (std::vector<bool>{true, false})) << align;
    EXPECT_NEAR(
        static_cast<double>(std::ranges::count(lines_->samples, false, &SignalVerdict::is_learned)),
        300.0, 20.0);
  }
}

TEST_F(LiveRequests, FrozenIsOnTheDiskAtOnce) {
  prepare();
  bool is_paused = false;
  ask(vehicle_.middle(), Request::freeze,
      [&] { is_paused = live::find_checkpoint(out(), configuration_)->progress.is_paused; });
  run();
  EXPECT_TRUE(is_paused);
}

TEST_F(LiveRequests, ResumedItLearnsAgain) {
  prepare();
  // NOLINTBEGIN(misc-const-correctness): both change
  std::vector<double> frozen;
  std::size_t learned = 0;
  // NOLINTEND(misc-const-correctness)
  ask(vehicle_.middle(), Request::freeze);
  ask(vehicle_.late(), Request::resume, [&] {
    frozen = says();
    learned = engine_->health().learner.learned;
  });
  run();
  EXPECT_NE(says(), frozen);
  EXPECT_GT(engine_->health().learner.learned, learned + 200);
  EXPECT_FALSE(engine_->health().learner.is_paused);
  EXPECT_FALSE(live::find_checkpoint(out(), configuration_)->progress.is_paused);
}

TEST_F(LiveRequests, ResetItBeginsAnewAndIsAsGoodAgain) {
  prepare();
  bool had_model = false;
  std::size_t learned = 0;
  std::size_t on_disk = 0;
  ask(vehicle_.middle(), Request::reset, [&] {
    double y = 0.0;
    had_model =
        engine_->learner().model()->predict(std::vector<double>{0.2, 5.0}, std::span(&y, 1)) > 0;
    learned = engine_->health().learner.learned;
    on_disk = live::find_checkpoint(out(), configuration_)->progress.learned;
  });
  run();
  EXPECT_FALSE(had_model);
  EXPECT_EQ(learned, 0U);
  EXPECT_EQ(on_disk, 0U);
  EXPECT_NEAR(static_cast<double>(engine_->health().learner.learned), 600.0, 20.0);
  EXPECT_GT(engine_->health().learner.axes[0].r2, 0.5);
}

// The model of an earlier drive is read once, at the start: its file may be gone by a reset.
TEST_F(LiveRequests, ResetItBeginsWithWhatWasKnownAtTheStart) {
  prepare();
  run();
  const fs::path nominal = folder_ / "nominal.json";
  fs::rename(out() / "model.json", nominal);
  configure("align = \"none\"\nnominal = \"" + nominal.string() + "\"");
  vehicle_.begin();
  prepare();
  fs::remove(nominal);
  ask(vehicle_.late(), Request::reset);
  run();
  EXPECT_NEAR(static_cast<double>(engine_->health().learner.learned), 300.0, 20.0);
}

TEST_F(LiveRequests, ResetNoModelOfBeforeIsLeftAndASaveSaysSo) {
  prepare();
  bool was_there = false;
  bool is_there = true;
  ask(vehicle_.middle(), Request::save, [&] { was_there = fs::exists(out() / "model.json"); });
  ask(vehicle_.late(), Request::reset, [&] {
    is_there = fs::exists(out() / "model.json");
    requests_.push(Request::save);
    wait(vehicle_.late(), "saved, after 0 samples; no model is ready yet", [] {});
  });
  run();
  EXPECT_TRUE(was_there);
  EXPECT_FALSE(is_there);
  EXPECT_FALSE(model().empty());  // of the samples since
}

// A replay that goes on shows rows that the checkpoint has learned; the wish comes among these.
TEST_F(LiveRequests, FrozenWhileItRepeatsWhatIsKnownItIsOnTheDiskSoonAfter) {
  configure("align = \"none\"\ncheckpoint = 1000");
  testing::write_text(folder_ / "x.mcap",
                      testing::mcap_of(testing::mission_topics(), little_mission(120.0)));
  const log::LogSource recording{.path = folder_ / "x.mcap"};
  const auto run_until = [&](std::size_t rows, bool& is_paused) {
    engine_->run([&] {
      if (engine_->learner().rows_taken() < rows) {
        return live::Engine::Action::proceed;
      }
      const auto saved = live::find_checkpoint(out(), configuration_);
      is_paused = saved && saved->progress.is_paused;
      return live::Engine::Action::stop;
    });
  };
  bool is_paused = false;
  live::Replay first(recording, configuration_, std::numeric_limits<double>::infinity());
  prepare(first);
  run_until(300, is_paused);
  const std::size_t known = live::find_checkpoint(out(), configuration_)->progress.rows;
  ASSERT_GE(known, 300U);
  EXPECT_FALSE(is_paused);
  live::Replay second(recording, configuration_, std::numeric_limits<double>::infinity());
  prepare(second, true);
  requests_.push(Request::freeze);
  run_until(known + 20, is_paused);
  EXPECT_TRUE(is_paused);
}

// Checked by the preset `threads` as well: the model is replaced while another thread predicts.
TEST_F(LiveRequests, WhileItIsResetPredictionsAreThoseOfTheModelBeforeOrNone) {
  const std::vector<double> x{0.2, 5.0};
  const auto predicted = [&]() -> std::optional<double> {
    double y = 0.0;
    return engine_->learner().model()->predict(x, std::span(&y, 1)) > 0 ? std::optional(y)
                                                                        : std::nullopt;
  };
  prepare();
  const std::size_t at = vehicle_.middle();
  std::optional<double> before;
  std::optional<double> after;
  std::size_t others = 0;
  const std::function<void()> look = [&] {
    const bool is_reset = lines_->has("the model begins anew");
    after = predicted();
    others += after && after != before ? 1 : 0;
    if (!is_reset) {
      vehicle_.operator_does[at] = look;
    }
  };
  ask(at, Request::freeze, [&] {
    before = predicted();
    requests_.push(Request::reset);
    vehicle_.operator_does[at] = look;
  });
  run();
  EXPECT_TRUE(before);
  EXPECT_FALSE(after);
  EXPECT_EQ(others, 0U);
}

// The first samples wait for the scale, and are learned a few with each that follows.
TEST_F(LiveRequests, ARecordingThatEndsSoonIsLearnedWhole) {
  int held_back = 0;
  for (int k = 0; k < 8; ++k) {
    testing::write_text(folder_ / "x.mcap",
                        testing::mcap_of(testing::mission_topics(), little_mission(5.0 + 0.4 * k)));
    live::Replay replay({.path = folder_ / "x.mcap"}, configuration_,
                        std::numeric_limits<double>::infinity());
    prepare(replay);
    lines_->samples.clear();
    run();
    DynamicsModel whole(configuration_.plan.inputs, configuration_.plan.targets,
                        configuration_.settings);
    for (const SignalVerdict& sample : lines_->samples) {
      whole.update(sample.x, sample.y, sample.t);
    }
    const std::string before = whole.ready() ? format::model_json(whole.trained()) : "";
    whole.learn_held_back();
    if (whole.ready()) {
      const std::string all = format::model_json(whole.trained());
      held_back += before != all ? 1 : 0;
      EXPECT_EQ(model(), all) << k;
    }
  }
  EXPECT_GT(held_back, 0);
}

TEST_F(LiveRequests, SavedAreBothFilesAndLearningGoesOn) {
  configure("align = \"none\"\ncheckpoint = 1000");
  prepare();
  std::size_t learned = 0;
  std::string then;
  ask(vehicle_.middle(), Request::save, [&] {
    then = model();
    learned = live::find_checkpoint(out(), configuration_)->progress.learned;
  });
  run();
  EXPECT_NEAR(static_cast<double>(learned), 600.0, 20.0);
  EXPECT_NE(then.find("\"axes\""), std::string::npos) << then.substr(0, 500);
  EXPECT_NE(model(), then);
}

TEST_F(LiveRequests, AFullDiskIsSaidAndNotThrown) {
  prepare();
  fs::remove_all(out());
  testing::write_text(out(), "");  // no folder can be made there
  requests_.push(Request::save);
  const std::size_t at = vehicle_.middle();
  wait(at, "no checkpoint can be written", [&] {
    fs::remove(out());
    requests_.push(Request::save);
    wait(at, "saved, after", [] {});
  });
  run();
  EXPECT_TRUE(lines_->has("checkpoints are written again")) << lines_->text();
  EXPECT_FALSE(model().empty());
}

TEST_F(LiveRequests, AFolderThatBecomesReadOnlyIsSaidAndMended) {
  fs::create_directories(out());
  const testing::PlainUser user(out());
  if (!testing::PlainUser::is_plain()) {
    GTEST_SKIP() << "root may write anywhere";
  }
  configure("align = \"none\"\ncheckpoint = 1");
  prepare();
  const std::size_t at = vehicle_.middle();
  std::size_t learned = 0;
  vehicle_.operator_does[at] = [&] {
    learned = engine_->health().learner.learned;
    fs::permissions(out(), fs::perms::owner_read | fs::perms::owner_exec);
  };
  wait(at + 50, "no checkpoint can be written, learning goes on", [&] {
    EXPECT_NE(engine_->health().learner.checkpoint_error.find("Permission denied"),
              std::string::npos);
    fs::permissions(out(), fs::perms::owner_all);
  });
  run();
  EXPECT_TRUE(lines_->has("checkpoints are written again")) << lines_->text();
  EXPECT_EQ(engine_->health().learner.checkpoint_error, "");
  EXPECT_GT(engine_->health().learner.learned, learned + 100);
  EXPECT_FALSE(model().empty());
}

TEST_F(LiveRequests, EqualOnesThatWaitAreOneAndTheLastOfFreezeAndResumeHolds) {
  for (int i = 0; i < 1'000; ++i) {
    for (const Request request :
         {Request::save, Request::freeze, Request::resume, Request::reset, Request::freeze}) {
      requests_.push(request);
    }
  }
  std::vector<Request> waiting;
  while (const std::optional<Request> request = requests_.pop()) {
    waiting.push_back(*request);
  }
  EXPECT_EQ(waiting, (std::vector{Request::save, Request::reset, Request::freeze}));
}

TEST_F(LiveRequests, AFloodOfSavesIsAFewCheckpointsAndTheLastWordHolds) {
  configure("align = \"none\"\ncheckpoint = 1000");
  prepare();
  for (std::size_t at = 10; at + 10 < vehicle_.messages.size(); ++at) {
    vehicle_.operator_does[at] = [this] {
      requests_.push(Request::save);
      requests_.push(Request::resume);
    };
  }
  vehicle_.operator_does[vehicle_.messages.size() - 1] = [this] {
    requests_.push(Request::freeze);
  };
  run();
  EXPECT_LT(engine_->health().learner.checkpoints, vehicle_.messages.size() / 4);
  EXPECT_TRUE(engine_->health().learner.is_paused);
}

TEST_F(LiveRequests, HaveNames) {
  for (const Request request : {Request::save, Request::freeze, Request::resume, Request::reset}) {
    EXPECT_EQ(live::parse_request(live::request_name(request), "x"), request);
  }
  EXPECT_NE(testing::message_of<InputError>([] { live::parse_request("stop", "/x"); }).find("/x"),
            std::string::npos);
}

TEST_F(LiveRequests, SimplePredictorsAreJudgedOnTheSameSamples) {
  prepare();
  run();
  const live::AxisHealth axis = engine_->health().learner.axes[0];
  EXPECT_EQ(axis.judged, 600U);
  EXPECT_GT(axis.r2, 0.5);
  EXPECT_GT(axis.r2_least_squares, 0.5);  // its terms are those of this vehicle
  EXPECT_GT(axis.r2_last_value, 0.5);
  EXPECT_LT(axis.r2_mean, 0.3);
}

}  // namespace
}  // namespace kelpie::requests_test
