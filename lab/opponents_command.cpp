// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "file/json.hpp"
#include "jobs/run_all.hpp"
#include "lab/commands.hpp"
#include "lab/json_table.hpp"
#include "lab/published_protocol.hpp"
#include "lab/reproduction.hpp"
#include "log/read_log.hpp"

namespace kelpie::lab {
namespace {

namespace fs = std::filesystem;

struct OpponentsArguments {
  std::string data = "../shared/data";
  std::size_t every = 5;
  std::size_t threads = 0;
  std::string out = "out/opponents";
};

file::Json published_json(const PublishedRun& run) {
  return {{"name", run.name},
          {"settings", run.settings},
          {"mean", file::number(run.mean)},
          {"minimum", file::number(run.minimum)},
          {"end", file::number(run.end)},
          {"mean_from_1000", file::number(run.mean_late)},
          {"minimum_from_1000", file::number(run.minimum_late)},
          {"steps", run.steps},
          {"r2", file::numbers(run.r2)}};
}

file::Json peer_json(const PeerRun& run) {
  file::Json r2 = file::Json::object();
  for (std::size_t i = 0; i < kPeerMarks.size(); ++i) {
    r2[std::to_string(i)] = file::number(run.r2[i]);
  }
  return {
      {"stream", run.stream},
      {"learner", run.learner},
      {"r2", r2},
      {"update_us", {{"median", file::number(run.median_us)}, {"p99", file::number(run.p99_us)}}}};
}

struct Opponents {
  std::vector<PublishedRun> published;
  std::vector<PeerRun> peers;
};

Opponents measure(const OpponentsArguments& options, const std::function<bool(double)>& go_on) {
  const fs::path folder = options.data;
  const log::Dataset real =
      log::read_log({.path = (folder / kRealLogName).string()}, {}, {.rate_hz = 4.0}).dataset();
  if (real.rows() != kPublishedLogRows) {
    throw InputError({.file = (folder / kRealLogName).string(), .line = 0, .field = {}},
                     "has " + std::to_string(real.rows()) + " rows; the published protocol has " +
                         std::to_string(kPublishedLogRows));
  }
  const PublishedRows rows = published_rows(real.rows());
  const std::vector<Contender> published = published_contenders(real.target_names.size());
  const std::vector<Contender> peers = peer_contenders();
  std::vector<fs::path> files;
  for (const std::string_view name : kPeerStreams) {
    const fs::path file = folder / "peer_streams" / (std::string(name) + ".csv");
    if (fs::exists(file)) {
      files.push_back(file);
    }
  }
  const auto whole = [](std::size_t) { return true; };
  Opponents result{std::vector<PublishedRun>(published.size()),
                   std::vector<PeerRun>(files.size() * peers.size())};
  jobs::run_while(
      go_on, published.size() + result.peers.size(), options.threads, [&](std::size_t i) {
        if (i < published.size()) {
          result.published[i] =
              run_published(real, rows.stream, rows.test, published[i], options.every, whole);
        } else {
          const std::size_t k = i - published.size();
          result.peers[k] = run_peer(files[k / peers.size()], peers[k % peers.size()], whole);
        }
      });
  return result;
}

void run_opponents(const OpponentsArguments& options) {
  const StudyOutput output{options.out, "opponents", "opponents"};
  const file::OutFolder folder = output.take();
  const Opponents found =
      run_watched("opponents", [&](const auto& go_on) { return measure(options, go_on); });
  const file::Json document{{"format", "kelpie-opponents"},
                            {"published", file::list(found.published, published_json)},
                            {"peers", file::list(found.peers, peer_json)}};
  std::vector<JsonColumn> marks{column("stream", "/stream"), column("learner", "/learner"),
                                column("update µs", "/update_us/median", fixed("{:.0f}")),
                                column("p99", "/update_us/p99", fixed("{:.0f}"))};
  for (std::size_t i = 0; i < kPeerMarks.size(); ++i) {
    marks.push_back(column(std::string(kPeerMarks[i]), "/r2/" + std::to_string(i)));
  }
  const chart::TextTable published =
      json_table("A hundred samples: the published protocol, R² on its test rows",
                 {column("learner", "/name"), column("mean", "/mean"),
                  column("minimum", "/minimum"), column("mean from 1,000", "/mean_from_1000"),
                  column("minimum from 1,000", "/minimum_from_1000"), column("end", "/end")},
                 document["published"]);
  output.write(folder, {chart::tables_text({published, json_table("The opponents' streams", marks,
                                                                  document["peers"])}),
                        file::json_text(document)});
}

}  // namespace

void add_opponents(CLI::App& app) {
  const auto [command, options] = cli::add_command<OpponentsArguments>(
      app, "opponents", "Measure kelpie by other people's protocols and streams", run_opponents);
  cli::add_folder(command, "--data", options->data,
                  "folder of dagon_config1.csv and peer_streams/*.csv");
  command->get_option("--data")->capture_default_str();
  command->add_option("--every", options->every, "steps between two scores")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  cli::add_threads(command, options->threads);
  cli::add_out(command, options->out, "folder for opponents.json");
}

}  // namespace kelpie::lab
