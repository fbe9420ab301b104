// SPDX-License-Identifier: Apache-2.0
#include "bag/mat_reader.hpp"

#include <fmt/format.h>

#include <vector>

#include "bag/mat_topics.hpp"
#include "kelpie/core/error.hpp"
#include "wire/scalar.hpp"

namespace kelpie::bag {
namespace {

class MatReader final : public MessageReader {
 public:
  MatReader(const std::filesystem::path& file, ReadMode mode, const RowTimes& times)
      : MessageReader(mode, file.string()),
        arrays_(read_mat_arrays(
            file, [this](const InputError& damage) { lose(damage); },
            [this](const std::string& what) { leave_out(what); })),
        topics_(topics_of(times)),
        rows_(topics_.size(), 0) {
    for (const MatTopic& topic : topics_) {
      add_topic({.name = topic.name,
                 .type = topic.has_time ? "matlab/Rows" : "matlab/RowsWithoutTime",
                 .encoding = "ros1",
                 .definition = topic.definition},
                source());
    }
    find_next();
  }

  Place place() const override {
    return {.file = source(),
            .field =
                at_ < topics_.size() ? fmt::format("{}, row {}", topics_[at_].name, row_ + 1) : ""};
  }

 private:
  bool at_end() const override { return next_ == topics_.size(); }

  bool step(Message& message) override {
    at_ = next_;
    row_ = rows_[at_]++;
    find_next();
    const MatTopic& topic = topics_[at_];
    const std::int64_t time_ns = topic.times_ns[row_];
    if (time_ns == MatTopic::kNoTime) {
      lose(InputError(place(), "has no valid time"));
      return false;
    }
    put_together(topic);
    message = {.topic = at_,
               .receive_ns = time_ns,
               .publish_ns = time_ns,
               .sequence = static_cast<std::uint32_t>(row_),
               .data = payload_};
    return true;
  }

  std::vector<MatTopic> topics_of(const RowTimes& times) const {
    return in_file(source(), [&] { return mat_topics(arrays_, times); });
  }

  // The topic whose next row is the earliest.
  void find_next() {
    next_ = topics_.size();
    for (std::size_t k = 0; k < topics_.size(); ++k) {
      const bool is_left = rows_[k] < topics_[k].times_ns.size();
      if (is_left && (next_ == topics_.size() ||
                      topics_[k].times_ns[rows_[k]] < topics_[next_].times_ns[rows_[next_]])) {
        next_ = k;
      }
    }
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
  std::size_t next_ = 0;           // the topic of the next row; all topics: at the end
  std::size_t at_ = static_cast<std::size_t>(-1);  // the topic of the row given last
  std::size_t row_ = 0;
  std::vector<std::byte> payload_;
};

}  // namespace

bool begins_as_mat(std::string_view beginning) {
  constexpr std::size_t kMatHeader = 128;
  constexpr std::size_t kMatVersion = 124;
  const std::string_view mark =
      beginning.size() < kMatHeader ? "" : beginning.substr(kMatVersion, 4);
  using namespace std::string_view_literals;
  return beginning.starts_with("MATLAB ") &&
         (mark == "\0\1IM"sv || mark == "\0\2IM"sv || mark == "\1\0MI"sv || mark == "\2\0MI"sv);
}

std::unique_ptr<MessageReader> read_mat(const std::filesystem::path& file, ReadMode mode,
                                        const RowTimes& times) {
  return std::make_unique<MatReader>(file, mode, times);
}

}  // namespace kelpie::bag
