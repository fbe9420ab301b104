// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/settings.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>

#include "core/text.hpp"

namespace kelpie {
namespace {

constexpr std::array<std::string_view, 2> kLearners{"posterior", "svr"};
constexpr std::array<std::string_view, 2> kScalings{"full", "diagonal"};
constexpr std::array<std::string_view, 3> kPresets{"default", "small", "paper"};
constexpr std::size_t kPlaneAxes = 3;  // surge, sway, yaw

constexpr std::string_view kScale = "Scale";
constexpr std::string_view kGivenScale = "a given scale";  // no setting: the caller gives it
constexpr IdleCondition kWithGivenScale{.with = kGivenScale};

constexpr std::array kSharedFields = std::to_array<Setting<SharedSettings>>({
    {"learner",
     "who learns an axis: posterior (one Bayesian regression of terms and kernels, beside the "
     "paper's learner: docs/method/posterior.md), svr (the paper's learner alone)",
     choice_of<&SharedSettings::learner, SharedSettings>(kLearners),
     {},
     kEssential},
    {"scaling",
     "Σ of eq. (6): the inputs' full covariance, or its diagonal",
     choice_of<&SharedSettings::scaling, SharedSettings>(kScalings),
     {},
     kScale,
     {.with = "learner", .values = "posterior"}},
    {"warmup",
     "how many first samples the scale of learner = svr is taken from, Σ and the target's",
     &SharedSettings::warmup,
     {.low = 2.0, .high = 1e6},
     kScale,
     kWithGivenScale},
    {"terms",
     "φ of the posterior and of the kernel κ_SE + fine κ_SE^32 + λ φᵀφ': a set by name, or "
     "formulas over the columns (docs/method/physics.md)",
     Setting<SharedSettings>::Text{&SharedSettings::terms,
                                   "auto, auto:degrees, none, linear, quadratic, fossen, "
                                   "manoeuvring, 6dof, or formulas separated by ;"},
     {},
     kEssential},
    {"states",
     "which inputs are the velocities that the targets accelerate, in their order: for rollouts",
     Setting<SharedSettings>::Text{
         &SharedSettings::states,
         "auto (by name: u, surge, Vx, twist.linear.x, …), none, or columns separated by commas"},
     {},
     kEssential},
    {"coverage",
     "share of samples that the interval around a prediction holds (docs/method/uncertainty.md)",
     &SharedSettings::coverage,
     {.low = 0.5, .high = 0.99},
     kEssential},
});

// Settings of older files, and what to write instead.
constexpr std::array kRemoved = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"s",
     "the weight of κ_SE is always 1 now; leave out s = 1; for any other s write fine/s, lambda/s "
     "and c·s instead of fine, lambda and c (for s = 0 take a small s, such as 0.001)"},
    {"track", "the scale of learner = svr stays as found in the first samples; leave track out"},
});

// Values of older files, and those that took their place in version 2.0.0 (CHANGELOG.md).
struct RemovedValue {
  std::string_view setting;
  std::string_view value;
  std::string_view instead;
};
constexpr std::array kRemovedValues = std::to_array<RemovedValue>({
    {"learner", "committee", "posterior"},
    {"adapt", "challenger", "follow"},
});

ModelSettings default_preset(std::size_t axes) {
  ModelSettings settings;
  settings.axes.assign(axes, OnlineSvrSettings{});
  return settings;
}

// A buffer that fits a microcomputer.
ModelSettings small_preset(std::size_t axes) {
  ModelSettings settings;
  settings.preset = "small";
  settings.axes.assign(axes, OnlineSvrSettings{.buffer = 200, .memory = 2, .anchors = 50});
  return settings;
}

// Table I of the paper. Its γ can't be meant as eq. (6) has it: read as a reciprocal it works, see
// docs/method/learner.md.
ModelSettings paper_preset(std::size_t axes) {
  constexpr std::array<double, kPlaneAxes> kEpsilon{0.1, 0.001, 0.1};
  constexpr std::array<double, kPlaneAxes> kGamma{1.0 / 100.0, 1.0 / 40.0, 1.0 / 20.0};
  constexpr std::array<double, kPlaneAxes> kK{10.0, 10.0, 1.0};
  if (axes > kPlaneAxes) {
    throw InputError("preset", "'paper' has values for surge, sway and yaw; there are " +
                                   std::to_string(axes) + " targets");
  }
  ModelSettings settings;
  settings.preset = "paper";
  settings.shared.learner = LearnerKind::svr;
  settings.shared.warmup = 200;
  settings.shared.scaling = ScalingKind::full;
  settings.shared.terms = "none";
  for (std::size_t axis = 0; axis < axes; ++axis) {
    OnlineSvrSettings& one = settings.axes.emplace_back();
    one.storage = Storage::float64;
    one.buffer = 900;
    one.fine = 0.0;
    one.lambda = 0.0;
    one.epsilon = kEpsilon[axis];
    one.c = 10.0;
    one.gamma = kGamma[axis];
    one.k = kK[axis];
    one.a = 0.99;
    one.b = 0.01;
    one.xi = 0.99;
    one.outlier = OutlierRule::iqr;
    one.forget = ForgetRule::paper;
    one.memory = 0;
    one.adapt = AdaptRule::none;
    one.anchors = 50;
  }
  return settings;
}

template <typename T>
const Setting<T>* find(std::span<const Setting<T>> fields, std::string_view name) {
  const auto found = std::ranges::find(fields, name, &Setting<T>::name);
  return found == fields.end() ? nullptr : &*found;
}

// Calls `use` with every field of both tables.
template <typename Use>
void for_each_field(Use use) {
  std::ranges::for_each(shared_fields(), use);
  std::ranges::for_each(online_svr_fields(), use);
}

std::vector<std::string> all_names() {
  std::vector<std::string> names{"preset"};
  for_each_field([&names](const auto& field) { names.emplace_back(field.name); });
  return names;
}

void assign_axes(std::vector<OnlineSvrSettings>& axes, const Setting<OnlineSvrSettings>& field,
                 std::string_view text) {
  const std::vector<std::string> values = split_text(text, ',');
  if (values.size() != 1 && values.size() != axes.size()) {
    throw InputError(field.name, std::to_string(values.size()) + " values for " +
                                     std::to_string(axes.size()) +
                                     " targets; give one, or one per target");
  }
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    field.assign(axes[axis], values[values.size() == 1 ? 0 : axis]);
  }
}

std::string axes_text(const std::vector<OnlineSvrSettings>& axes,
                      const Setting<OnlineSvrSettings>& field) {
  std::vector<std::string> values;
  values.reserve(axes.size());
  for (const OnlineSvrSettings& axis : axes) {
    values.push_back(field.get(axis));
  }
  const bool same = std::ranges::all_of(values, [&](auto& v) { return v == values.front(); });
  return same && !values.empty() ? values.front() : join_text(values, ",");
}

}  // namespace

std::span<const Setting<SharedSettings>> shared_fields() {
  return kSharedFields;
}

bool removed_setting(std::string_view name) {
  return std::ranges::any_of(kRemoved, [name](const auto& old) { return old.first == name; });
}

std::string present_value(std::string_view name, std::string_view text) {
  for (const auto& [setting, value, instead] : kRemovedValues) {
    if (setting == name) {
      std::vector<std::string> values = split_text(text, ',');  // one per axis
      std::ranges::replace(values, std::string(value), std::string(instead));
      return join_text(values, ",");
    }
  }
  return std::string(text);
}

std::string unknown_setting(std::string_view name) {
  for (const auto& [removed, instead] : kRemoved) {
    if (removed == name) {
      return "this setting was removed: " + std::string(instead);
    }
  }
  const std::vector<std::string> names = all_names();
  return "unknown setting" + did_you_mean(name, names) + "; the settings are " +
         join_text(names, ", ");
}

std::span<const std::string_view> preset_names() {
  return kPresets;
}

void SharedSettings::validate() const {
  for (const Setting<SharedSettings>& field : kSharedFields) {
    field.check(*this);
  }
}

ModelSettings ModelSettings::from_preset(std::string_view preset, std::size_t axes) {
  constexpr std::array kMakers{&default_preset, &small_preset, &paper_preset};
  return kMakers.at(static_cast<std::size_t>(choice_setting("preset", preset, kPresets)))(axes);
}

void ModelSettings::assign(std::string_view name, std::string_view text) {
  for (const auto& [setting, value, instead] : kRemovedValues) {
    require(setting != name || value != trimmed(text), name,
            "'" + std::string(value) + "' was removed in version 2.0.0 (CHANGELOG.md); write " +
                std::string(instead));
  }
  if (const auto* const field = find(shared_fields(), name)) {
    field->assign(shared, text);
  } else if (const auto* const axis_field = find(online_svr_fields(), name)) {
    assign_axes(axes, *axis_field, text);
  } else {
    throw InputError(name, unknown_setting(name));
  }
}

std::vector<std::pair<std::string, std::string>> ModelSettings::values() const {
  std::vector<std::pair<std::string, std::string>> list{{"preset", preset}};
  for (const auto& field : shared_fields()) {
    list.emplace_back(field.name, field.get(shared));
  }
  for (const auto& field : online_svr_fields()) {
    list.emplace_back(field.name, axes_text(axes, field));
  }
  return list;
}

void ModelSettings::validate() const {
  shared.validate();
  for (const OnlineSvrSettings& axis : axes) {
    axis.validate();
  }
}

std::vector<std::string> ModelSettings::notes(std::span<const std::string> names,
                                              bool scale_given) const {
  const auto list = values();
  const std::map<std::string, std::string, std::less<>> value_of(list.begin(), list.end());
  const auto no_effect = [&](const IdleCondition& idle) {
    if (idle.with == kGivenScale) {
      return scale_given;
    }
    const std::vector<std::string> useless = split_text(idle.values, ',');
    return std::ranges::all_of(split_text(value_of.find(idle.with)->second, ','),
                               [&](auto& value) { return std::ranges::count(useless, value) > 0; });
  };
  std::vector<std::string> notes;
  for_each_field([&](const auto& field) {
    const IdleCondition& idle = field.idle;
    const bool asked = std::ranges::count(names, field.name) > 0;
    if (asked && idle.with == kGivenScale && shared.learner == LearnerKind::posterior) {
      notes.push_back("setting " + std::string(field.name) +
                      " has no effect with learner = posterior");
      return;
    }
    const std::string& value = value_of.find(field.name)->second;
    if (asked && value != "0" && value != "none" && !idle.with.empty() && no_effect(idle)) {
      const auto other = value_of.find(idle.with);
      notes.push_back("setting " + std::string(field.name) + " has no effect " +
                      idle.text(other == value_of.end() ? "" : other->second));
    }
  });
  return notes;
}

std::vector<SettingText> setting_docs() {
  std::vector<SettingText> docs{{"preset",
                                 "where the other values start from",
                                 "default, small, paper",
                                 std::string(kEssential),
                                 {}}};
  for_each_field([&docs](const auto& field) {
    const IdleCondition& idle = field.idle;
    std::string meaning(field.meaning);
    if (!idle.with.empty()) {
      meaning += "; no effect " + idle.text(join_text(split_text(idle.values, ','), " or "));
    }
    docs.push_back(
        {std::string(field.name), meaning, field.allowed(), std::string(field.group), {}});
  });
  for (const std::string_view preset : kPresets) {
    const auto values = ModelSettings::from_preset(preset, kPlaneAxes).values();
    for (std::size_t i = 0; i < docs.size(); ++i) {
      docs[i].presets.push_back(values[i].second);
    }
  }
  return docs;
}

std::vector<SettingSection> setting_sections() {
  std::vector<SettingSection> sections;
  for (const SettingText& doc : setting_docs()) {
    auto section = std::ranges::find(sections, doc.group, &SettingSection::title);
    if (section == sections.end()) {
      section = sections.insert(section, SettingSection{doc.group, {}});
    }
    section->settings.push_back(doc);
  }
  return sections;
}

}  // namespace kelpie
