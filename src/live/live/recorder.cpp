// SPDX-License-Identifier: Apache-2.0
#include "live/recorder.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

#include "bag/topic_columns.hpp"
#include "file/atomic_file.hpp"
#include "kelpie/core/error.hpp"
#include "live/tuning.hpp"

namespace kelpie::live {
namespace {

// Numbers, not times: a clock that was set can't make two files one.
std::filesystem::path new_file(const std::filesystem::path& folder) {
  file::make_folder(folder);
  for (int number = 1;; ++number) {
    std::filesystem::path file = folder / fmt::format("live_{:04}.mcap", number);
    if (!std::filesystem::exists(file)) {
      return file;
    }
  }
}

}  // namespace

Recorder::Recorder(const std::filesystem::path& folder, const std::filesystem::path& definitions)
    : definitions_(definitions),
      path_(new_file(folder)),
      file_(path_, O_WRONLY | O_CREAT | O_EXCL),
      written_(std::chrono::steady_clock::now()) {
  if (!file_.is_open()) {
    throw Failure(path_.string() +
                  ": cannot be written: " + std::generic_category().message(errno));
  }
}

void Recorder::write(const std::vector<bag::Topic>& topics, const bag::Message& message) {
  if (!error_.empty()) {
    return;
  }
  for (; topics_ < topics.size(); ++topics_) {
    bag::Topic topic = topics[topics_];
    try {
      topic.definition = bag::definition_of(topic, definitions_);
    } catch (const InputError&) {  // readers may have the definition
      topic.definition.clear();
    }
    writer_.add_topic(topic);
  }
  writer_.write(message);
  const auto now = std::chrono::steady_clock::now();
  const bool is_time = now - written_ > kTuning.between_recordings;
  if (is_time) {
    written_ = now;
  }
  append(writer_.take(is_time));
}

void Recorder::finish() {
  if (error_.empty()) {
    append(writer_.finish());
  }
}

void Recorder::append(const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(file_.number(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count <= 0) {
      error_ =
          path_.string() + ": nothing more is recorded: " + std::generic_category().message(errno);
      return;
    }
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace kelpie::live
