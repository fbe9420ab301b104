// SPDX-License-Identifier: Apache-2.0
#include "jobs/rank_executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "file/json.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::jobs {
namespace {

using file::Json;
using Clock = std::chrono::steady_clock;
using Counter = RankGroup::Counter;

constexpr std::size_t kLeader = 0;
constexpr std::chrono::milliseconds kBetweenLooks{20};

// What ended a rank's work too early.
struct RankError {
  bool bad_input = false;
  std::string what;
};

// What a rank has done in a run.
struct RankReport {
  std::vector<std::size_t> done;  // places in the list
  std::size_t journal_size = 0;   // results in the rank's journal
  std::optional<RankError> error;

  std::string text() const {
    Json json = {{"done", done}, {"journal", journal_size}};
    if (error) {
      json["error"] = {{"bad_input", error->bad_input}, {"what", error->what}};
    }
    return file::one_line(json);
  }
  static RankReport of(const std::string& text) {
    const Json json = Json::parse(text);
    RankReport report{
        json.at("done").get<std::vector<std::size_t>>(), json.at("journal").get<std::size_t>(), {}};
    if (const auto error = json.find("error"); error != json.end()) {
      report.error = {error->at("bad_input").get<bool>(), error->at("what").get<std::string>()};
    }
    return report;
  }
};

// The journal of another rank, once it has all results that the rank has written.
std::unique_ptr<JournalReader> open_visible(const JournalPlace& place, std::size_t rank,
                                            std::size_t size) {
  const std::filesystem::path file = rank_journal(place.file, rank);
  const auto end = Clock::now() + kTuning.visibility_timeout;
  while (true) {
    if (std::error_code none; std::filesystem::exists(file, none)) {
      auto reader = std::make_unique<JournalReader>(file, place.kind, place.header);
      if (reader->size() >= size) {
        return reader;
      }
    }
    if (Clock::now() > end) {
      throw Failure(
          fmt::format("{}: the results of rank {} are not there; is the folder on a file "
                      "system that all machines see?",
                      file.string(), rank));
    }
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

void throw_first_error(const std::vector<RankReport>& reports) {
  for (const RankReport& report : reports) {
    if (report.error && report.error->bad_input) {
      throw InputError(report.error->what);
    }
    if (report.error) {
      throw Failure(report.error->what);
    }
  }
}

// One run, seen by one rank.
class RankRun {
 public:
  // `jobs`: of the leader, for all ranks; order[i] is the place of the i-th costly job in `jobs`.
  RankRun(RankGroup& group, const Run& run, std::span<const Job> jobs,
          std::vector<std::size_t> order, std::chrono::milliseconds stop_poll_period)
      : group_(group),
        run_(run),
        jobs_(jobs),
        order_(std::move(order)),
        stop_poll_period_(stop_poll_period) {
    for (const std::size_t i : order_) {
      cost_before_.push_back(cost_before_.back() + jobs_[i].cost);
    }
  }

  void work() {
    try {
      for (std::size_t i = take(); i < order_.size() && !stopped_; i = take()) {
        do_job(order_[i]);
      }
    } catch (const InputError& error) {
      fail({true, error.what()});
    } catch (const std::exception& error) {
      fail({false, error.what()});
    }
    report_.journal_size = journal_ ? journal_->size() : 0;
    journal_.reset();  // on the disk before the others are told
  }

  const RankReport& report() const { return report_; }

  std::size_t jobs() const { return jobs_.size(); }

  // Takes what the other ranks have done.
  void collect(const std::vector<RankReport>& reports) const {
    for (std::size_t rank = kLeader + 1; rank < reports.size(); ++rank) {
      if (reports[rank].done.empty()) {
        continue;
      }
      const auto journal = open_visible(run_.journal, rank, reports[rank].journal_size);
      for (const std::size_t i : reports[rank].done) {
        run_.done(i, journal->result(jobs_[i].key));
      }
    }
  }

  void rethrow_done() const {
    if (thrown_) {
      std::rethrow_exception(thrown_);
    }
  }

  // Whether to go on. Called by any thread, often.
  bool go_on() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || stopped_) {
      return !stopped_;
    }
    if (const auto now = Clock::now(); now - polled_ >= stop_poll_period_) {
      polled_ = now;
      begun_ = std::min<std::size_t>(group_.fetch_add(Counter::next_job, 0), jobs_.size());
      if (group_.fetch_add(Counter::stop, 0) > 0) {
        stopped_ = true;
        return false;
      }
    }
    const double planned = cost_before_.back();
    if (!run_.keep_going(planned > 0.0 ? cost_before_[begun_] / planned : 1.0)) {
      stop();
    }
    return !stopped_;
  }

 private:
  std::size_t take() {
    const std::size_t i = group_.fetch_add(Counter::next_job, 1);
    const std::scoped_lock lock(mutex_);
    begun_ = std::max(begun_, std::min<std::size_t>(i + 1, jobs_.size()));
    return i;
  }

  void do_job(std::size_t i) {
    if (!leads() && !journal_) {
      journal_.emplace(rank_journal(run_.journal.file, group_.rank()), run_.journal.kind,
                       run_.journal.header);
    }
    std::atomic<bool> abandoned{false};
    std::string result;
    try {
      result = run_.work(jobs_[i], [&](double) {
        if (!go_on()) {
          abandoned = true;  // never set to false: a job may ask from several threads
        }
        return !abandoned;
      });
    } catch (const std::exception&) {
      throw;
    } catch (...) {
      throw Failure(jobs_[i].key + ": failed for no reason that it names");
    }
    if (!abandoned) {
      deliver(i, std::move(result));
      go_on();
    }
  }

  void deliver(std::size_t i, std::string result) {
    if (leads()) {
      try {
        run_.done(i, std::move(result));
      } catch (...) {
        thrown_ = std::current_exception();
        stop();
        return;
      }
    } else {
      journal_->add(jobs_[i].key, result);
    }
    report_.done.push_back(i);
  }

  bool leads() const { return group_.rank() == kLeader; }

  void fail(RankError error) {
    report_.error = std::move(error);
    stop();
  }

  void stop() {
    if (!stopped_.exchange(true)) {
      group_.fetch_add(Counter::stop, 1);
    }
  }

  RankGroup& group_;
  const Run& run_;
  std::span<const Job> jobs_;
  std::vector<std::size_t> order_;
  std::chrono::milliseconds stop_poll_period_;
  std::vector<double> cost_before_{0.0};
  std::mutex mutex_;
  Clock::time_point polled_ = Clock::now();
  std::size_t begun_ = 0;  // jobs, by any rank
  std::atomic<bool> stopped_{false};
  std::optional<Journal> journal_;
  RankReport report_;
  std::exception_ptr thrown_;  // by Run::done of the leader
};

class RankExecutor final : public Executor {
 public:
  RankExecutor(std::unique_ptr<RankGroup> group, std::string version,
               std::chrono::milliseconds stop_poll_period)
      : group_(std::move(group)),
        version_(std::move(version)),
        stop_poll_period_(stop_poll_period) {}
  ~RankExecutor() override {
    if (!ended_) {
      group_->exchange("", [] {});
    }
    for (const std::filesystem::path& file : files_) {
      if (std::error_code ignored; has_all_) {
        std::filesystem::remove(file, ignored);
      }
    }
  }
  RankExecutor(const RankExecutor&) = delete;
  RankExecutor& operator=(const RankExecutor&) = delete;

  bool leads() const override { return group_->rank() == kLeader; }
  std::size_t workers() const override { return group_->size(); }

  bool run(const Run& run) override {
    if (ended_) {
      return false;
    }
    if (leads()) {
      group_->reset(Counter::next_job);
      group_->reset(Counter::stop);
    }
    if (!all_agree(group_->exchange(greeting(run), [] {}))) {
      return false;
    }
    const std::vector<Job> given = send_jobs(run);
    const std::span<const Job> jobs = leads() ? run.jobs : given;
    RankRun own(*group_, run, jobs, costly_first(jobs), stop_poll_period_);
    own.work();
    std::vector<RankReport> reports;
    for (const std::string& text : group_->exchange(own.report().text(), [&] { own.go_on(); })) {
      reports.push_back(RankReport::of(text));
    }
    if (leads()) {
      take_results(run, own, reports);
    }
    const auto done = [](std::size_t sum, const RankReport& one) { return sum + one.done.size(); };
    return std::accumulate(reports.begin(), reports.end(), std::size_t{0}, done) == own.jobs();
  }

 private:
  // What each rank tells the others before a run; no rank's text is empty.
  std::string greeting(const Run& run) const {
    return file::one_line(
        {{"kelpie", version_}, {"host", group_->host()}, {"identity", run.identity}});
  }

  // Sends the leader's jobs to the other ranks, in lines of JSON; a document of all jobs would take
  // several times the memory. Returns the jobs in the other ranks.
  std::vector<Job> send_jobs(const Run& run) const {
    std::string lines;
    for (const Job& job : run.jobs) {
      lines += file::one_line(Json{job.key, job.task, job.cost}) + '\n';
    }
    lines = group_->broadcast(std::move(lines));
    std::vector<Job> jobs;
    if (leads()) {
      return jobs;
    }
    for (std::size_t begin = 0; begin < lines.size();) {
      const std::size_t end = lines.find('\n', begin);
      const Json job = Json::parse(std::string_view(lines).substr(begin, end - begin));
      jobs.push_back(
          {job.at(0).get<std::string>(), job.at(1).get<std::string>(), job.at(2).get<double>()});
      begin = end + 1;
    }
    return jobs;
  }

  // False in ranks that don't lead, where the leader throws.
  bool all_agree(const std::vector<std::string>& texts) {
    const auto left = std::ranges::find(texts, "");
    if (left != texts.end()) {
      ended_ = true;
      return refuse<Failure>(fmt::format(
          "rank {} has left before the work was done; see what it has said", left - texts.begin()));
    }
    const Json leader = Json::parse(texts[kLeader]);
    for (std::size_t rank = kLeader + 1; rank < texts.size(); ++rank) {
      const Json other = Json::parse(texts[rank]);
      const auto text = [](const Json& json, const char* name) {
        return json.at(name).get<std::string>();
      };
      const std::string who = fmt::format("rank {} on {}", rank, text(other, "host"));
      const std::string leads =
          fmt::format("rank {} on {}, which leads", kLeader, text(leader, "host"));
      if (other.at("kelpie") != leader.at("kelpie")) {
        return refuse<InputError>(fmt::format("{}: is kelpie {}, but {}, is kelpie {}", who,
                                              text(other, "kelpie"), leads,
                                              text(leader, "kelpie")));
      }
      if (other.at("identity") != leader.at("identity")) {
        return refuse<InputError>(fmt::format(R"({}: has other work, "{}", than {}: "{}")", who,
                                              text(other, "identity"), leads,
                                              text(leader, "identity")));
      }
    }
    return true;
  }

  template <typename Error>
  bool refuse(const std::string& why) const {
    return leads() ? throw Error(why) : false;
  }

  void take_results(const Run& run, RankRun& own, const std::vector<RankReport>& reports) {
    for (std::size_t rank = kLeader + 1; rank < reports.size(); ++rank) {
      if (!reports[rank].done.empty()) {
        files_.insert(rank_journal(run.journal.file, rank));
      }
    }
    has_all_ = false;
    own.rethrow_done();
    own.collect(reports);
    has_all_ = true;
    throw_first_error(reports);
  }

  std::unique_ptr<RankGroup> group_;
  std::string version_;
  std::chrono::milliseconds stop_poll_period_;
  std::set<std::filesystem::path> files_;  // journals of ranks
  bool has_all_ = true;                    // results that are in them
  bool ended_ = false;                     // a rank has left
};

}  // namespace

std::unique_ptr<Executor> make_rank_executor(std::unique_ptr<RankGroup> group, std::string version,
                                             std::chrono::milliseconds stop_poll_period) {
  return std::make_unique<RankExecutor>(std::move(group), std::move(version), stop_poll_period);
}

}  // namespace kelpie::jobs
