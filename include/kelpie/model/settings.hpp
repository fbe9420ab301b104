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
#include "kelpie/online/settings.hpp"

namespace kelpie {

/// Who learns an axis.
enum class LearnerKind : std::uint8_t {
  committee,  ///< several learners, each believed as it deserves (Committee)
  svr,        ///< the paper's learner alone
};

/// What holds for all axes of a model alike.
struct SharedSettings {
  LearnerKind learner = LearnerKind::committee;
  ScalingKind scaling = ScalingKind::diagonal;
  std::string terms = "auto";   ///< physics terms of the kernel: TermSet::from
  std::string states = "auto";  ///< inputs whose derivatives the targets are: find_states
  double track = 2.0;           ///< growth at which the scale is taken anew, a ratio; 0: none
  double coverage = 0.9;        ///< share of truths that prediction intervals are to hold
  int warmup = 50;              ///< samples from which the scaling is taken, where it isn't given

  void validate() const;  ///< Throws InputError naming the field.
};

std::span<const Setting<SharedSettings>> shared_fields();  ///< The table of all fields.

/// Settings of a model: one learner per axis. This is the one struct that config files, --set, the
/// printed defaults and the documentation speak of, all through the tables of fields.
struct ModelSettings {
  std::string preset = "default";  ///< where the values started from
  SharedSettings shared;
  std::vector<OnlineSvrSettings> axes;  ///< one per target

  /// The values of a preset ("default", "small", "paper") for a number of axes. The paper's differ
  /// for surge, sway and yaw, which are taken to come in this order: it has no more than three.
  /// Throws InputError on an unknown preset or too many axes.
  static ModelSettings from_preset(std::string_view preset, std::size_t axes);

  /// Sets one field by name: a value for all axes, or one per axis separated by commas.
  /// Throws InputError naming the field (and the nearest known) or what is wrong with the value.
  /// "preset" isn't a field: it says where to start.
  void assign(std::string_view name, std::string_view text);

  /// All names and values in table order, as assign() reads them, beginning with the preset.
  std::vector<std::pair<std::string, std::string>> values() const;

  void validate() const;  ///< Throws InputError naming the field.

  /// Says of the settings `names` which are on and yet have no effect on any axis: "setting k has
  /// no effect with forget = fifo". `scale_given`: the model gets its scale from outside.
  std::vector<std::string> notes(std::span<const std::string> names, bool scale_given) const;
};

/// Why there is no setting of this name, and what to write instead.
std::string unknown_setting(std::string_view name);

/// Whether older files have a setting of this name, which no longer exists.
bool removed_setting(std::string_view name);

std::span<const std::string_view> preset_names();  ///< "default", "small", "paper".

/// Name, meaning, what is allowed and the value in each preset: for `kelpie config` and the docs.
struct SettingDoc {
  std::string name;
  std::string meaning;  ///< with what leaves the setting without effect
  std::string allowed;
  std::string group;
  std::vector<std::string> presets;  ///< value in each of preset_names(), three axes
};
std::vector<SettingDoc> setting_docs();  ///< Of all settings, in the order of the tables.

/// Settings that are shown together.
struct SettingSection {
  std::string title;
  std::vector<SettingDoc> settings;
};
std::vector<SettingSection> setting_sections();  ///< By group, kEssential first.

}  // namespace kelpie
