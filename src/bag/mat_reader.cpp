// SPDX-License-Identifier: Apache-2.0
#include "bag/mat_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "wire/scalar.hpp"

namespace kelpie::bag {
namespace {

class MatReader final : public BagReader {
 public:
  MatReader(const std::filesystem::path& file, ReadMode mode, const RowTimes& times)
      : BagReader(mode, file.string()),
        arrays_(read_mat_arrays(file, [this](const InputError& damage) { lose(damage); })),
        topics_(topics_of(times)) {
    for (const MatTopic& topic : topics_) {
      add_topic({.name = topic.name,
                 .type = topic.has_time ? "matlab/Rows" : "matlab/RowsWithoutTime",
                 .encoding = "ros1",
                 .definition = topic.definition},
                source());
    }
    rows_.resize(topics_.size(), 0);
  }

  bool next(Message& message) override {
    while (find_next()) {
      const MatTopic& topic = topics_[at_];
      row_ = rows_[at_]++;
      if (topic.times_ns[row_] == MatTopic::kNoTime) {
        lose(InputError(place(), "has no time that can be"));
        continue;
      }
      message.topic = at_;
      message.receive_ns = topic.times_ns[row_];
      message.publish_ns = message.receive_ns;
      message.sequence = static_cast<std::uint32_t>(row_);
      put_together(topic);
      message.data = payload_;
      return true;
    }
    return false;
  }

  Place place() const override {
    return {.file = source(),
            .line = 0,
            .field =
                at_ < topics_.size() ? fmt::format("{}, row {}", topics_[at_].name, row_ + 1) : ""};
  }

 private:
  std::vector<MatTopic> topics_of(const RowTimes& times) const {
    try {
      return mat_topics(arrays_, times);
    } catch (const InputError& error) {
      throw InputError({.file = source(), .line = 0, .field = {}}, error.what());
    }
  }

  // The topic whose next row is the earliest.
  bool find_next() {
    at_ = topics_.size();
    for (std::size_t k = 0; k < topics_.size(); ++k) {
      const bool is_left = rows_[k] < topics_[k].times_ns.size();
      if (is_left && (at_ == topics_.size() ||
                      topics_[k].times_ns[rows_[k]] < topics_[at_].times_ns[rows_[at_]])) {
        at_ = k;
      }
    }
    return at_ < topics_.size();
  }

  void put_together(const MatTopic& topic) {
    payload_.clear();
    for (const MatTopic::Column& column : topic.columns) {
      for (std::size_t k = 0; k < column.width(); ++k) {
        payload_.resize(payload_.size() + sizeof(double));
        wire::store_number(std::span(payload_).last(sizeof(double)), wire::FieldKind::float64,
                           column.value(row_, k));
      }
    }
  }

  std::vector<MatArray> arrays_;
  std::vector<MatTopic> topics_;
  std::vector<std::size_t> rows_;  // the next one of each topic
  std::size_t at_ = 0;             // the topic of the row given last
  std::size_t row_ = 0;
  std::vector<std::byte> payload_;
};

}  // namespace

bool is_mat(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    return false;
  }
  std::string beginning(128, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  return begins_as_mat(beginning);
}

std::unique_ptr<BagReader> read_mat(const std::filesystem::path& file, ReadMode mode,
                                    const RowTimes& times) {
  return std::make_unique<MatReader>(file, mode, times);
}

}  // namespace kelpie::bag
