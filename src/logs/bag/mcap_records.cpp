// SPDX-License-Identifier: Apache-2.0
#include "bag/mcap_records.hpp"

#include <fmt/format.h>

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

Record RecordCursor::next(const Region& region) {
  const std::uint64_t offset = at_;
  const std::uint64_t left = bytes_.size() - at_;
  const std::span<const std::byte> here = bytes_.subspan(static_cast<std::size_t>(at_));
  at_ = bytes_.size();
  if (left < kRecordHead) {
    region.refuse(offset, fmt::format("is cut off: {} bytes where a record is due", left));
  }
  const auto opcode = number_at<std::uint8_t>(here, std::endian::little);
  const auto length = number_at<std::uint64_t>(here.subspan(1), std::endian::little);
  if (opcode == 0) {
    region.refuse(offset, "no record begins here; 0 is no kind of record");
  }
  if (length > left - kRecordHead) {
    region.refuse(offset, fmt::format("is cut off or damaged: a record of {} bytes begins here, {} "
                                      "are left",
                                      length, left - kRecordHead));
  }
  at_ = offset + kRecordHead + length;
  return {static_cast<Opcode>(opcode), here.subspan(kRecordHead, static_cast<std::size_t>(length)),
          offset};
}

McapSchema read_schema(ByteReader reader) {
  McapSchema schema;
  schema.id = reader.number<std::uint16_t>();
  schema.name = reader.text();
  schema.encoding = reader.text();
  schema.text = reader.text();
  return schema;
}

McapChannel read_channel(ByteReader reader) {
  McapChannel channel;
  channel.id = reader.number<std::uint16_t>();
  channel.schema = reader.number<std::uint16_t>();
  channel.topic = reader.text();
  channel.encoding = reader.text();
  const auto bytes = reader.number<std::uint32_t>();
  if (bytes > reader.left()) {
    reader.refuse("the metadata of a channel are longer than its record");
  }
  const std::uint64_t end = reader.left() - bytes;
  while (reader.left() > end) {
    const std::string key(reader.text());
    channel.metadata[key] = reader.text();
  }
  return channel;
}

McapChunk read_chunk(ByteReader reader) {
  McapChunk chunk;
  chunk.first_ns = reader.number<std::uint64_t>();
  chunk.last_ns = reader.number<std::uint64_t>();
  chunk.size = reader.number<std::uint64_t>();
  chunk.crc = reader.number<std::uint32_t>();
  chunk.compression = reader.text();
  chunk.packed = reader.take(reader.number<std::uint64_t>());
  return chunk;
}

McapFooter read_footer(ByteReader reader) {
  McapFooter footer;
  footer.summary = reader.number<std::uint64_t>();
  footer.summary_offsets = reader.number<std::uint64_t>();
  footer.crc = reader.number<std::uint32_t>();
  return footer;
}

std::uint64_t read_chunk_index_offset(ByteReader reader) {
  reader.take(2 * sizeof(std::uint64_t));
  return reader.number<std::uint64_t>();
}

std::uint64_t read_statistics_messages(ByteReader reader) {
  return reader.number<std::uint64_t>();
}

void check_message_index(ByteReader reader, std::uint64_t chunk_size) {
  reader.number<std::uint16_t>();
  const auto bytes = reader.number<std::uint32_t>();
  if (bytes > reader.left() || bytes % (2 * sizeof(std::uint64_t)) != 0) {
    reader.refuse("the length of a message index is wrong");
  }
  for (std::uint32_t at = 0; at < bytes; at += 2 * sizeof(std::uint64_t)) {
    reader.number<std::uint64_t>();
    if (reader.number<std::uint64_t>() >= chunk_size) {
      reader.refuse("a message index points behind the end of its chunk");
    }
  }
}

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
