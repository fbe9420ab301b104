// SPDX-License-Identifier: Apache-2.0
#include "live/recorder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "bag/autopilot_state.hpp"
#include "bag/topic_columns.hpp"
#include "bag/tuning.hpp"
#include "file/atomic_file.hpp"
#include "kelpie/core/error.hpp"
#include "live/tuning.hpp"

namespace kelpie::live {

void ParameterMessages::hear(const std::vector<bag::Topic>& topics, const bag::Message& message) {
  const Name name{message.topic, bag::parameter_told(topics[message.topic], message)};
  if (!name.second.empty() &&
      (last_.size() < bag::kTuning.most_parameters || last_.contains(name))) {
    last_[name].assign(message.data.begin(), message.data.end());
  }
}

void ParameterMessages::visit(const bag::Message& like,
                              const std::function<void(const bag::Message&)>& use) const {
  bag::Message message = like;
  for (const auto& [name, data] : last_) {
    message.topic = name.first;
    message.data = data;
    use(message);
  }
}

Recorder::Recorder(std::filesystem::path folder, const std::filesystem::path& definitions)
    : folder_(std::move(folder)), definitions_(definitions) {
  open();
}

void Recorder::open() {
  written_ = std::chrono::steady_clock::now();
  file::make_folder(folder_);
  // Numbers, not times: a clock that was set can't make two files one.
  int reason = EEXIST;
  for (int number = 1; reason == EEXIST; ++number) {
    path_ = folder_ / fmt::format("live_{:04}.mcap", number);
    file_.emplace(path_, O_WRONLY | O_CREAT | O_EXCL);
    reason = file_->is_open() ? 0 : errno;
  }
  if (reason != 0) {
    file_.reset();
    throw Failure(path_.string() +
                  ": cannot be written: " + std::generic_category().message(reason));
  }
  writer_.emplace();
  bytes_ = 0;
  topics_ = 0;
  is_new_ = true;
  has_chunks_ = false;
}

bool Recorder::reopen() {
  try {
    open();
  } catch (const Failure& failure) {
    error_ = failure.what();
  }
  return file_.has_value();
}

void Recorder::write(const std::vector<bag::Topic>& topics, const bag::Message& message) {
  bool is_time = std::chrono::steady_clock::now() - written_ > kTuning.between_recordings;
  if (!file_ && !(is_time && reopen())) {
    ++lost_;
    return;
  }
  is_time = is_time && !is_new_;  // the disk may have room for one message and for no chunk
  for (; topics_ < topics.size(); ++topics_) {
    bag::Topic topic = topics[topics_];
    try {
      topic.definition = bag::definition_of(topic, definitions_);
    } catch (const InputError&) {  // readers may have the definition
      topic.definition.clear();
    }
    writer_->add_topic(topic);
  }
  const bool is_new = std::exchange(is_new_, false);
  if (is_new && !append(writer_->take())) {  // the head: nothing recorded so far
    ++lost_;
    return;
  }
  if (is_new && parameters_ != nullptr) {
    parameters_->visit(message, [&](const bag::Message& known) { writer_->write(known); });
  }
  writer_->write(message);
  ++waiting_;
  if (is_time) {
    written_ = std::chrono::steady_clock::now();
  }
  note_written(writer_->take(is_time));
}

void Recorder::finish() {
  if (file_) {
    note_written(writer_->finish());
  }
}

bool Recorder::append(const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(file_->number(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count <= 0) {
      error_ = folder_.string() + ": " + std::generic_category().message(errno);
      give_up();
      return false;
    }
    done += static_cast<std::size_t>(count);
  }
  bytes_ += bytes.size();
  return true;
}

void Recorder::note_written(const std::string& bytes) {
  if (!bytes.empty() && append(bytes)) {
    error_.clear();
    waiting_ = 0;
    has_chunks_ = true;
  }
}

// The file keeps its whole chunks. A file without any has nothing for a reader.
void Recorder::give_up() {
  if (!has_chunks_) {
    ::unlink(path_.c_str());
  } else if (::ftruncate(file_->number(), static_cast<off_t>(bytes_)) != 0) {
    error_ += ", and its last file has an incomplete end";
  }
  file_.reset();
  writer_.reset();
  lost_ += std::exchange(waiting_, 0);
}

}  // namespace kelpie::live
