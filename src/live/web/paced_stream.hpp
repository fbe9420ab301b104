// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <utility>

#include "web/events.hpp"

struct MHD_Connection;

namespace kelpie::web {

/// An EventStream on a connection. The connection is suspended from the end of a text until the
/// next resume(), which sets the pace.
class PacedStream {
 public:
  PacedStream(EventStream events, MHD_Connection* connection)
      : events_(std::move(events)), connection_(connection) {}

  /// The library's content reader: at most `most` bytes; 0 where the connection was suspended.
  ssize_t read(char* to, std::size_t most);
  void resume();  ///< Permits the next text.
  void end();     ///< Permits the last texts, then ends the answer.
  bool has_sent_all() const { return is_last_ && sent_ == text_.size(); }

 private:
  EventStream events_;
  MHD_Connection* connection_;
  std::string text_;
  std::size_t sent_ = 0;
  bool is_due_ = true;  // the next text
  bool waits_ = false;  // suspended
  bool has_ended_ = false;
  bool is_last_ = false;  // text_
};

}  // namespace kelpie::web
