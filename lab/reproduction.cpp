// SPDX-License-Identifier: Apache-2.0
#include "lab/reproduction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "jobs/executor.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "lab/entries.hpp"
#include "log/dataset.hpp"
#include "log/read_log.hpp"
#include "simulator/scenario.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/simulated_log.hpp"
#include "study/split.hpp"
#include "study/stream.hpp"

namespace kelpie::lab {
namespace {

namespace fs = std::filesystem;

constexpr double kDataShare = 0.03;  // of the time, for simulating
constexpr double kSearchShare = 0.3;
constexpr double kSearchCost = 1.0;
constexpr double kOfflineCost = 8'000.0;  // of a baseline with its cross-validation

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

// A piece of work of a rough cost, in updates of a learner.
struct Work {
  double cost = 0.0;
  std::function<void(const jobs::Advance&)> run;
};

// Does the work on the plan's threads; `from` and `to` are the shares of all work done before and
// after. False if the work was stopped. Rethrows exceptions.
bool do_all(const std::vector<Work>& list, const ReproductionPlan& plan, double from, double to) {
  std::vector<jobs::Job> jobs;
  for (const Work& one : list) {
    jobs.push_back({.cost = one.cost});
  }
  return jobs::make_thread_executor(plan.threads)
      ->run({.jobs = jobs,
             .work =
                 [&](std::size_t i, const jobs::Advance& advance) {
                   list[i].run(advance);
                   return std::string();
                 },
             .done = [](std::size_t, const std::string&) {},
             .keep_going =
                 [&](double share) { return plan.keep_going(from + (to - from) * share); }});
}

// Tells the progress of every hundredth sample.
std::function<bool(std::size_t)> steps(const jobs::Advance& advance, std::size_t samples) {
  return [&advance, samples](std::size_t shown) {
    return shown % 100 != 0 || advance(static_cast<double>(shown) / static_cast<double>(samples));
  };
}

// What pages and numbers need of a stream.
SeedRun kept_of(study::StreamResult stream) {
  SeedRun run;
  std::vector<double> times;
  for (study::AxisResult& axis : stream.axes) {
    std::ranges::move(axis.update_us, std::back_inserter(times));
    study::AxisResult& kept = run.axes.emplace_back();
    kept.name = std::move(axis.name);
    kept.validation = std::move(axis.validation);
    kept.stages = std::move(axis.stages);
    kept.status = axis.status;
  }
  run.update_us = study::quantiles_of(times);
  return run;
}

// A stream while it is being measured, and the seeds' data.
struct Course {
  std::string key;
  bool simulated = true;
  std::string source;
  bool full_range_only = false;
  std::size_t seeds = 0;
  bool main = false;           // with off-line baselines and a search for settings
  std::vector<SeedData> data;  // by seed
};

class Runner {
 public:
  explicit Runner(const ReproductionPlan& plan) : plan_(plan) {}

  Reproduction run() {
    result_.plan = plan_;
    plan_courses();
    const auto done = [&](const std::vector<Work>& work, double from, double to) {
      result_.interrupted = result_.interrupted || !do_all(work, plan_, from, to);
      return !result_.interrupted;
    };
    if (done(data_work(), 0.0, kDataShare)) {
      run_entries();
      begin_studies();
    }
    if (!result_.interrupted && done(search_work(), kDataShare, kSearchShare)) {
      begin_rows();
      done(measuring_work(), kSearchShare, 1.0);
      add_entry_rows();
    }
    return std::move(result_);
  }

 private:
  static constexpr std::size_t kAxes = 3;
  static constexpr std::size_t kKinds = std::size(kSplitKinds);

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
                          .source = kRealLogName,
                          .seeds = plan_.seeds,
                          .main = true,
                          .data = {}});
    }
  }

  void add_simulated(const std::string& key, const std::string& name, std::size_t seeds,
                     bool main) {
    scenarios_.push_back(
        planned_scenario(plan_.scenarios, name, main ? plan_.scenario_share : plan_.further_share));
    courses_.push_back({.key = key,
                        .source = "scenarios/" + name + kExtension,
                        .full_range_only = name == "concentrated",
                        .seeds = seeds,
                        .main = main,
                        .data = {}});
  }

  std::vector<Work> data_work() {
    std::vector<Work> work;
    for (std::size_t i = 0; i < courses_.size(); ++i) {
      Course& course = courses_[i];
      course.data.resize(course.seeds);
      for (std::size_t seed = 0; seed < course.seeds; ++seed) {
        work.push_back({1.0, [this, &course, i, seed](const jobs::Advance&) {
                          const std::uint64_t number = plan_.first_seed + seed;
                          course.data[seed] =
                              course.simulated
                                  ? simulated_data(scenarios_[i], course.source, number,
                                                   course.full_range_only)
                                  : split_data(first_rows(real_, plan_.real_rows), number);
                        }});
      }
    }
    return work;
  }

  // Makes room for every result, so that work in any order fills the same places.
  void begin_studies() {
    for (const Course& course : courses_) {
      const SeedData& first = course.data.front();
      for (std::size_t kind = 0; kind < kKinds; ++kind) {
        StreamStudy study{
            .key = course.key,
            .simulated = course.simulated,
            .source = course.source,
            .split_kind = kSplitKinds[kind],
            .split = first.splits[kind].label,
            .rate_hz = first.data.rate_hz,
            .training_rows = first.splits[kind].training.size(),
            .held_out_rows = first.splits[kind].held_out.size(),
            .note = course.full_range_only ? "judged on held-out rows of the full range alone" : "",
            .configurations = configurations_of(first.data),
            .axes = first.data.target_names};
        if (course.main) {
          study.found.assign(searched_families().size(),
                             std::vector<FoundSettings>(study.axes.size()));
          for (const std::string& axis : study.axes) {
            study.offline.push_back({axis, {study.configurations.size(), OfflineModel{}}});
          }
          study.offline_terms = study.offline;
        }
        result_.studies.push_back(std::move(study));
      }
    }
  }

  const Course& course_of(std::size_t study) const { return courses_[study / kKinds]; }
  const study::Split& split_of(std::size_t study, std::size_t seed) const {
    return course_of(study).data[seed].splits[study % kKinds];
  }

  // Folds as the split that the settings are for: interleaved rows leak as a random split does.
  Folds folds_of(std::size_t study) const {
    return {plan_.folds, result_.studies[study].split_kind == study::SplitKind::random};
  }

  // The search sees the first configuration's training rows of the first seed, as the paper's.
  std::vector<Work> search_work() {
    std::vector<Work> work;
    for (std::size_t i = 0; i < result_.studies.size(); ++i) {
      for (std::size_t family = 0; family < result_.studies[i].found.size(); ++family) {
        for (std::size_t axis = 0; axis < result_.studies[i].axes.size(); ++axis) {
          work.push_back({kSearchCost, [this, i, family, axis](const jobs::Advance& advance) {
                            search(i, family, axis, advance);
                          }});
        }
      }
    }
    return work;
  }

  void search(std::size_t i, std::size_t family, std::size_t axis, const jobs::Advance& advance) {
    StreamStudy& study = result_.studies[i];
    const Family& searched = searched_families()[family];
    const SettingsGrid& grid = plan_.quick ? searched.quick : searched.grid;
    const log::Dataset& data = course_of(i).data.front().data;
    std::size_t planned = plan_.folds;
    for (const auto& [name, values] : grid) {
      planned += plan_.folds * (values.size() - 1);
    }
    std::size_t done = 0;
    study.found[family][axis] = search_settings(
        data, study::of_configuration(data, split_of(i, 0).training, study.configurations.front()),
        axis, folds_of(i), grid, searched.make,
        [&] { return advance(static_cast<double>(done++) / static_cast<double>(planned)); });
  }

  void begin_rows() {
    for (std::size_t i = 0; i < result_.studies.size(); ++i) {
      StreamStudy& study = result_.studies[i];
      // Further streams are of the main stream's vehicle.
      const auto& found = result_.studies[study.found.empty() ? i % kKinds : i].found;
      for (const Row& row : reproduction_rows()) {
        if (row.slow && (plan_.quick || !course_of(i).main)) {
          continue;
        }
        AxisValues values;
        for (std::size_t family = 0; family < searched_families().size(); ++family) {
          if (row.family == searched_families()[family].key) {
            std::ranges::transform(found[family], std::back_inserter(values),
                                   &FoundSettings::values);
          }
        }
        const Contender& made = contenders_.emplace_back(row.make(row, values, study.axes.size()));
        study.rows.push_back({row.key, row.kind, row.name, made.settings});
        study.rows.back().seeds.resize(row.slow ? 1 : seeds_of(i));
      }
    }
  }

  // The same log cut into the same blocks gives the same run again.
  std::size_t seeds_of(std::size_t i) const {
    const StreamStudy& study = result_.studies[i];
    return !study.simulated && study.split_kind == study::SplitKind::blocks ? 1
                                                                            : course_of(i).seeds;
  }

  std::vector<Work> measuring_work() {
    std::vector<Work> work;
    auto contender = contenders_.begin();
    for (std::size_t i = 0; i < result_.studies.size(); ++i) {
      for (RowRuns& row : result_.studies[i].rows) {
        add_row_work(work, i, row, *contender++);
      }
      add_offline_work(work, i);
    }
    return work;
  }

  void add_row_work(std::vector<Work>& work, std::size_t i, RowRuns& row,
                    const Contender& contender) const {
    for (std::size_t seed = 0; seed < row.seeds.size(); ++seed) {
      SeedRun& place = row.seeds[seed];
      work.push_back({static_cast<double>(result_.studies[i].training_rows),
                      [this, i, seed, &contender, &place](const jobs::Advance& advance) {
                        const log::Dataset& data = course_of(i).data[seed].data;
                        const study::Split& split = split_of(i, seed);
                        const std::unique_ptr<OnlineModel> model = contender.make(data, {});
                        place = kept_of(study::run_stream(
                            data, split, *model,
                            {.validate_every = plan_.validate_every,
                             .keep_going = steps(advance, split.training.size())}));
                      }});
    }
  }

  void add_offline_work(std::vector<Work>& work, std::size_t i) {
    StreamStudy& study = result_.studies[i];
    CrossValidationOptions grid = plan_.grid;
    grid.interleaved = folds_of(i).interleaved;
    for (std::size_t axis = 0; axis < study.offline.size(); ++axis) {
      for (std::size_t k = 0; k < study.configurations.size(); ++k) {
        for (const bool terms : {false, true}) {
          OfflineModel& place = (terms ? study.offline_terms : study.offline)[axis].models[k];
          work.push_back({kOfflineCost, [this, i, axis, grid, terms, &place,
                                         only = study.configurations[k]](const jobs::Advance&) {
                            place = train_offline(course_of(i).data.front().data, split_of(i, 0),
                                                  axis, only, grid, terms);
                          }});
        }
      }
    }
  }

  // Entries come before the long work, since an entry may be refused.
  void run_entries() {
    std::vector<EntryStream> streams;
    for (const Course& course : courses_) {
      for (const SeedData& seed : course.data) {
        streams.push_back({seed.data, seed.splits});
      }
    }
    if (!plan_.entries.empty()) {
      entries_ = lab::run_entries(plan_.entries, streams, plan_.first_seed, plan_.threads);
    }
  }

  void add_entry_rows() {
    for (const EntryRuns& entry : entries_) {
      std::size_t stream = 0;
      for (std::size_t i = 0; i < result_.studies.size(); ++i) {
        RowRuns row{entry.key, RowKind::entry, entry.name, entry.place};
        for (std::size_t seed = 0; seed < seeds_of(i); ++seed) {
          row.seeds.push_back(entry.runs[stream + seed][i % kKinds]);
        }
        stream += i % kKinds + 1 == kKinds ? course_of(i).seeds : 0;
        result_.studies[i].rows.push_back(std::move(row));
      }
    }
  }

  const ReproductionPlan& plan_;
  Reproduction result_;
  log::Dataset real_;
  std::vector<simulator::Scenario> scenarios_;  // of the first courses, which are simulated
  std::vector<Course> courses_;
  std::vector<Contender> contenders_;  // by study and row
  std::vector<EntryRuns> entries_;
};

}  // namespace

void ReproductionPlan::validate() const {
  require_range("seeds", static_cast<double>(seeds), {.low = 1.0, .high = 1000.0});
  for (const double share : {scenario_share, further_share}) {
    require_range("scenario_share", share, {.low = 0.0, .high = 1.0, .open = true});
  }
  require_range("validate_every", static_cast<double>(validate_every), {.low = 1.0});
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
  plan.scenario_share = 0.2;
  plan.further_share = 0.4;
  plan.real_rows = 4000;
  plan.folds = 2;
  plan.grid = {.gamma = {0.1, 0.3}, .c = {10.0}, .epsilon = {0.03, 0.1}, .folds = 3, .thin = 8};
  return plan;
}

Reproduction reproduce(const ReproductionPlan& plan) {
  plan.validate();
  return Runner(plan).run();
}

}  // namespace kelpie::lab
