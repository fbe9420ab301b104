// SPDX-License-Identifier: Apache-2.0
#include "log/candidates.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/text.hpp"
#include "log/tuning.hpp"

namespace kelpie::log {
namespace {

constexpr std::size_t kShownNames = 16;

// A name taken apart.
struct NamedCommand {
  CommandWords::Kind kind = CommandWords::Kind::thrust;
  int rank = 0;
  std::string_view why;
  std::string stem;  // the words that make it a command's
  std::string tail;  // which one it is
};

void add_word(std::string& text, const std::string& word) {
  text += word.empty() ? "" : " " + word;
}

std::optional<NamedCommand> command_by_name(const CandidateColumn& column) {
  std::vector<std::string> words = words_of(column.name);
  if (!words.empty() && !column.topic.empty() &&
      (words.back() == "data" || words.back() == "value")) {
    words.pop_back();
  }
  const std::string whole = join_text(words, "_");
  if (!why_no_command(column.name).empty()) {
    return std::nullopt;
  }
  NamedCommand command;
  bool is_one = false;
  const auto meet = [&](const CommandWords& known) {
    command.kind = command.rank == 0 ? known.kind : std::max(command.kind, known.kind);
    command.rank = std::max(command.rank, known.rank);
    command.why = known.why;
    is_one = true;
  };
  for (const std::string& word : words) {
    const auto known = std::ranges::find_if(known_command_words(), [&](const CommandWords& one) {
      return is_among_words(one.words, word);
    });
    if (known != known_command_words().end()) {
      const std::size_t letters = word.find_last_not_of("0123456789") + 1;
      meet(*known);
      add_word(command.stem, word.substr(0, letters));
      add_word(command.tail, word.substr(letters));
    } else {
      const bool is_field =
          std::ranges::find(known_command_fields(), word) != known_command_fields().end();
      add_word(is_field ? command.stem : command.tail, word);
    }
  }
  for (const CommandWords& known : known_command_words()) {
    if (words.size() > 1 && is_among_words(known.words, whole)) {
      meet(known);
      command.tail = whole;
    }
  }
  if (words.size() > 1 && words.front() == "c" && !pose_part_by_name(column.name)) {
    meet({.words = "c",
          .kind = CommandWords::Kind::thrust,
          .rank = 1,
          .why = "c_ of a glider: commanded"});
  }
  return is_one ? std::optional(command) : std::nullopt;
}

struct CommandGroup {
  std::vector<CandidateColumn> columns;
  std::set<std::string> tails;
  CommandWords::Kind kind = CommandWords::Kind::thrust;
  int rank = 0;
  std::string why;
};

std::string names_text(const std::vector<CandidateColumn>& columns) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < columns.size() && k < kShownNames; ++k) {
    names.push_back(columns[k].name);
  }
  const std::size_t more = columns.size() - names.size();
  return join_text(names, ", ") + (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

// Fields of a topic that may be commands by name: all columns of a table; of a topic of unknown
// type the likeliest field (known_command_fields), or else the fields named as commands; of
// sequences all elements.
std::vector<std::string> command_paths(const bag::TopicReport& topic) {
  std::vector<std::string> paths;
  const auto add = [&](const bag::FieldRange& field) {
    for (std::size_t k = 0; k < field.elements.size() && field.path.ends_with("[]"); ++k) {
      paths.push_back(field.path.substr(0, field.path.size() - 1) + std::to_string(k) + "]");
    }
    if (field.elements.empty()) {
      paths.push_back(field.path);
    }
  };
  const bool is_table = topic.name.empty() || topic.type.starts_with("matlab/");
  for (const std::string_view wanted : known_command_fields()) {
    for (const bag::FieldRange& field : topic.fields) {
      const std::string last = field.path.substr(field.path.rfind('.') + 1);
      if (!is_table && (last == wanted || last == std::string(wanted) + "[]")) {
        add(field);
      }
    }
    if (!paths.empty()) {
      return paths;
    }
  }
  for (const bag::FieldRange& field : topic.fields) {
    if (is_table || command_by_name({.name = field.path, .topic = topic.name})) {
      add(field);
    }
  }
  return paths;
}

// Columns that are commands by name. Names of one kind that differ only in the word of the kind
// (pwm1, pwm2 and rpm1, rpm2) are two readings, hence two candidates; all others form one.
std::vector<Candidate> named_commands(const std::vector<CandidateColumn>& columns) {
  std::map<std::pair<CommandWords::Kind, std::string>, CommandGroup> groups;
  for (const CandidateColumn& column : columns) {
    if (velocity_by_name(column.name)) {
      continue;
    }
    if (const std::optional<NamedCommand> named = command_by_name(column)) {
      CommandGroup& group = groups[{named->kind, named->stem}];
      group.columns.push_back(column);
      group.tails.insert(named->tail);
      group.kind = named->kind;
      group.rank = std::max(group.rank, named->rank);
      group.why = named->why.empty() ? "by its name" : std::string(named->why);
    }
  }
  std::vector<Candidate> found;
  std::vector<CommandGroup> taken;  // the first reading
  for (auto& [key, group] : groups) {
    const bool is_rival = std::ranges::any_of(taken, [&](const CommandGroup& one) {
      return one.kind == group.kind && one.tails == group.tails && one.rank == group.rank;
    });
    taken.push_back(group);
    auto home = std::ranges::find(found, group.rank + 1, &Candidate::rank);
    if (is_rival || home == found.end()) {
      home = found.insert(found.end(), {.part = Part::commands,
                                        .what = {},
                                        .columns = {},
                                        .rank = group.rank + 1,
                                        .why = group.why});
    }
    home->columns.insert(home->columns.end(), group.columns.begin(), group.columns.end());
    home->what = names_text(home->columns);
  }
  return found;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

CandidateColumn seen_column(const bag::TopicReport& topic, const std::string& path,
                            const std::string& unit, const bag::FieldRange::Element& seen) {
  if (seen.finite == 0) {
    return {};
  }
  return {.name = topic.name.empty() ? path : topic.name + ":" + path,
          .topic = topic.name,
          .unit = unit,
          .low = seen.low,
          .high = seen.high,
          .rate_hz = topic.rate_hz * static_cast<double>(seen.finite) /
                     static_cast<double>(std::max<std::size_t>(topic.messages, 1)),
          .stamps = topic.clock_offset};
}

// The path is of a field, or of an element.
CandidateColumn column_at(const bag::TopicReport& topic, const std::string& path) {
  const std::size_t bracket = path.find('[');
  const bool is_element = bracket != std::string::npos && path.find(']') != bracket + 1;
  const std::string pattern =
      is_element ? path.substr(0, bracket) + "[]" + path.substr(path.find(']') + 1) : path;
  auto field = std::ranges::find(topic.fields, path, &bag::FieldRange::path);
  if (field != topic.fields.end()) {
    return column_of(topic, *field);
  }
  field = std::ranges::find(topic.fields, pattern, &bag::FieldRange::path);
  const std::size_t element = is_element ? std::stoul(path.substr(bracket + 1)) : 0;
  return is_element && field != topic.fields.end() && element < field->elements.size()
             ? seen_column(topic, path, field->unit, field->elements[element])
             : CandidateColumn{};
}

// Of a quotient of two fields, "way[0]/time".
CandidateColumn quotient_of(const bag::TopicReport& topic, const std::string& path) {
  const std::size_t slash = path.find('/');
  CandidateColumn column = column_at(topic, path.substr(0, slash));
  const CandidateColumn over = column_at(topic, path.substr(slash + 1));
  if (!column.exists() || !over.exists() || over.low <= 0.0) {
    return {};
  }
  column.name += path.substr(slash);
  column.unit += over.unit.empty() ? "" : "/" + over.unit;
  column.low = std::min(column.low / over.low, column.low / over.high);
  column.high = std::max(column.high / over.low, column.high / over.high);
  return column;
}

bool fits(const KnownMessage& known, const bag::TopicReport& topic) {
  return known.type == short_type(topic.type) &&
         lower(topic.name).find(known.topic) != std::string::npos;
}

// Several estimators, receivers or outputs of one kind: the first is the one in use.
std::string without_instance(const std::string& topic) {
  const std::size_t bracket = topic.ends_with(']') ? topic.rfind('[') : std::string::npos;
  return bracket == std::string::npos ? topic : topic.substr(0, bracket);
}

class Finder {
 public:
  explicit Finder(const bag::BagReport& report) {
    for (const bag::TopicReport& topic : report.topics) {
      if (can_be_written(topic.name) && can_be_written(topic.type)) {
        topics_.push_back(&topic);
        has_autopilot_ = has_autopilot_ ||
                         (topic.type.find('/') == std::string::npos && find_known(topic, nullptr));
      }
    }
  }

  std::vector<Candidate> run() {
    std::vector<const bag::TopicReport*> others;
    for (const bag::TopicReport* const topic : topics_) {
      const bool is_known = find_known(*topic, &found_);
      if (!is_known && (!has_autopilot_ || topic->type.find('/') != std::string::npos)) {
        others.push_back(topic);
      }
    }
    find_named_velocities(others);
    std::vector<CandidateColumn> columns;
    for (const bag::TopicReport* const topic : others) {
      add_command_columns(*topic, columns);
    }
    std::ranges::move(named_commands(columns), std::back_inserter(found_));
    std::ranges::stable_sort(found_, {}, &Candidate::rank);
    return std::move(found_);
  }

 private:
  // A companion computer sends what its DVL or camera measures: this measurement is the vehicle's.
  static bool is_of_other_system(const bag::TopicReport& topic) {
    return topic.name.starts_with("/mavlink/") && topic.type != "VISION_POSITION_DELTA";
  }

  static bool find_known(const bag::TopicReport& topic, std::vector<Candidate>* found) {
    std::set<Part> parts;
    for (const KnownMessage& known : known_messages()) {
      // A topic of commands is no measurement, whatever its type.
      if (!fits(known, topic) || parts.contains(known.part) || parts.contains(Part::commands)) {
        continue;
      }
      Candidate one{
          .part = known.part,
          .what = topic.name + (topic.type == topic.name ? "" : " (" + topic.type + ")"),
          .columns = {},
          .frame = std::string(known.frame),
          .rank = known.rank + (is_of_other_system(topic) ? kTuning.rank_other_system : 0),
          .why = std::string(known.why)};
      bool is_whole = true;
      for (const std::string& path : expanded(known.fields)) {
        CandidateColumn column =
            path.find('/') == std::string::npos ? column_at(topic, path) : quotient_of(topic, path);
        is_whole = is_whole && column.exists();
        if (known.part != Part::commands || column.exists()) {
          one.columns.push_back(std::move(column));
        }
      }
      if (known.part == Part::commands ? one.columns.empty() : !is_whole) {
        continue;
      }
      parts.insert(known.part);
      if (found != nullptr && !has_first_instance(*found, topic.name, known.part)) {
        found->push_back(std::move(one));
      }
    }
    return !parts.empty();
  }

  static bool has_first_instance(const std::vector<Candidate>& found, const std::string& topic,
                                 Part part) {
    return topic.ends_with(']') && std::ranges::any_of(found, [&](const Candidate& other) {
             return other.part == part &&
                    without_instance(other.columns.front().topic) == without_instance(topic);
           });
  }

  // A topic of one number is called by its own name, others by their fields'.
  static std::string name_in(const bag::TopicReport& topic, const bag::FieldRange& field) {
    const bool is_single =
        field.path == "data" || field.path == "value" || field.path == "double_val";
    return is_single ? topic.name.substr(topic.name.rfind('/') + 1) : field.path;
  }

  void find_named_velocities(const std::vector<const bag::TopicReport*>& topics) {
    std::vector<std::pair<std::string, std::pair<std::size_t, CandidateColumn>>> named;
    for (const bag::TopicReport* const topic : topics) {
      for (const bag::FieldRange& field : topic->fields) {
        const std::string name = name_in(*topic, field);
        const std::optional<std::size_t> axis =
            can_be_written(field.path) ? velocity_by_name(name) : std::nullopt;
        if (axis && field.finite > 0 && field.elements.empty()) {
          const bool is_own = name != field.path;
          named.push_back({is_own ? topic->name.substr(0, topic->name.rfind('/') + 1) : topic->name,
                           {*axis, column_of(*topic, field)}});
        }
      }
    }
    while (!named.empty()) {
      take_velocities(named);
    }
  }

  // Those of one place, at most one of each axis; what is left over is another reading.
  void take_velocities(
      std::vector<std::pair<std::string, std::pair<std::size_t, CandidateColumn>>>& named) {
    const std::string place = named.front().first;
    std::vector<CandidateColumn> axes(6);
    std::erase_if(named, [&](auto& one) {
      auto& [axis, column] = one.second;
      const bool is_taken = one.first == place && !axes[axis].exists();
      if (is_taken) {
        axes[axis] = std::move(column);
      }
      return is_taken;
    });
    // "r" alone may be the red of a colour.
    const auto is_letter = [&](const CandidateColumn& column) {
      return column.exists() && column.name.size() == column.topic.size() + 2;
    };
    if (!place.empty() && std::ranges::count_if(axes, &CandidateColumn::exists) == 1 &&
        std::ranges::any_of(axes, is_letter)) {
      return;
    }
    for (const Part part : {Part::velocity, Part::rates}) {
      const auto first = axes.begin() + (part == Part::velocity ? 0 : 3);
      Candidate one{.part = part,
                    .what = {},
                    .columns = {first, first + 3},
                    .rank = kTuning.rank_by_name,
                    .why = "by its name"};
      std::vector<std::string> names;
      for (const CandidateColumn& column : one.columns) {
        if (column.exists()) {
          names.push_back(column.name);
        }
      }
      one.what = join_text(names, ", ");
      if (!names.empty()) {
        found_.push_back(std::move(one));
      }
    }
  }

  static void add_command_columns(const bag::TopicReport& topic,
                                  std::vector<CandidateColumn>& columns) {
    for (const std::string& path : command_paths(topic)) {
      if (CandidateColumn column = column_at(topic, path);
          column.exists() && can_be_written(path)) {
        columns.push_back(std::move(column));
      }
    }
  }

  std::vector<const bag::TopicReport*> topics_;
  std::vector<Candidate> found_;
  bool has_autopilot_ = false;
};

// The parts of a pose that one topic, or a table, has by name.
PoseColumns pose_of(const bag::TopicReport& topic) {
  PoseColumns parts;
  const auto is_plain = [](const std::string& name) {
    return can_be_written(name) && name.find_first_of("\"\\") == std::string::npos;
  };
  for (const bag::FieldRange& field : topic.fields) {
    const bool is_one =
        field.finite > 0 && field.elements.empty() && is_plain(field.path) && is_plain(topic.name);
    const auto part = is_one ? measured_pose_part(field.path) : std::nullopt;
    if (part) {
      parts.try_emplace(*part, column_of(topic, field));
    }
  }
  const bool is_quaternion =
      parts.contains("qw") && parts.contains("qx") && parts.contains("qy") && parts.contains("qz");
  std::erase_if(parts, [&](const auto& part) {
    const bool is_angle = part.first.size() > 1 && part.first[0] != 'q';
    return is_quaternion ? is_angle : part.first[0] == 'q';
  });
  const bool has_plane =
      parts.contains("x") && parts.contains("y") && (is_quaternion || parts.contains("yaw"));
  if (!has_plane) {
    parts.erase("x");
    parts.erase("y");
  }
  const bool moves = std::ranges::any_of(parts, [](const auto& part) {
    return part.second.varies() && part.first != "roll" && part.first != "pitch";
  });
  return moves ? parts : PoseColumns{};
}

}  // namespace

std::pair<std::string, std::string> pose_part(const std::string& text) {
  const std::size_t sign = text.find('=');
  return {pose_part_by_name(text.substr(0, sign)).value_or(""),
          sign == std::string::npos ? text : text.substr(sign + 1)};
}

PoseChoice choose_pose(const bag::BagReport& report) {
  PoseChoice choice;
  for (const bag::TopicReport& topic : report.topics) {
    PoseColumns parts = pose_of(topic);
    if (parts.size() > choice.parts.size()) {
      choice = {std::move(parts), {topic.name}};
    } else if (!parts.empty() && parts.size() == choice.parts.size()) {
      choice.rivals.push_back(topic.name);
    }
  }
  return choice;
}

std::string short_type(std::string type) {
  const std::size_t msg = type.find("/msg/");
  return msg == std::string::npos ? type : type.replace(msg, 5, "/");
}

std::string toml_text(std::string_view name) {
  std::string literal = "\"";
  for (const char c : name) {
    literal += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  }
  return literal + "\"";
}

bool can_be_written(std::string_view name) {
  for (std::size_t i = 0; i < name.size();) {
    const auto c = static_cast<unsigned char>(name[i]);
    const std::size_t more = c < 0x80 ? 0 : c >= 0xF0 ? 3 : c >= 0xE0 ? 2 : 1;
    if (c < 0x20 || c == 0x7F || (c >= 0x80 && c < 0xC2) || c > 0xF4 || i + more >= name.size()) {
      return false;
    }
    for (std::size_t k = 1; k <= more; ++k) {
      if ((static_cast<unsigned char>(name[i + k]) & 0xC0U) != 0x80U) {
        return false;
      }
    }
    i += 1 + more;
  }
  return true;
}

CandidateColumn column_of(const bag::TopicReport& topic, const bag::FieldRange& field) {
  CandidateColumn column =
      seen_column(topic, field.path, field.unit,
                  {.low = field.low, .high = field.high, .finite = field.finite});
  column.rate_hz = field.rate_hz > 0.0 ? field.rate_hz : column.rate_hz;
  return column;
}

std::vector<Candidate> find_candidates(const bag::BagReport& report) {
  return Finder(report).run();
}

}  // namespace kelpie::log
