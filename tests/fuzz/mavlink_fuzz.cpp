// SPDX-License-Identifier: Apache-2.0
// libFuzzer's target for MAVLink: whatever the bytes, and in whatever pieces they come, they end in
// frames, numbers and counts. CONTRIBUTING.md has the command.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mavlink/frame_parser.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::byte> left = std::as_bytes(std::span(data, size));
  const std::size_t piece = size == 0 ? 1 : 1 + data[size - 1];  // as good as any
  kelpie::mavlink::FrameParser parser;
  kelpie::mavlink::Frame frame;
  double sum = 0.0;
  while (!left.empty()) {
    parser.add(left.first(std::min(piece, left.size())));
    left = left.subspan(std::min(piece, left.size()));
    while (parser.next(frame)) {
      for (const kelpie::mavlink::Field& field : frame.definition->fields) {
        if (field.kind == kelpie::mavlink::FieldKind::characters) {
          sum += static_cast<double>(kelpie::mavlink::text_at(field, frame.payload).size());
        } else {
          sum += kelpie::mavlink::number_at(field, frame.payload, field.count - 1);
        }
      }
    }
  }
  return sum == -1.0 ? 1 : 0;
}
