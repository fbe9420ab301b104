// SPDX-License-Identifier: Apache-2.0
#include "live/plotjuggler.hpp"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include "core/seconds.hpp"
#include "file/json.hpp"
#include "kelpie/core/error.hpp"
#include "live/health_table.hpp"

namespace kelpie::live {
namespace {

using file::Json;

Json values_of(const std::vector<std::string>& names, std::span<const double> values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i) {
    json[names[i]] = file::number(values[i]);
  }
  return json;
}

// Curves have the names and units of the metrics.
template <typename Of>
void add_fields(Json& json, const Of& of) {
  for (const HealthField<Of>& field : health_fields<Of>()) {
    if (!field.metric.empty()) {
      const std::string_view series = field.names.series.second;
      const std::string end = series.empty() ? "" : "_" + std::string(series);
      json[std::string(field.metric) + end] = file::number(field.metric_value(of));
    }
  }
}

}  // namespace

PlotJuggler::PlotJuggler(const Endpoint& endpoint, std::vector<std::string> inputs,
                         std::vector<std::string> targets)
    : inputs_(std::move(inputs)), targets_(std::move(targets)) {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error =
      ::getaddrinfo(endpoint.host.c_str(), std::to_string(endpoint.port).c_str(), &wanted, &found);
  if (error != 0) {
    throw InputError("plotjuggler", endpoint.host + ": " + ::gai_strerror(error));
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  socket_ = ::socket(found->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0) {
    throw Failure("plotjuggler: " + std::generic_category().message(errno));
  }
  std::memcpy(&to_, found->ai_addr, found->ai_addrlen);
  to_bytes_ = found->ai_addrlen;
}

PlotJuggler::~PlotJuggler() {
  ::close(socket_);
}

void PlotJuggler::learned(const LearnedSample& sample) {
  Json json{{"timestamp", seconds(sample.stamp_ns)}};
  Json& learned = json["kelpie"]["learned"];
  learned["paused"] = sample.is_learned ? 0 : 1;
  learned["frozen"] = learned["paused"];  // its name until the next version
  learned["input"] = values_of(inputs_, sample.x);
  learned["measured"] = values_of(targets_, sample.y);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const Decision& decision = sample.decisions[i];
    if (decision.had_model) {
      learned["predicted"][targets_[i]] = file::number(decision.prediction.value);
      learned["lower"][targets_[i]] = file::number(decision.prediction.lower);
      learned["upper"][targets_[i]] = file::number(decision.prediction.upper);
      learned["disturbance"][targets_[i]] = file::number(decision.prediction.disturbance);
    }
  }
  send(json.dump());
}

void PlotJuggler::predicted(const PredictedSample& sample) {
  Json json{{"timestamp", seconds(sample.stamp_ns)}};
  Json& now = json["kelpie"]["now"];
  now["input"] = values_of(inputs_, sample.x);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const Prediction& prediction = sample.predictions[i];
    now["predicted"][targets_[i]] = file::number(prediction.value);
    now["lower"][targets_[i]] = file::number(prediction.lower);
    now["upper"][targets_[i]] = file::number(prediction.upper);
    now["disturbance"][targets_[i]] = file::number(prediction.disturbance);
    now["novelty"][targets_[i]] = file::number(prediction.novelty);
  }
  send(json.dump());
}

void PlotJuggler::reckoned(const ReckonedSample& sample) {
  const DeadReckoning& reckoning = sample.reckoning;
  Json json{{"timestamp", seconds(sample.stamp_ns)}};
  Json& velocity = json["kelpie"]["velocity"];
  velocity["silent_s"] = file::number(reckoning.silent_s());
  velocity["step"] = file::number(reckoning.step());
  for (std::size_t i = 0; i < sample.names.size(); ++i) {
    velocity["value"][sample.names[i]] = file::number(reckoning.velocity(i));
    velocity["deviation"][sample.names[i]] = file::number(reckoning.deviation(i));
    velocity["fault"][sample.names[i]] = fault_name(reckoning.fault(i));
  }
  velocity["current"]["x"] = file::number(reckoning.current()[0]);
  velocity["current"]["y"] = file::number(reckoning.current()[1]);
  send(json.dump());
}

void PlotJuggler::health(const Health& health) {
  Json json{{"timestamp", seconds(health.stamp_ns)}};
  add_fields(json["kelpie"]["health"], health);
  visit_health_lists(health, [&](const auto& list, std::string_view what) {
    for (const auto& of : list) {
      add_fields(json["kelpie"][std::string(what)][of.name], of);
    }
  });
  send(json.dump());
}

void PlotJuggler::send(const std::string& text) const {
  static_cast<void>(::sendto(socket_, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                             reinterpret_cast<const sockaddr*>(&to_),  // NOLINT: as sockets want it
                             to_bytes_));
}

}  // namespace kelpie::live
