// SPDX-License-Identifier: Apache-2.0
// How long a message takes from a publisher in another process until it is taken out of the queue:
// latency PEER RATE COUNT BYTES, with PEER the program of an implementation (peer_cyclone).

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "dds/loopback.hpp"

namespace {

namespace dds = kelpie::dds;
namespace testing = kelpie::testing;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

int measure(const std::string& program, const std::string& rate, std::size_t count,
            const std::string& size) {
  const dds::Participant participant(dds::Network::loopback(testing::own_domain()));
  dds::MessageQueue queue;
  const dds::Subscription odometry(participant, "/odom", "nav_msgs/msg/Odometry",
                                   dds::Quality::sensor_data(), queue, 0);
  testing::Peer peer(program);
  peer.order("publish /odom nav_msgs/msg/Odometry best_effort");
  if (!testing::connected(peer, odometry)) {
    return 1;
  }
  peer.say("stream " + rate + " " + std::to_string(count) + " " + size);
  std::vector<double> times;
  dds::TopicSample message;
  while (times.size() < count && queue.pop(message, std::chrono::seconds(2))) {
    if (message.cdr != testing::hello()) {
      std::int64_t sent = 0;
      std::memcpy(&sent, message.cdr.data() + 12, sizeof sent);
      times.push_back(1e-6 * static_cast<double>(now_ns() - sent));
    }
  }
  if (times.empty()) {
    return 1;
  }
  std::ranges::sort(times);
  const auto at = [&](double part) {
    return times[static_cast<std::size_t>(part * static_cast<double>(times.size() - 1))];
  };
  std::printf("%s Hz, %zu messages of %s bytes: lost %zu, median %.3f ms, p99 %.3f, most %.3f\n",
              rate.c_str(), count, size.c_str(), count - times.size(), at(0.5), at(0.99),
              times.back());
  return 0;
}

}  // namespace

int main(int count, char** words) {  // NOLINT(bugprone-exception-escape): a tool by hand
  if (count != 5) {
    std::puts("latency PEER RATE COUNT BYTES");
    return 2;
  }
  return measure(words[1], words[2], std::strtoul(words[3], nullptr, 10), words[4]);
}
