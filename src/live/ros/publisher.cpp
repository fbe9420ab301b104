// SPDX-License-Identifier: Apache-2.0
#include "ros/publisher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>

#include "core/seconds.hpp"
#include "core/text.hpp"
#include "ros/axes.hpp"
#include "ros/diagnostics.hpp"
#include "ros/text_message.hpp"
#include "ros/tuning.hpp"

namespace kelpie::ros {
namespace {

constexpr const char* kArray = "std_msgs/msg/Float64MultiArray";
constexpr std::array<const char*, 6> kElements{"linear.x",  "linear.y",  "linear.z",
                                               "angular.x", "angular.y", "angular.z"};
constexpr double kUnknown = -1.0;  // a variance, as in sensor_msgs/Imu

void set_stamp(bag::MessageBuilder& message, std::int64_t stamp_ns) {
  // The stamp of a wrongly set clock may not fit.
  const std::int64_t sec = std::clamp<std::int64_t>(stamp_ns / kSecondNs, 0, INT32_MAX);
  message.set("header.stamp.sec", static_cast<double>(sec));
  message.set("header.stamp.nanosec",
              static_cast<double>(std::max<std::int64_t>(stamp_ns % kSecondNs, 0)));
}

// Half width, in standard deviations, of the interval with this share of a normal distribution.
double half_width(double share) {
  double low = 0.0;
  double high = 10.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erf(middle / std::sqrt(2.0)) < share ? low : high) = middle;
  }
  return high;
}

double variance_of(const Prediction& prediction, double widths_per_sigma) {
  const double sigma = 0.5 * (prediction.upper - prediction.lower) / widths_per_sigma;
  return std::isfinite(sigma) ? sigma * sigma : kUnknown;
}

// A table of numbers, row by row, with labels of rows and columns.
void set_table(bag::MessageBuilder& message, std::span<const std::string> rows,
               std::span<const std::string> columns, std::span<const double> values) {
  message.resize("layout.dim", 2);
  message.set("layout.dim[0].label", join_text(rows, ";"));
  message.set("layout.dim[0].size", static_cast<double>(rows.size()));
  message.set("layout.dim[0].stride", static_cast<double>(values.size()));
  message.set("layout.dim[1].label", join_text(columns, ";"));
  message.set("layout.dim[1].size", static_cast<double>(columns.size()));
  message.set("layout.dim[1].stride", static_cast<double>(columns.size()));
  message.set("data", values);
}

}  // namespace

TopicWriter::TopicWriter(const dds::Participant& participant, const NodeSettings& settings,
                         const std::string& topic, const std::string& type)
    : message(bag::MessageDefinitions().type(type)),
      publication(participant, settings.names.full_name(topic), type, settings.published) {}

Publisher::Publisher(const dds::Participant& participant, const NodeSettings& settings,
                     const live::Configuration& configuration)
    : configuration_(configuration),
      node_(settings.node),
      accelerations_(acceleration_axes(configuration)),
      widths_per_sigma_(half_width(configuration.settings.shared.coverage)),
      prediction_(participant, settings, "~/prediction",
                  "geometry_msgs/msg/AccelWithCovarianceStamped"),
      velocity_(participant, settings, "~/velocity",
                "geometry_msgs/msg/TwistWithCovarianceStamped"),
      axes_(participant, settings, "~/axes", kArray),
      coefficients_(participant, settings, "~/coefficients", kArray),
      authority_(participant, settings, "~/authority", kArray),
      allocation_(participant, settings, "~/allocation", kArray),
      diagnostics_(participant, settings, "/diagnostics", "diagnostic_msgs/msg/DiagnosticArray"),
      events_(participant, settings, "~/events", kTextType) {
  prediction_.message.set("header.frame_id", settings.frame);
  velocity_.message.set("header.frame_id", settings.frame);
}

void Publisher::predicted(const live::PredictedSample& sample) {
  publish_acceleration(sample);
  publish_axes(sample.predictions);
}

void Publisher::publish_acceleration(const live::PredictedSample& sample) {
  constexpr std::size_t kAxes = kElements.size();
  std::array<double, kAxes * kAxes> covariance{};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    covariance[axis * (kAxes + 1)] = kUnknown;
  }
  bag::MessageBuilder& message = prediction_.message;
  for (std::size_t i = 0; i < accelerations_.size(); ++i) {
    const Prediction& prediction = sample.predictions[i];
    const std::optional<std::size_t>& axis = accelerations_[i];
    if (axis && std::isfinite(prediction.value)) {
      message.set(fmt::format("accel.accel.{}", kElements[*axis]), prediction.value);
      covariance[*axis * (kAxes + 1)] = variance_of(prediction, widths_per_sigma_);
    }
  }
  set_stamp(message, sample.data_ns);
  message.set("accel.covariance", covariance);
  prediction_.send();
}

void Publisher::publish_axes(std::span<const Prediction> predictions) {
  static const std::vector<std::string> kRows{"predicted", "lower", "upper", "novelty",
                                              "disturbance"};
  values_.clear();
  for (const auto member : {&Prediction::value, &Prediction::lower, &Prediction::upper,
                            &Prediction::novelty, &Prediction::disturbance}) {
    for (const Prediction& prediction : predictions) {
      values_.push_back(prediction.*member);
    }
  }
  set_table(axes_.message, kRows, configuration_.plan.targets, values_);
  axes_.send();
}

// Velocities are in the order of the targets, their accelerations.
void Publisher::reckoned(const live::ReckonedSample& sample) {
  constexpr std::size_t kAxes = kElements.size();
  const DeadReckoning& reckoning = sample.reckoning;
  std::array<double, kAxes * kAxes> covariance{};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    covariance[axis * (kAxes + 1)] = kUnknown;
  }
  bag::MessageBuilder& message = velocity_.message;
  for (std::size_t i = 0; i < reckoning.states(); ++i) {
    const std::optional<std::size_t>& row = accelerations_[i];
    if (!row) {
      continue;
    }
    message.set(fmt::format("twist.twist.{}", kElements[*row]), reckoning.velocity(i));
    for (std::size_t k = 0; k < reckoning.states(); ++k) {
      if (const std::optional<std::size_t>& column = accelerations_[k]) {
        covariance[*row * kAxes + *column] = reckoning.covariance(i, k);
      }
    }
  }
  set_stamp(message, sample.data_ns);
  message.set("twist.covariance", covariance);
  velocity_.send();
}

void Publisher::health(const live::Health& health) {
  effectiveness_ = health.learner.effectiveness;
  if (effectiveness_) {
    publish_authority(*effectiveness_);
  }
  publish_coefficients(health);
  publish_diagnostics(health);
  before_ = health;
}

void Publisher::publish_coefficients(const live::Health& health) {
  static const std::vector<std::string> kColumns{"value", "standard error"};
  std::vector<std::string> names;
  values_.clear();
  for (const live::AxisHealth& axis : health.learner.axes) {
    for (const Coefficient& coefficient : axis.coefficients) {
      if (names.size() < kTuning.most_coefficients) {
        names.push_back(axis.name + ":" + coefficient.term);
        values_.insert(values_.end(), {coefficient.value, coefficient.error});
      }
    }
  }
  if (!names.empty()) {
    set_table(coefficients_.message, names, kColumns, values_);
    coefficients_.send();
  }
}

// A row per thruster: its share, then per axis full ahead and full astern with half widths.
void Publisher::publish_authority(const live::Effectiveness& effectiveness) {
  std::vector<std::string> rows;
  std::vector<std::string> columns{"share"};
  for (const std::string& target : configuration_.plan.targets) {
    for (const char* const what : {" ahead", " ahead ±", " astern", " astern ±"}) {
      columns.push_back(target + what);
    }
  }
  values_.clear();
  for (const ThrusterEffect& one : effectiveness.authority.thrusters()) {
    rows.push_back(configuration_.plan.inputs[one.range.input]);
    values_.push_back(one.share);
    for (std::size_t i = 0; i < one.ahead.size(); ++i) {
      values_.insert(values_.end(),
                     {one.ahead[i], one.ahead_width[i], one.astern[i], one.astern_width[i]});
    }
  }
  set_table(authority_.message, rows, columns, values_);
  authority_.send();
}

// The effect of a thruster is turned back into its command: dead band, gain astern, neutral point.
std::string Publisher::allocate(std::span<const double> wanted) {
  if (!effectiveness_) {
    return "what the thrusters do isn't known yet";
  }
  std::vector<double> of_targets;
  for (const std::optional<std::size_t>& axis : accelerations_) {
    of_targets.push_back(axis && std::isfinite(wanted[*axis]) ? wanted[*axis] : 0.0);
  }
  const Allocation allocation = effectiveness_->authority.allocate(of_targets);
  std::vector<std::string> names;
  values_.clear();
  for (std::size_t k = 0; k < allocation.commands.size(); ++k) {
    names.push_back(
        configuration_.plan.inputs[effectiveness_->authority.thrusters()[k].range.input]);
    values_.push_back(effectiveness_->alignment.command_for(names.back(), allocation.commands[k]));
  }
  set_table(allocation_.message, std::vector<std::string>{"command"}, names, values_);
  allocation_.send();
  return {};
}

void Publisher::publish_diagnostics(const live::Health& health) {
  bag::MessageBuilder& message = diagnostics_.message;
  const std::vector<DiagnosticStatus> found = diagnose(health, before_);
  set_stamp(message, std::chrono::duration_cast<std::chrono::nanoseconds>(
                         std::chrono::system_clock::now().time_since_epoch())
                         .count());
  message.resize("status", found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::string path = fmt::format("status[{}].", i);
    message.set(path + "level", static_cast<double>(found[i].level));
    message.set(path + "name", node_ + ": " + found[i].name);
    message.set(path + "message", found[i].message);
    message.set(path + "hardware_id", node_);
    message.resize(path + "values", found[i].values.size());
    for (std::size_t k = 0; k < found[i].values.size(); ++k) {
      const std::string pair = fmt::format("{}values[{}].", path, k);
      message.set(pair + "key", found[i].values[k].first);
      message.set(pair + "value", found[i].values[k].second);
    }
  }
  diagnostics_.send();
}

void Publisher::event(const std::string& line) {
  events_.message.set("data", line);
  events_.send();
}

std::vector<std::string> Publisher::mismatches() const {
  std::vector<std::string> all;
  for (const TopicWriter* const topic : {&prediction_, &velocity_, &authority_, &allocation_,
                                         &axes_, &coefficients_, &diagnostics_, &events_}) {
    std::ranges::move(topic->publication.mismatches(), std::back_inserter(all));
  }
  return all;
}

}  // namespace kelpie::ros
