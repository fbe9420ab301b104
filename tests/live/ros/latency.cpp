// SPDX-License-Identifier: Apache-2.0
// How long it takes from a message of the vehicle until `kelpie live` has predicted from the
// message, and has told the vehicle's velocity, there and back by DDS: ros_latency KELPIE RATE
// SECONDS. The vehicle sends its odometry and its forces at that rate each, three axes are learned
// at 10 Hz, and all is recorded.

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <utility>
#include <vector>

#include "bag/cdr.hpp"
#include "bag/message_builder.hpp"
#include "dds/loopback.hpp"
#include "dds/swimming.hpp"

namespace {

namespace bag = kelpie::bag;
namespace dds = kelpie::dds;
namespace fs = std::filesystem;
namespace testing = kelpie::testing;
using Clock = std::chrono::steady_clock;

constexpr double kWarmUpS = 60.0;  // until the equations of motion are known
constexpr std::chrono::milliseconds kAfterwards{
    500};  // shorter than what [log] takes for a silence

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string config() {
  return "[log]\ninputs = [\"u\", \"v\", \"r\", \"x\", \"y\", \"n\"]\n"
         "targets = [\"udot\", \"vdot\", \"rdot\"]\nrate = 10\nclock = \"header\"\n[log.states]\n"
         "u = \"/odom:twist.twist.linear.x\"\nv = \"/odom:twist.twist.linear.y\"\n"
         "r = \"/odom:twist.twist.angular.z\"\n[log.commands]\nx = \"/thrust:wrench.force.x\"\n"
         "y = \"/thrust:wrench.force.y\"\nn = \"/thrust:wrench.torque.z\"\n[log.derived]\n"
         "udot = \"d(u)\"\nvdot = \"d(v)\"\nrdot = \"d(r)\"\n"
         "[live]\nout = \"out\"\nrecord = \"rec\"\nalign = \"none\"\n[live.dds]\nloopback = true\n"
         "domain = " +
         std::to_string(testing::own_domain()) + "\n";
}

// kelpie at work in a folder of its own.
class Kelpie {
 public:
  explicit Kelpie(const std::string& program)
      : folder_(fs::temp_directory_path() / ("kelpie-latency-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "x.toml") << config();
    const std::string whole = fs::absolute(program).string();
    process_ = ::fork();
    if (process_ == 0) {
      const int sink = ::open("/dev/null", O_WRONLY);
      if (::chdir(folder_.c_str()) == 0 && ::dup2(sink, STDOUT_FILENO) >= 0) {
        ::execl(whole.c_str(), "kelpie", "live", "--config", "x.toml", nullptr);
      }
      ::_exit(127);
    }
  }
  ~Kelpie() { fs::remove_all(folder_); }
  Kelpie(const Kelpie&) = delete;
  Kelpie(Kelpie&&) = delete;
  Kelpie& operator=(const Kelpie&) = delete;
  Kelpie& operator=(Kelpie&&) = delete;

  // Its processor time so far [s].
  double computed_s() const {
    std::ifstream stream("/proc/" + std::to_string(process_) + "/stat");
    std::string word;
    double ticks = 0.0;
    for (int field = 1; field <= 15 && stream >> word; ++field) {
      ticks += field >= 14 ? std::strtod(word.c_str(), nullptr) : 0.0;
    }
    return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
  }
  int stop() const {
    int status = 0;
    ::kill(process_, SIGTERM);
    ::waitpid(process_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  fs::path folder_;
  pid_t process_ = 0;
};

// header.stamp, which begins every message that has one.
std::int64_t stamp_of(const std::vector<std::byte>& cdr) {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::memcpy(&sec, cdr.data() + 4, sizeof sec);
  std::memcpy(&nanosec, cdr.data() + 8, sizeof nanosec);
  return sec * std::int64_t{1'000'000'000} + nanosec;
}

constexpr std::size_t kPredictions = 0;
constexpr std::size_t kVelocities = 1;

class Vehicle {
 public:
  Vehicle()
      : participant_(dds::Network::loopback(testing::own_domain())),
        odometry_(participant_, "/odom", "nav_msgs/msg/Odometry"),
        wrench_(participant_, "/thrust", "geometry_msgs/msg/WrenchStamped"),
        predictions_(participant_, "/kelpie/prediction",
                     "geometry_msgs/msg/AccelWithCovarianceStamped", dds::Quality::standard(),
                     queue_, kPredictions),
        velocities_(participant_, "/kelpie/velocity",
                    "geometry_msgs/msg/TwistWithCovarianceStamped", dds::Quality::standard(),
                    queue_, kVelocities) {}

  // Drives for so long, and takes times where asked to.
  void drive(double rate, double seconds, bool measures) {
    const auto steps = static_cast<std::size_t>(rate * seconds);
    const auto begin = Clock::now();
    for (std::size_t k = 0; k < steps; ++k) {
      const auto due =
          begin + std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * double(k) / rate));
      hear(due, measures);
      for (; double(driven_) * testing::Swimming::kStepS < (double(k) + 1.0) / rate; ++driven_) {
        vehicle_.step();
      }
      send(measures);
    }
    hear(Clock::now() + kAfterwards, measures);
    driven_ = 0;
  }

  std::size_t sent() const { return sent_; }
  // Sorted.
  const std::vector<double>& times_ms(std::size_t topic) {
    std::ranges::sort(times_ms_[topic]);
    return times_ms_[topic];
  }

 private:
  void send(bool measures) {
    // Noise, so that no value stays.
    const double noise = 1e-4 * std::sin(1e3 * double(count_++));
    wrench_message_.set("wrench.force.x", vehicle_.force[0] + noise);
    wrench_message_.set("wrench.force.y", vehicle_.force[1] + noise);
    wrench_message_.set("wrench.torque.z", vehicle_.force[2] + noise);
    send(wrench_, wrench_message_, measures);
    odometry_message_.set("twist.twist.linear.x", vehicle_.velocity[0] + noise);
    odometry_message_.set("twist.twist.linear.y", vehicle_.velocity[1] + noise);
    odometry_message_.set("twist.twist.angular.z", vehicle_.velocity[2] + noise);
    send(odometry_, odometry_message_, measures);
  }
  void send(dds::Publication& publication, bag::MessageBuilder& message, bool measures) {
    const std::int64_t now = now_ns();
    const std::int64_t sec = now / 1'000'000'000;
    message.set("header.stamp.sec", double(sec));
    message.set("header.stamp.nanosec", double(now % 1'000'000'000));
    publication.publish(message.bytes());
    sent_ += measures ? 1 : 0;
  }
  void hear(Clock::time_point until, bool measures) {
    for (auto now = Clock::now(); now < until; now = Clock::now()) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - now);
      if (queue_.pop(message_, std::min(left, std::chrono::milliseconds(1))) && measures) {
        times_ms_[message_.topic].push_back(1e-6 *
                                            double(message_.receive_ns - stamp_of(message_.cdr)));
      }
    }
  }
  static bag::MessageBuilder builder(const char* type) {
    return bag::MessageBuilder(bag::MessageDefinitions().type(type));
  }

  dds::Participant participant_;
  dds::MessageQueue queue_;
  dds::Publication odometry_;
  dds::Publication wrench_;
  dds::Subscription predictions_;
  dds::Subscription velocities_;
  bag::MessageBuilder odometry_message_ = builder("nav_msgs/msg/Odometry");
  bag::MessageBuilder wrench_message_ = builder("geometry_msgs/msg/WrenchStamped");
  testing::Swimming vehicle_;
  std::int64_t driven_ = 0;
  std::int64_t count_ = 0;
  dds::TopicSample message_;
  std::size_t sent_ = 0;
  std::array<std::vector<double>, 2> times_ms_;
};

int measure(const std::string& program, double rate, double seconds) {
  const Kelpie kelpie(program);
  Vehicle vehicle;
  vehicle.drive(rate, kWarmUpS, false);
  const double before_s = kelpie.computed_s();
  vehicle.drive(rate, seconds, true);
  const double computed_s = kelpie.computed_s() - before_s;
  const int code = kelpie.stop();
  std::printf("%g Hz, %zu messages, %.1f %% of a core\n", rate, vehicle.sent(),
              100.0 * computed_s / (seconds + 0.5));
  for (const auto& [topic, name] :
       {std::pair{kPredictions, "predictions"}, std::pair{kVelocities, "velocities"}}) {
    const std::vector<double>& times = vehicle.times_ms(topic);
    if (times.empty() || code != 0) {
      std::printf("no %s came, or kelpie failed (%d)\n", name, code);
      return 1;
    }
    const auto at = [&](double part) {
      return times[static_cast<std::size_t>(part * double(times.size() - 1))];
    };
    std::printf("%zu %s: median %.3f ms, p99 %.3f, most %.3f\n", times.size(), name, at(0.5),
                at(0.99), times.back());
  }
  return 0;
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    std::puts("ros_latency KELPIE RATE SECONDS");
    return 2;
  }
  return measure(words[1], std::strtod(words[2], nullptr), std::strtod(words[3], nullptr));
}
