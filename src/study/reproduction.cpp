// SPDX-License-Identifier: Apache-2.0
#include "kelpie/study/reproduction.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "kelpie/baseline/run_all.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/study/contenders.hpp"
#include "kelpie/study/stream.hpp"
#include "study_stream.hpp"

namespace kelpie {
namespace {

namespace fs = std::filesystem;

constexpr double kSimulationCost = 4'000.0;  // of a log, in updates of a learner
constexpr double kOfflineCost = 8'000.0;     // of a baseline with its cross-validation
constexpr double kPeerCost = 16'000.0;

// Counts what is done, under a lock, and hears whether to go on.
class Watch {
 public:
  Watch(const ReproductionPlan& plan, double planned) : plan_(plan), planned_(planned) {}

  bool advance(double cost) {
    const std::scoped_lock lock(mutex_);
    done_ += cost;
    stopped_ = stopped_ || !plan_.keep_going(std::min(1.0, done_ / planned_));
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

 private:
  const ReproductionPlan& plan_;
  std::mutex mutex_;
  double planned_;
  double done_ = 0.0;
  std::atomic<bool> stopped_{false};
};

struct Job {
  double cost = 0.0;
  std::function<void(Watch&)> work;  // reports its cost itself
};

// Tells the watch of every hundredth sample.
std::function<bool(std::size_t)> steps(Watch& watch) {
  constexpr std::size_t kStride = 100;
  return [&watch](std::size_t shown) {
    return shown % kStride != 0 || watch.advance(static_cast<double>(kStride));
  };
}

// A stream while it is being measured: a study for each split, and the seeds' data.
struct Course {
  std::string key;
  bool simulated = true;
  std::string source;
  bool full_range_only = false;
  std::size_t seeds = 0;
  bool offline = false;
  std::vector<Contender> contenders;
  std::vector<SeedData> data;  // by seed
};

class Runner {
 public:
  explicit Runner(const ReproductionPlan& plan) : plan_(plan) {}

  Reproduction run() {
    result_.plan = plan_;
    plan_courses();
    work_through(data_jobs(), 0.05);
    if (!stopped_) {
      begin_studies();
      work_through(measuring_jobs(), 1.0);
    }
    result_.interrupted = stopped_;
    return std::move(result_);
  }

 private:
  static constexpr std::size_t kAxes = 3;

  void plan_courses() {
    add_simulated("simulation", plan_.scenario, plan_.seeds, true);
    for (const std::string& name : plan_.further) {
      add_simulated(name, name, std::min(plan_.seeds, plan_.further_seeds), false);
    }
    if (!plan_.data.empty()) {
      real_ = real_data(plan_);
      result_.real_log = true;
      courses_.push_back({.key = "real",
                          .simulated = false,
                          .source = (plan_.data / kRealLogName).string(),
                          .seeds = plan_.seeds,
                          .offline = true,
                          .contenders = contenders(true),
                          .data = {}});
    }
  }

  void add_simulated(const std::string& key, const std::string& name, std::size_t seeds,
                     bool main) {
    scenarios_.push_back(
        planned_scenario(plan_.scenarios, name, main ? plan_.scenario_share : plan_.further_share));
    courses_.push_back({.key = key,
                        .source = (plan_.scenarios / (name + ".toml")).string(),
                        .full_range_only = name == "concentrated",
                        .seeds = seeds,
                        .offline = main,
                        .contenders = contenders(main),
                        .data = {}});
  }

  // The paper's values as written run on the paper's streams only.
  std::vector<Contender> contenders(bool main) const {
    std::vector<Contender> list = paper_contenders(kAxes);
    if (!main) {
      list.pop_back();
    }
    std::ranges::move(small_buffer_contenders(kAxes, plan_.small_buffer), std::back_inserter(list));
    return list;
  }

  std::vector<Job> data_jobs() {
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < courses_.size(); ++i) {
      Course& course = courses_[i];
      course.data.resize(course.seeds);
      for (std::size_t seed = 0; seed < course.seeds; ++seed) {
        jobs.push_back({kSimulationCost, [this, &course, i, seed](Watch& watch) {
                          const std::uint64_t number = plan_.first_seed + seed;
                          course.data[seed] =
                              course.simulated
                                  ? simulated_data(scenarios_[i], course.source, number,
                                                   course.full_range_only)
                                  : split_data(first_rows(real_, plan_.real_rows), number);
                          watch.advance(kSimulationCost);
                        }});
      }
    }
    return jobs;
  }

  // Makes room for every result, so that jobs in any order fill the same places.
  void begin_studies() {
    for (const Course& course : courses_) {
      for (std::size_t kind = 0; kind < std::size(kSplitKinds); ++kind) {
        const SeedData& first = course.data.front();
        StreamStudy study{
            .key = course.key,
            .simulated = course.simulated,
            .source = course.source,
            .split = first.splits[kind].label,
            .split_kind = to_string(kSplitKinds[kind]),
            .rate_hz = first.data.rate_hz,
            .training_rows = first.splits[kind].training.size(),
            .held_out_rows = first.splits[kind].held_out.size(),
            .note = course.full_range_only ? "judged on held-out rows of the full range alone" : "",
            .configurations = configurations_of(first.data),
            .axes = first.data.target_names,
            .contenders = {},
            .offline = {}};
        for (const Contender& contender : course.contenders) {
          study.contenders.push_back({contender.key, contender.name, contender.settings});
          study.contenders.back().seeds.assign(seeds_of(course, kind, contender),
                                               std::vector<AxisResult>(study.axes.size()));
        }
        for (const std::string& axis : study.axes) {
          if (course.offline) {
            study.offline.push_back({axis, {study.configurations.size(), OfflineModel{}}});
          }
        }
        result_.studies.push_back(std::move(study));
      }
    }
  }

  // The same log cut into the same blocks gives the same run again.
  std::size_t seeds_of(const Course& course, std::size_t kind, const Contender& contender) const {
    if (!course.simulated && kSplitKinds[kind] == SplitKind::blocks) {
      return 1;
    }
    return contender.key == "paper" ? std::min(course.seeds, plan_.paper_seeds) : course.seeds;
  }

  std::vector<Job> measuring_jobs() {
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < result_.studies.size(); ++i) {
      const std::size_t kinds = std::size(kSplitKinds);
      add_stream_jobs(jobs, courses_[i / kinds], i % kinds, result_.studies[i]);
      add_offline_jobs(jobs, courses_[i / kinds], i % kinds, result_.studies[i]);
    }
    add_published_jobs(jobs);
    add_peer_jobs(jobs);
    return jobs;
  }

  void add_stream_jobs(std::vector<Job>& jobs, const Course& course, std::size_t kind,
                       StreamStudy& study) {
    for (std::size_t who = 0; who < study.contenders.size(); ++who) {
      for (std::size_t seed = 0; seed < study.contenders[who].seeds.size(); ++seed) {
        for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
          AxisResult& place = study.contenders[who].seeds[seed][axis];
          jobs.push_back({static_cast<double>(study.training_rows),
                          [this, &course, kind, who, seed, axis, &place](Watch& watch) {
                            place = run_axis(course.data[seed], kind, course.contenders[who], axis,
                                             watch);
                          }});
        }
      }
    }
  }

  AxisResult run_axis(const SeedData& seed, std::size_t kind, const Contender& contender,
                      std::size_t axis, Watch& watch) const {
    const Dataset data = one_target(seed.data, axis);
    const auto learner = contender.make(data.input_names.size(), axis, nullptr);
    OnlineRegressor* const learners[] = {learner.get()};
    StreamResult stream =
        run_stream(data, seed.splits[kind], learners,
                   {.validate_every = plan_.validate_every, .keep_going = steps(watch)});
    return std::move(stream.axes.front());
  }

  void add_offline_jobs(std::vector<Job>& jobs, const Course& course, std::size_t kind,
                        StreamStudy& study) {
    for (std::size_t axis = 0; axis < study.offline.size(); ++axis) {
      for (std::size_t i = 0; i < study.configurations.size(); ++i) {
        jobs.push_back({kOfflineCost, [this, &course, kind, axis, i, &study](Watch& watch) {
                          const SeedData& seed = course.data.front();
                          study.offline[axis].models[i] =
                              train_offline(seed.data, seed.splits[kind], axis,
                                            study.configurations[i], plan_.grid);
                          watch.advance(kOfflineCost);
                        }});
      }
    }
  }

  void add_published_jobs(std::vector<Job>& jobs) {
    if (!result_.real_log || real_.rows() != kPublishedLogRows) {
      return;
    }
    published_ = published_contenders(kAxes);
    published_rows_ = published_rows(real_.rows());
    result_.published.resize(published_.size());
    for (std::size_t i = 0; i < published_.size(); ++i) {
      jobs.push_back({static_cast<double>(published_rows_.stream.size()), [this, i](Watch& watch) {
                        result_.published[i] =
                            run_published(real_, published_rows_.stream, published_rows_.test,
                                          published_[i], plan_.published_every, steps(watch));
                      }});
    }
  }

  void add_peer_jobs(std::vector<Job>& jobs) {
    std::vector<fs::path> files;
    for (const std::string_view name : kPeerStreams) {
      const fs::path file = plan_.data / "peer_streams" / (std::string(name) + ".csv");
      if (plan_.peers && !plan_.data.empty() && fs::exists(file)) {
        files.push_back(file);
      }
    }
    peers_ = paper_contenders(1);
    peers_.pop_back();
    result_.peers.resize(files.size() * peers_.size());
    for (std::size_t i = 0; i < result_.peers.size(); ++i) {
      jobs.push_back({kPeerCost, [this, i, file = files[i / peers_.size()]](Watch& watch) {
                        result_.peers[i] = run_peer(file, peers_[i % peers_.size()], steps(watch));
                      }});
    }
  }

  // The costly first, so that no thread is left alone with a long job at the end.
  void work_through(std::vector<Job> jobs, double share_at_end) {
    std::ranges::stable_sort(jobs, std::greater{}, &Job::cost);
    double cost = 0.0;
    for (const Job& job : jobs) {
      cost += job.cost;
    }
    ReproductionPlan part = plan_;
    const double from = done_;
    part.keep_going = [&, from](double share) {
      return plan_.keep_going(from + (share_at_end - from) * share);
    };
    Watch watch(part, std::max(1.0, cost));
    run_all(jobs.size(), plan_.threads, [&](std::size_t i) {
      if (!watch.stopped()) {
        jobs[i].work(watch);
      }
    });
    stopped_ = watch.stopped();
    done_ = share_at_end;
  }

  const ReproductionPlan& plan_;
  Reproduction result_;
  Dataset real_;
  std::vector<Scenario> scenarios_;  // of the first courses, which are simulated
  std::vector<Course> courses_;
  std::vector<Contender> published_;
  PublishedRows published_rows_;
  std::vector<Contender> peers_;
  double done_ = 0.0;
  bool stopped_ = false;
};

void require(bool fine, const char* field, const std::string& message) {
  if (!fine) {
    throw InputError({.file = {}, .line = 0, .field = field}, message);
  }
}

}  // namespace

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

Reproduction reproduce(const ReproductionPlan& plan) {
  plan.validate();
  return Runner(plan).run();
}

}  // namespace kelpie
