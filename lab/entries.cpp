// SPDX-License-Identifier: Apache-2.0
#include "lab/entries.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <thread>

#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "file/child_process.hpp"
#include "file/content.hpp"
#include "file/json.hpp"
#include "kelpie/core/error.hpp"
#include "log/candidates.hpp"

namespace kelpie::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 1U << 30U;

// A folder of this process that lasts as long as the object.
class WorkFolder {
 public:
  WorkFolder() : path_(fs::temp_directory_path() / fmt::format("kelpie-entries-{}", ::getpid())) {
    fs::create_directory(path_);
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string column_name(std::size_t split) {
  return fmt::format("held_out_{}", split);
}

// Columns t, conf, inputs, targets, and a column for each split, with 1 in the rows held out.
log::Table table_of(const EntryStream& stream) {
  const log::Dataset& data = stream.data;
  log::Table table;
  const auto add = [&](const std::string& name, auto value) {
    table.names.push_back(name);
    std::vector<double>& column = table.columns.emplace_back();
    for (std::size_t row = 0; row < data.rows(); ++row) {
      column.push_back(value(row));
    }
  };
  add("t", [&](std::size_t row) { return data.times_s[row]; });
  add("conf", [&](std::size_t row) { return static_cast<double>(data.configurations[row]); });
  for (std::size_t i = 0; i < data.input_names.size(); ++i) {
    add(data.input_names[i], [&](std::size_t row) { return data.input(row)[i]; });
  }
  for (std::size_t i = 0; i < data.target_names.size(); ++i) {
    add(data.target_names[i], [&](std::size_t row) { return data.target(row)[i]; });
  }
  for (std::size_t i = 0; i < stream.splits.size(); ++i) {
    const std::vector<std::size_t>& held_out = stream.splits[i].held_out;
    // Rows in neither part, of a stream judged on a part of its range, are learned by no learner.
    const std::vector<std::size_t>& training = stream.splits[i].training;
    add(column_name(i), [&](std::size_t row) {
      return std::ranges::binary_search(held_out, row)   ? 1.0
             : std::ranges::binary_search(training, row) ? 0.0
                                                         : 2.0;
    });
  }
  table.lines.resize(data.rows());
  return table;
}

std::string list_of(const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  std::ranges::transform(names, std::back_inserter(quoted), log::toml_text);
  return "[" + join_text(quoted, ", ") + "]";
}

std::string manifest_of(std::size_t number, const EntryStream& stream) {
  std::vector<std::string> columns;
  for (std::size_t i = 0; i < stream.splits.size(); ++i) {
    columns.push_back(column_name(i));
  }
  return fmt::format(
      "[[data]]\nname = \"{0}\"\nfiles = [\"{0}.csv\"]\ninputs = {1}\ntargets = {2}\n"
      "time = \"t\"\nrate = {3}\npieces = 10\nconfiguration = \"conf\"\nheld_out = {4}\n"
      "tracks = [\"paper\"]\n",
      number, list_of(stream.data.input_names), list_of(stream.data.target_names),
      stream.data.rate_hz, list_of(columns));
}

SeedRun run_of(const file::Json& split, const std::vector<std::string>& axes) {
  SeedRun run;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const auto r2_of = [&](const file::Json& look) {
      const file::Json& r2 = look["r2"][axis];
      return r2.is_null() ? study::kUnknown : r2.get<double>();
    };
    study::AxisResult& result = run.axes.emplace_back();
    result.name = axes[axis];
    for (const file::Json& look : split["looks"]) {
      study::ValidationPoint& point = result.validation.emplace_back();
      point.samples = look["rows"].get<std::size_t>();
      point.time_s = look["t"].get<double>();
      point.configuration = look["vehicle"].get<int>();
      point.r2 = r2_of(look);
      point.status.ready = true;
      if (look["ends"].get<bool>()) {
        result.stages.push_back({point.configuration, point.samples, point.r2, {}, {}, {}});
      }
    }
  }
  return run;
}

// The last line that the benchmark said.
std::string reason_in(const fs::path& output) {
  std::vector<std::string> lines =
      split_text(file::read_content(output, "output of Python", kMostBytes), '\n');
  std::erase_if(lines, [](const std::string& line) { return line.empty(); });
  return lines.empty() ? "nothing was said" : lines.back();
}

}  // namespace

std::vector<EntryRuns> run_entries(const std::vector<std::string>& places,
                                   const std::vector<EntryStream>& streams, std::uint64_t seed,
                                   std::size_t threads) {
  const WorkFolder folder;
  file::FileSet files;
  std::string manifest;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    files[fmt::format("{}.csv", i)] = log::csv_text(table_of(streams[i]));
    manifest += manifest_of(i, streams[i]);
  }
  files["paper.toml"] = manifest;
  file::write_files_whole(folder.path(), files);
  std::vector<std::string> words{
      "python3",
      "-m",
      "kelpie.benchmark",
      "run",
      (folder.path() / "paper.toml").string(),
      "--out",
      folder.path().string(),
      "--only",
      "none",
      "--rows",
      "200",
      "--seed",
      fmt::format("{}", seed),
      "--jobs",
      fmt::format("{}", threads == 0 ? std::thread::hardware_concurrency() : threads)};
  for (const std::string& place : places) {
    words.insert(words.end(), {"--entry", place});
  }
  const fs::path output = folder.path() / "output";
  const int status =
      file::run_child(words, "Python", "--entry needs Python with kelpie's package", output);
  if (status != 0) {
    const std::string reason = reason_in(output);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 2) {
      throw InputError("--entry", reason);
    }
    throw Failure("--entry: " + reason);
  }
  const file::Json found =
      file::parse_json(file::read_content(folder.path() / "benchmark.json", "results", kMostBytes),
                       "benchmark.json");
  std::vector<EntryRuns> entries;
  for (const file::Json& entry : found["entries"]) {
    if (entry["kind"] == "yours") {
      const auto name = entry["name"].get<std::string>();
      entries.push_back({"entry_" + name, name, places[entries.size()], {}});
    }
  }
  for (EntryRuns& entry : entries) {
    for (std::size_t i = 0; i < streams.size(); ++i) {
      std::vector<SeedRun>& runs = entry.runs.emplace_back();
      for (const file::Json& result : found["results"]) {
        if (result["entry"] == entry.name && result["data"] == fmt::format("{}", i)) {
          for (const file::Json& split : result["paper"]["splits"]) {
            runs.push_back(run_of(split, streams[i].data.target_names));
          }
        }
      }
    }
  }
  return entries;
}

}  // namespace kelpie::lab
