// SPDX-License-Identifier: Apache-2.0
#include "web/paced_stream.hpp"

#include <microhttpd.h>

#include <algorithm>
#include <utility>

namespace kelpie::web {

ssize_t PacedStream::read(char* to, std::size_t most) {
  if (!is_last_ && sent_ == text_.size() && std::exchange(is_due_, false)) {
    text_ = events_.next();
    sent_ = 0;
    is_last_ = has_ended_;
  }
  if (has_sent_all()) {
    return MHD_CONTENT_READER_END_OF_STREAM;
  }
  const std::size_t bytes = std::min(most, text_.size() - sent_);
  if (bytes == 0) {
    waits_ = true;
    ::MHD_suspend_connection(connection_);
  }
  std::copy_n(text_.data() + sent_, bytes, to);
  sent_ += bytes;
  return static_cast<ssize_t>(bytes);
}

void PacedStream::resume() {
  is_due_ = true;
  if (std::exchange(waits_, false)) {
    ::MHD_resume_connection(connection_);
  }
}

void PacedStream::end() {
  has_ended_ = true;
  resume();
}

}  // namespace kelpie::web
