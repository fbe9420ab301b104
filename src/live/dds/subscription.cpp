// SPDX-License-Identifier: Apache-2.0
#include "dds/subscription.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <array>
#include <atomic>
#include <chrono>
#include <exception>

#include "dds/raw_type.hpp"
#include "dds/topic_end.hpp"

namespace kelpie::dds {
namespace {

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

// Context of the library's receiving thread, at a fixed address while the reader exists.
struct Subscription::Reception {
  Reception(const Participant& participant, const Endpoint& own, MessageQueue& to, std::size_t as,
            std::size_t most)
      : end(participant, own), queue(to), tag(as), most_bytes(most) {
    const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(
        dds_create_listener(this), dds_delete_listener);
    dds_lset_data_available(listener.get(), [](dds_entity_t reader_number, void* reception) {
      static_cast<Reception*>(reception)->take_all(reader_number);
    });
    reader = Entity(dds_create_reader(participant.number(), end.number(), qos_of(own.quality).get(),
                                      listener.get()),
                    own.topic + " couldn't be subscribed to");
  }

  void take_all(dds_entity_t reader_number) {
    constexpr std::uint32_t kStep = 16;
    std::array<ddsi_serdata*, kStep> samples{};
    std::array<dds_sample_info_t, kStep> infos{};
    dds_return_t count = 0;
    do {
      count = dds_takecdr(reader_number, samples.data(), kStep, infos.data(), DDS_ANY_STATE);
      for (dds_return_t i = 0; i < count; ++i) {
        const auto index = static_cast<std::size_t>(i);
        if (infos[index].valid_data) {
          put(*samples[index], infos[index].source_timestamp);
        }
        ddsi_serdata_unref(samples[index]);
      }
    } while (count == static_cast<dds_return_t>(kStep));
  }

  void put(const ddsi_serdata& sample, dds_time_t source_ns) {
    received.fetch_add(1, std::memory_order_relaxed);
    const std::span<const std::byte> bytes = bytes_of(&sample);
    if (bytes.size() > most_bytes) {
      too_long.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    try {
      queue.push(tag, source_ns, now_ns(), bytes);
    } catch (const std::exception&) {  // out of memory: no exception may pass C code
      unstored.fetch_add(1, std::memory_order_relaxed);
    }
  }

  TopicEnd end;
  MessageQueue& queue;
  std::size_t tag;
  std::size_t most_bytes;
  std::atomic<std::uint64_t> received = 0;
  std::atomic<std::uint64_t> unstored = 0;
  std::atomic<std::uint64_t> too_long = 0;
  Entity reader;  // last: destroyed first, which ends the calls
};

Subscription::Subscription(const Participant& participant, const std::string& topic,
                           const std::string& type, const Quality& quality, MessageQueue& queue,
                           std::size_t tag, std::size_t most_bytes)
    : reception_(std::make_unique<Reception>(
          participant, Endpoint{.own = true, .topic = topic, .type = type, .quality = quality},
          queue, tag, most_bytes)) {}

Subscription::~Subscription() = default;

std::size_t Subscription::publishers() const {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reception_->reader.number(), &status);
  return status.current_count;
}

std::uint64_t Subscription::received() const {
  return reception_->received;
}

std::uint64_t Subscription::lost() const {
  dds_sample_lost_status_t status{};
  dds_get_sample_lost_status(reception_->reader.number(), &status);
  return status.total_count + reception_->unstored;
}

std::uint64_t Subscription::too_long() const {
  return reception_->too_long;
}

std::vector<std::string> Subscription::mismatches() const {
  return reception_->end.mismatches(reception_->reader.number());
}

}  // namespace kelpie::dds
