// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bag/message_builder.hpp"
#include "bag/reader.hpp"
#include "kelpie/stream/stream_plan.hpp"
#include "live/configuration.hpp"
#include "log/dataset.hpp"
#include "log/read_log.hpp"

namespace kelpie::live {

/// The rows of a table as a recording: a message per row, on one topic with a number for each input
/// and target. FurtherRows follow.
class RowReader final : public bag::MessageReader {
 public:
  static constexpr const char* kTopic = "rows";

  /// `further` may be null.
  RowReader(std::shared_ptr<const log::Dataset> rows, std::shared_ptr<FurtherRows> further);

  Place place() const override;

  /// Sources of a stream that makes the same rows again.
  static std::vector<StreamPlan::Source> sources_of(const log::Dataset& rows);
  static log::Reach reach_of(const log::Dataset& rows, const FurtherRows* further);

 private:
  bool step(bag::Message& message) override;
  bool at_end() const override { return next_ == rows_->rows(); }

  std::shared_ptr<const log::Dataset> rows_;  // at present
  std::shared_ptr<FurtherRows> further_;
  double first_s_;
  std::vector<std::string> fields_;  // inputs, then targets
  bag::MessageBuilder builder_;
  std::size_t next_ = 0;     // of the present rows
  std::uint32_t count_ = 0;  // of all
};

}  // namespace kelpie::live
