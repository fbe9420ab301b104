// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/svr/settings.hpp"

namespace kelpie {

/// The learner of an axis.
enum class LearnerKind : std::uint8_t {
  posterior,  ///< one Gaussian posterior of terms and kernels, beside the paper's learner
  svr,        ///< the paper's learner alone
};

/// Settings common to all axes of a model.
struct SharedSettings {
  LearnerKind learner = LearnerKind::posterior;
  ScalingKind scaling = ScalingKind::diagonal;
  std::string terms = "auto";   ///< physics terms of the kernel: TermSet::from
  std::string states = "auto";  ///< inputs with the targets as derivatives: find_states
  double coverage = 0.9;        ///< promised share of truths within prediction intervals
  int warmup = 50;              ///< first samples, which give the scaling of `svr` unless given

  void validate() const;  ///< Throws InputError naming the field.
};

std::span<const Setting<SharedSettings>> shared_fields();  ///< The table of all fields.

/// Settings of a model with one learner per axis. Config files, --set, printed defaults and the
/// documentation use this struct through the tables of fields.
struct ModelSettings {
  std::string preset = "default";  ///< origin of the default values
  SharedSettings shared;
  std::vector<OnlineSvrSettings> axes;  ///< one per target

  /// The values of a preset ("default", "small", "paper") for a number of axes. "paper" has values
  /// for surge, sway and yaw in this order, so at most three axes. Throws InputError on an unknown
  /// preset or too many axes.
  static ModelSettings from_preset(std::string_view preset, std::size_t axes);

  /// Sets one field by name: a value for all axes, or one per axis separated by commas.
  /// Throws InputError naming the field (with the nearest known name) or the fault of the value.
  /// "preset" is no field.
  void assign(std::string_view name, std::string_view text);

  /// All names and values in table order, as assign() reads them, beginning with the preset.
  std::vector<std::pair<std::string, std::string>> values() const;

  void validate() const;  ///< Throws InputError naming the field.

  /// Notes on active settings among `names` without effect on any axis: "setting k has no effect
  /// with forget = fifo". `scale_given`: the caller gives the scale.
  std::vector<std::string> notes(std::span<const std::string> names, bool scale_given) const;
};

/// The message for an unknown setting, with the nearest known name or the replacement.
std::string unknown_setting(std::string_view name);

/// Whether the setting existed in older files only.
bool removed_setting(std::string_view name);

/// A value as written today: `posterior` for the learner `committee` of older files.
std::string present_value(std::string_view name, std::string_view text);

std::span<const std::string_view> preset_names();  ///< "default", "small", "paper".

/// Name, meaning, allowed values and the value in each preset: for `kelpie config` and the docs.
struct SettingText {
  std::string name;
  std::string meaning;  ///< with the conditions that leave the setting without effect
  std::string allowed;
  std::string group;
  std::vector<std::string> presets;  ///< value in each of preset_names(), three axes
};
std::vector<SettingText> setting_docs();  ///< Of all settings, in the order of the tables.

/// Settings of one group.
struct SettingSection {
  std::string title;
  std::vector<SettingText> settings;
};
std::vector<SettingSection> setting_sections();  ///< By group, kEssential first.

}  // namespace kelpie
