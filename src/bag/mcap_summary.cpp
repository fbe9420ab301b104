// SPDX-License-Identifier: Apache-2.0
#include "bag/mcap_summary.hpp"

#include <algorithm>

#include "file/crc32.hpp"

namespace kelpie::bag {
namespace {

constexpr std::size_t kFooterBytes = 20;
constexpr std::size_t kEnding = kRecordHead + kFooterBytes + kMcapMagic.size();

// Refuses a summary that isn't as it was written.
void check_summary(std::span<const std::byte> bytes, const Region& region, const McapFooter& footer,
                   std::uint64_t footer_offset) {
  if (footer.summary < kMcapMagic.size() || footer.summary > footer_offset) {
    region.refuse(footer_offset, "the footer points to no summary");
  }
  const std::uint64_t end = footer_offset + kRecordHead + kFooterBytes - sizeof(footer.crc);
  const auto checked = bytes.subspan(static_cast<std::size_t>(footer.summary),
                                     static_cast<std::size_t>(end - footer.summary));
  if (footer.crc != 0 && file::crc32_of(checked) != footer.crc) {
    region.refuse(footer.summary, "the summary is damaged: its CRC is wrong");
  }
}

McapFooter footer_of(std::span<const std::byte> bytes, const Region& region) {
  if (bytes.size() < kMcapMagic.size() + kEnding ||
      !has_mcap_magic(bytes.last(kMcapMagic.size()))) {
    region.refuse(bytes.size(),
                  "is cut off, or still being written: it doesn't end as MCAP files "
                  "do; --recover reads what is there");
  }
  RecordCursor cursor(bytes);
  cursor.jump(bytes.size() - kEnding);
  const Record record = cursor.next(region);
  if (record.opcode != Opcode::footer || record.content.size() != kFooterBytes) {
    region.refuse(record.offset, "the footer is damaged");
  }
  return read_footer(record.reader(region));
}

}  // namespace

bool has_mcap_magic(std::span<const std::byte> bytes) {
  return text_of(bytes).starts_with(kMcapMagic);
}

McapSummary read_mcap_summary(std::span<const std::byte> bytes, const Region& region) {
  McapSummary summary;
  const McapFooter footer = footer_of(bytes, region);
  if (footer.summary == 0) {
    return summary;
  }
  const std::size_t footer_offset = bytes.size() - kEnding;
  check_summary(bytes, region, footer, footer_offset);
  std::vector<Record> channels;
  RecordCursor cursor(bytes.first(footer_offset));
  cursor.jump(footer.summary);
  while (!cursor.done()) {
    const Record record = cursor.next(region);
    if (record.opcode == Opcode::schema) {
      summary.definitions.push_back(record);
    } else if (record.opcode == Opcode::channel) {
      channels.push_back(record);
    } else if (record.opcode == Opcode::chunk_index) {
      summary.chunk_offsets.push_back(read_chunk_index_offset(record.reader(region)));
    } else if (record.opcode == Opcode::statistics) {
      summary.messages = read_statistics_messages(record.reader(region));
    }
  }
  summary.definitions.insert(summary.definitions.end(), channels.begin(), channels.end());
  std::ranges::sort(summary.chunk_offsets);
  return summary;
}

}  // namespace kelpie::bag
