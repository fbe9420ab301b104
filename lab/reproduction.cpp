// SPDX-License-Identifier: Apache-2.0
#include "lab/reproduction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "jobs/executor.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "lab/contenders.hpp"
#include "log/dataset.hpp"
#include "log/read_log.hpp"
#include "model/axis_list.hpp"
#include "simulator/scenario.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/simulated_log.hpp"
#include "study/split.hpp"
#include "study/stream.hpp"

namespace kelpie::lab {
namespace {

namespace fs = std::filesystem;

constexpr double kSimulationCost = 4'000.0;  // of a log, in updates of a learner
constexpr double kOfflineCost = 8'000.0;     // of a baseline with its cross-validation
constexpr double kPeerCost = 16'000.0;
constexpr double kDataShare = 0.03;  // of the time, for simulating

// The log of one seed, and its split by each kind in kSplitKinds.
struct SeedData {
  log::Dataset data;
  std::vector<study::Split> splits;
};

// The split of the paper, and a split by blocks of time.
inline constexpr std::array kSplitKinds{study::SplitKind::random, study::SplitKind::blocks};

constexpr const char* kExtension = ".toml";
constexpr double kRealRateHz = 4.0;

std::vector<std::string> scenario_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == kExtension) {
      names.push_back(entry.path().stem().string());
    }
  }
  std::ranges::sort(names);
  return names;
}

// The time up to which each row's phase lasts tells which phase that is.
bool at_full_amplitude(const simulator::Scenario& scenario, double time_s) {
  constexpr double kHalfTickS = 0.005;
  double end_s = 0.0;
  for (const simulator::Phase& phase : scenario.phases) {
    end_s += phase.duration_s;
    if (time_s < end_s + kHalfTickS) {
      return phase.amplitude >= 1.0;
    }
  }
  return true;
}

// A scenario of a folder, with phases shortened to `share`. Throws InputError with the nearest
// name for an unknown scenario.
simulator::Scenario planned_scenario(const fs::path& folder, const std::string& name,
                                     double share) {
  const fs::path file = folder / (name + kExtension);
  if (!fs::exists(file)) {
    const std::vector<std::string> names = scenario_names(folder);
    throw InputError({.file = folder.string(), .line = 0, .field = {}},
                     names.empty() ? "holds no scenario" : unknown_name(name, "scenario", names));
  }
  simulator::Scenario scenario = simulator::read_scenario(file);
  for (simulator::Phase& phase : scenario.phases) {
    phase.duration_s = std::max(1.0, std::round(phase.duration_s * share));
  }
  return scenario;
}

// Splits the log with this seed.
SeedData split_data(log::Dataset data, std::uint64_t seed) {
  SeedData result{std::move(data), {}};
  for (const study::SplitKind kind : kSplitKinds) {
    result.splits.push_back(study::make_split(result.data, {.kind = kind, .seed = seed}));
  }
  return result;
}

// Simulates and splits with the seed. With `full_range_only` the held-out rows hold phases of full
// amplitude only.
SeedData simulated_data(simulator::Scenario scenario, const std::string& source, std::uint64_t seed,
                        bool full_range_only) {
  scenario.seed = seed;
  const log::Table table = study::log_table(simulator::simulate(scenario), source);
  SeedData result = split_data(log::make_dataset(table, log::guess_roles(table, {})), seed);
  if (full_range_only) {
    for (study::Split& split : result.splits) {
      std::erase_if(split.held_out, [&](std::size_t row) {
        return !at_full_amplitude(scenario, result.data.times_s[row]);
      });
    }
  }
  return result;
}

// The real log of the plan's folder.
log::Dataset real_data(const ReproductionPlan& plan) {
  const std::string file = (plan.data / kRealLogName).string();
  return log::read_log({.path = file}, {}, {.rate_hz = kRealRateHz}).dataset();
}

// The first `rows` rows; 0: the whole log.
log::Dataset first_rows(log::Dataset data, std::size_t rows) {
  if (rows > 0 && rows < data.rows()) {
    data.inputs.resize(rows * data.input_names.size());
    data.targets.resize(rows * data.target_names.size());
    data.times_s.resize(rows);
    data.configurations.resize(rows);
  }
  return data;
}

// The rows with a single target.
log::Dataset one_target(const log::Dataset& data, std::size_t axis) {
  log::Dataset one = data;
  one.target_names = {data.target_names[axis]};
  one.targets.clear();
  for (std::size_t row = 0; row < data.rows(); ++row) {
    one.targets.push_back(data.target(row)[axis]);
  }
  return one;
}

// Progress of a job, counted in cost.
class JobProgress {
 public:
  JobProgress(const jobs::Advance& advance, double planned)
      : advance_(advance), planned_(planned) {}

  // Adds finished cost. False if the work has to stop.
  bool advance(double cost) {
    done_ += cost;
    stopped_ = stopped_ || !advance_(done_ / planned_);
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

 private:
  const jobs::Advance& advance_;
  double planned_;
  double done_ = 0.0;
  bool stopped_ = false;
};

// A piece of work that reports finished cost to the progress.
struct ReproductionJob {
  double cost = 0.0;
  std::function<void(JobProgress&)> work;
};

// Runs the jobs on the plan's threads; `from` and `to` are the shares of all work done before and
// after. False if the work was stopped. Rethrows exceptions of jobs.
bool run_jobs(const std::vector<ReproductionJob>& list, const ReproductionPlan& plan, double from,
              double to) {
  std::vector<jobs::Job> costs;
  for (const ReproductionJob& one : list) {
    costs.push_back({.cost = one.cost});
  }
  const auto work = [&](std::size_t i, const jobs::Advance& advance) {
    JobProgress progress(advance, list[i].cost);
    list[i].work(progress);
    return std::string();
  };
  return jobs::make_thread_executor(plan.threads)
      ->run({.jobs = costs,
             .work = work,
             .done = [](std::size_t, const std::string&) {},
             .keep_going =
                 [&](double share) { return plan.keep_going(from + (to - from) * share); }});
}

// Tells the progress of every hundredth sample.
std::function<bool(std::size_t)> steps(JobProgress& progress) {
  constexpr std::size_t kStride = 100;
  return [&progress](std::size_t shown) {
    return shown % kStride != 0 || progress.advance(static_cast<double>(kStride));
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
    result_.interrupted = !run_jobs(data_jobs(), plan_, 0.0, kDataShare);
    if (!result_.interrupted) {
      begin_studies();
      result_.interrupted = !run_jobs(measuring_jobs(), plan_, kDataShare, 1.0);
    }
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

  std::vector<ReproductionJob> data_jobs() {
    std::vector<ReproductionJob> jobs;
    for (std::size_t i = 0; i < courses_.size(); ++i) {
      Course& course = courses_[i];
      course.data.resize(course.seeds);
      for (std::size_t seed = 0; seed < course.seeds; ++seed) {
        jobs.push_back({kSimulationCost, [this, &course, i, seed](JobProgress& progress) {
                          const std::uint64_t number = plan_.first_seed + seed;
                          course.data[seed] =
                              course.simulated
                                  ? simulated_data(scenarios_[i], course.source, number,
                                                   course.full_range_only)
                                  : split_data(first_rows(real_, plan_.real_rows), number);
                          progress.advance(kSimulationCost);
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
            .split_kind = study::to_string(kSplitKinds[kind]),
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
                                               std::vector<study::AxisResult>(study.axes.size()));
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
    if (!course.simulated && kSplitKinds[kind] == study::SplitKind::blocks) {
      return 1;
    }
    return contender.key == "paper" ? std::min(course.seeds, plan_.paper_seeds) : course.seeds;
  }

  std::vector<ReproductionJob> measuring_jobs() {
    std::vector<ReproductionJob> jobs;
    for (std::size_t i = 0; i < result_.studies.size(); ++i) {
      const std::size_t kinds = std::size(kSplitKinds);
      add_stream_jobs(jobs, courses_[i / kinds], i % kinds, result_.studies[i]);
      add_offline_jobs(jobs, courses_[i / kinds], i % kinds, result_.studies[i]);
    }
    add_published_jobs(jobs);
    add_peer_jobs(jobs);
    return jobs;
  }

  void add_stream_jobs(std::vector<ReproductionJob>& jobs, const Course& course, std::size_t kind,
                       StreamStudy& study) {
    for (std::size_t who = 0; who < study.contenders.size(); ++who) {
      const std::string& twin = course.contenders[who].twin;
      for (std::size_t seed = 0; twin.empty() && seed < study.contenders[who].seeds.size();
           ++seed) {
        for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
          jobs.push_back({static_cast<double>(study.training_rows),
                          [this, &course, kind, who, seed, axis, &study](JobProgress& progress) {
                            run_with_twins(course, kind, who, seed, axis, study, progress);
                          }});
        }
      }
    }
  }

  // One learner, and those that can't differ from it where nothing was forgotten: there, its run is
  // theirs.
  void run_with_twins(const Course& course, std::size_t kind, std::size_t who, std::size_t seed,
                      std::size_t axis, StreamStudy& study, JobProgress& progress) const {
    study::AxisResult& place = study.contenders[who].seeds[seed][axis];
    place = run_axis(course.data[seed], kind, course.contenders[who], axis, progress);
    for (std::size_t other = 0; other < course.contenders.size(); ++other) {
      if (course.contenders[other].twin == course.contenders[who].key && !progress.stopped()) {
        study.contenders[other].seeds[seed][axis] =
            place.status.tally.forgotten == 0 && place.status.tally.changes == 0
                ? place
                : run_axis(course.data[seed], kind, course.contenders[other], axis, progress);
      }
    }
  }

  study::AxisResult run_axis(const SeedData& seed, std::size_t kind, const Contender& contender,
                             std::size_t axis, JobProgress& progress) const {
    const log::Dataset data = one_target(seed.data, axis);
    AxisList model(contender.make(data.input_names, axis, std::nullopt));
    study::StreamResult stream =
        study::run_stream(data, seed.splits[kind], model,
                          {.validate_every = plan_.validate_every, .keep_going = steps(progress)});
    return std::move(stream.axes.front());
  }

  void add_offline_jobs(std::vector<ReproductionJob>& jobs, const Course& course, std::size_t kind,
                        StreamStudy& study) {
    for (std::size_t axis = 0; axis < study.offline.size(); ++axis) {
      for (std::size_t i = 0; i < study.configurations.size(); ++i) {
        jobs.push_back(
            {kOfflineCost, [this, &course, kind, axis, i, &study](JobProgress& progress) {
               const SeedData& seed = course.data.front();
               study.offline[axis].models[i] = train_offline(seed.data, seed.splits[kind], axis,
                                                             study.configurations[i], plan_.grid);
               progress.advance(kOfflineCost);
             }});
      }
    }
  }

  void add_published_jobs(std::vector<ReproductionJob>& jobs) {
    if (!result_.real_log || real_.rows() != kPublishedLogRows) {
      return;
    }
    published_ = published_contenders(kAxes);
    published_rows_ = published_rows(real_.rows());
    result_.published.resize(published_.size());
    for (std::size_t i = 0; i < published_.size(); ++i) {
      jobs.push_back(
          {static_cast<double>(published_rows_.stream.size()), [this, i](JobProgress& progress) {
             result_.published[i] =
                 run_published(real_, published_rows_.stream, published_rows_.test, published_[i],
                               plan_.published_every, steps(progress));
           }});
    }
  }

  void add_peer_jobs(std::vector<ReproductionJob>& jobs) {
    std::vector<fs::path> files;
    for (const std::string_view name : kPeerStreams) {
      const fs::path file = plan_.data / "peer_streams" / (std::string(name) + ".csv");
      if (plan_.peers && !plan_.data.empty() && fs::exists(file)) {
        files.push_back(file);
      }
    }
    peers_ = peer_contenders();
    result_.peers.resize(files.size() * peers_.size());
    for (std::size_t i = 0; i < result_.peers.size(); ++i) {
      jobs.push_back({kPeerCost, [this, i, file = files[i / peers_.size()]](JobProgress& progress) {
                        result_.peers[i] =
                            run_peer(file, peers_[i % peers_.size()], steps(progress));
                      }});
    }
  }

  const ReproductionPlan& plan_;
  Reproduction result_;
  log::Dataset real_;
  std::vector<simulator::Scenario> scenarios_;  // of the first courses, which are simulated
  std::vector<Course> courses_;
  std::vector<Contender> published_;
  PublishedRows published_rows_;
  std::vector<Contender> peers_;
};

}  // namespace

void ReproductionPlan::validate() const {
  require_range("seeds", static_cast<double>(seeds), {.low = 1.0, .high = 1000.0});
  for (const double share : {scenario_share, further_share}) {
    require_range("scenario_share", share, {.low = 0.0, .high = 1.0, .open = true});
  }
  require_range("validate_every", static_cast<double>(validate_every), {.low = 1.0});
  require_range("published_every", static_cast<double>(published_every), {.low = 1.0});
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

}  // namespace kelpie::lab
