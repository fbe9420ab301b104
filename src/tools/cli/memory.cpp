// SPDX-License-Identifier: Apache-2.0

#include <memory>
#include <string>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "file/atomic_file.hpp"
#include "file/descriptor.hpp"
#include "format/memory_json.hpp"
#include "kelpie/core/error.hpp"
#include "report/memory_table.hpp"

namespace kelpie::cli {
namespace {

struct MemoryArguments {
  std::string file;
  std::string model;
};

// A file and, but for the list, a model in it.
CLI::App* add_task(CLI::App& memory, const char* name, const char* what, MemoryArguments& options) {
  CLI::App* const task = memory.add_subcommand(name, what);
  add_file(task, "file", options.file, "memory that `kelpie learn --memory` wrote")->required();
  if (std::string(name) != "list") {
    task->add_option("model", options.model, "its name in the list, as in udot:2")->required();
  }
  return task;
}

void list_models(const MemoryArguments& options) {
  const format::PastModelsFile memory = format::read_memory(options.file);
  if (memory.size() == 0) {
    throw InputError({.file = options.file, .line = 0, .field = "axes"},
                     "the memory holds no models yet; `kelpie learn --memory` keeps one when it "
                     "has been in service for a while without a change");
  }
  say("{}", report::memory_table(memory));
}

void show_model(const MemoryArguments& options) {
  format::PastModelsFile memory = format::read_memory(options.file);
  say("{}",
      report::past_model_table(memory, options.model, memory.find(options.model, options.file)));
}

void forget_model(const MemoryArguments& options) {
  const file::FolderLock lock(options.file);
  format::PastModelsFile memory = format::read_memory(options.file);
  memory.forget(options.model, options.file);
  file::write_file_whole(options.file, format::memory_json(memory));
  say("{}: {} is forgotten; {} models are left\n", options.file, options.model, memory.size());
}

}  // namespace

void add_memory(CLI::App& app) {
  auto options = std::make_shared<MemoryArguments>();
  CLI::App* const command =
      app.add_subcommand("memory", "List, show or forget the past models of a vehicle");
  command->require_subcommand(1);
  add_task(*command, "list", "All past models, a line each", *options)->callback([options] {
    list_models(*options);
  });
  add_task(*command, "show", "One past model with the ranges of its columns", *options)
      ->callback([options] { show_model(*options); });
  add_task(*command, "forget", "Remove one past model from the file", *options)
      ->callback([options] { forget_model(*options); });
  add_examples(command, "memory list past.json", "memory show past.json udot:2");
}

}  // namespace kelpie::cli
