// SPDX-License-Identifier: Apache-2.0
#include "format/live_library.hpp"

#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "file/child_process.hpp"
#include "file/mapped_file.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "model/model_axis.hpp"
#include "model/snapshot.hpp"

namespace kelpie::format {
namespace {

std::string block_content(const TrainedModel& model, const BlockLayout& layout) {
  std::vector<std::uint64_t> words(layout.bytes() / sizeof(std::uint64_t));
  const std::span<std::byte> memory = std::as_writable_bytes(std::span(words));
  ModelBlock::clear(memory, layout);
  ModelBlock(memory, layout).publish(model.input_names, model.axes, model.alignment);
  return {reinterpret_cast<const char*>(memory.data()), memory.size()};  // NOLINT: bytes of a file
}

// The compiler of CC, which may have words more, as in "ccache cc".
std::vector<std::string> compiler_words() {
  const char* const named = std::getenv("CC");  // NOLINT(concurrency-mt-unsafe): before threads
  std::istringstream text(named != nullptr ? named : "");
  std::vector<std::string> words{std::istream_iterator<std::string>(text), {}};
  return words.empty() ? std::vector<std::string>{"cc"} : words;
}

// A library compiled beside its place, and removed unless it was renamed.
class LibraryDraft {
 public:
  LibraryDraft(const LiveFiles& files, const std::string& source)
      : source_(files.library.string() + ".draft.c"), library_(files.library.string() + ".draft") {
    file::write_file_whole(source_, source);
    try {
      compile(files);
    } catch (...) {
      remove();
      throw;
    }
  }
  ~LibraryDraft() { remove(); }
  LibraryDraft(const LibraryDraft&) = delete;
  LibraryDraft& operator=(const LibraryDraft&) = delete;

  void rename_to(const std::filesystem::path& library) {
    std::filesystem::rename(library_, library);
  }

 private:
  void compile(const LiveFiles& files) const {
    std::vector<std::string> words = compiler_words();
    const std::string compiler = join_text(words, " ");
    words.insert(words.end(), {"-std=c99", "-O3", "-march=native", "-fPIC", "-shared", "-o",
                               library_.string(), source_.string(), "-lm"});
    if (file::run_child(std::move(words), "the C compiler",
                        "the environment variable CC names another") != 0) {
      throw Failure("the C compiler '" + compiler + "' could not compile " + files.source.string());
    }
  }

  void remove() const {
    std::error_code ignored;
    std::filesystem::remove(source_, ignored);
    std::filesystem::remove(library_, ignored);
  }

  std::filesystem::path source_;
  std::filesystem::path library_;
};

}  // namespace

LiveFiles::LiveFiles(std::filesystem::path library_file)
    : library(std::move(library_file)), block(library), source(library) {
  block.replace_extension(".block");
  source.replace_extension(".c");
}

BlockLayout live_layout(const TrainedModel& model, bool assess) {
  const DynamicsModel learner(model.input_names, model.target_names(), model.settings);
  std::vector<Snapshot> capacity;
  for (std::size_t k = 0; k < model.axes.size(); ++k) {
    capacity.push_back(learner.mechanisms(k).snapshot());
  }
  return BlockLayout::of(model.input_names, model.target_names(), model.terms, capacity, assess);
}

void write_live_library(const LiveFiles& files, const TrainedModel& model, CodeOptions options) {
  if (file::is_shared(files.block)) {
    throw InputError({.file = files.block.string(), .line = 0, .field = {}},
                     "is renewed by a running learner; stop the learner first");
  }
  options.casadi = true;
  options.live = {.file = std::filesystem::absolute(files.block).string(),
                  .layout = live_layout(model, options.assess)};
  const std::string source = model_c(model, options);
  LibraryDraft draft(files, source);
  file::write_file_whole(files.block, block_content(model, options.live->layout));
  file::write_file_whole(files.source, source);
  draft.rename_to(files.library);
}

}  // namespace kelpie::format
