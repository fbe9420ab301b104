// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cstdint>
#include <string_view>

#include "cli/documents.hpp"

namespace kelpie::cli {
namespace {

constexpr std::string_view kAbout = R"(.SH DESCRIPTION
.B kelpie
learns the dynamics of an underwater vehicle (or of anything else that moves) while it drives: from
velocities and commands it predicts accelerations, one sample at a time, in a fixed amount of
memory, and keeps up when the vehicle changes.
A log is a CSV file with a header, or a ROS 2 bag (sqlite3 or MCAP), which is read without ROS.
)";

constexpr std::string_view kRest = R"(.SH EXIT STATUS
.TP
.B 0
All went well.
.TP
.B 1
Something failed that is not the input's fault, or the user stopped it.
.TP
.B 2
The input or the command line is wrong; the message names file, line and field.
.SH ENVIRONMENT
.TP
.B KELPIE_DATA_DIR
Folder in which
.B kelpie reproduce
looks for the real log.
.SH FILES
What a command writes appears whole or not at all.
.TP
.I out/learn/model.json
A learned model, which
.BR predict ", " rollout " and " export
read.
.TP
.I out/learn/result.json
Every number of a run.
.TP
.I out/learn/report.html
The same as one page with figures, which needs no network.
.SH EXAMPLES
Learn a log at 4 rows per second, and predict another with what was learned:
.PP
.nf
.RS
kelpie learn log.csv \-\-inputs u,v,r,th1,th2,th3 \-\-targets udot,vdot,rdot \-\-rate 4
kelpie predict \-\-model out/learn/model.json other.csv
.RE
.fi
.PP
Look into a ROS 2 bag, and learn from its topics:
.PP
.nf
.RS
kelpie inspect mission/
kelpie learn mission/ \-\-config mission.toml
.RE
.fi
.PP
Complete commands in this shell:
.PP
.nf
.RS
source <(kelpie completion bash)
.RE
.fi
)";

// One character of UTF-8 that isn't ASCII, as \[u00B2]; moves i to its last byte.
std::string unicode_escape(std::string_view text, std::size_t& i) {
  constexpr std::uint32_t kTail = 0x3F;
  const auto first = static_cast<unsigned char>(text[i]);
  const std::size_t tail = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : 1;
  std::uint32_t point = first & (kTail >> tail);
  for (std::size_t k = 0; k < tail && i + 1 < text.size(); ++k) {
    point = (point << 6U) | (static_cast<unsigned char>(text[++i]) & kTail);
  }
  return fmt::format("\\[u{:04X}]", point);
}

// Text as roff prints it: `code` in bold, no character that means something to roff.
std::string roff(std::string_view text) {
  std::string out;
  bool bold = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '`') {
      bold = !bold;
      out += bold ? "\\fB" : "\\fR";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\\') {
      out += "\\e";
    } else if ((c == '.' || c == '\'') && i == 0) {
      out += std::string("\\&") + c;
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      out += unicode_escape(text, i);
    } else {
      out += c;
    }
  }
  return out;
}

std::string option_tag(const OptionDoc& option) {
  std::string tag;
  for (const std::string& name : option.names) {
    tag += (tag.empty() ? "" : ", ") +
           fmt::format("\\f{}{}\\fR", option.positional ? 'I' : 'B', roff(name));
  }
  if (!option.positional && !option.value.empty()) {
    tag += fmt::format(" \\fI{}\\fR", roff(option.value)) + (option.repeatable ? " ..." : "");
  }
  return tag;
}

std::string option_entry(const OptionDoc& option) {
  std::string meaning = roff(option.meaning);
  const auto add = [&meaning](const std::string& more) { meaning += "; " + roff(more); };
  if (!option.limits.empty()) {
    add(option.limits);
  }
  if (!option.fallback.empty()) {
    add("default: " + option.fallback);
  }
  if (option.required && !option.positional) {
    add("required");
  }
  return ".TP\n" + option_tag(option) + "\n" + meaning + ".\n";
}

std::string synopsis(const CommandDoc& command) {
  std::string line = ".B kelpie " + command.name + "\n";
  for (const OptionDoc& option : command.options) {
    if (option.required && !option.positional) {
      line += option_tag(option) + "\n";
    }
  }
  line += "[\\fIoptions\\fR]\n";
  for (const OptionDoc& option : command.options) {
    if (option.positional) {
      const std::string tag = option_tag(option);
      line += (option.required ? tag : "[" + tag + "]") + "\n";
    }
  }
  return line;
}

std::string section(const CommandDoc& command) {
  std::string text = ".SS kelpie " + command.name + "\n" + synopsis(command) + ".PP\n" +
                     roff(command.meaning) + ".\n";
  for (const OptionDoc& option : command.options) {
    if (option.name() != "--help") {
      text += option_entry(option);
    }
  }
  return text;
}

}  // namespace

std::string manual_page(std::span<const CommandDoc> commands, const std::string& version) {
  std::string page = fmt::format(
      ".\\\" SPDX-License-Identifier: Apache-2.0\n"
      ".TH KELPIE 1 \"\" \"kelpie {}\" \"User Commands\"\n"
      ".SH NAME\nkelpie \\- on-line learning of underwater vehicle dynamics\n.SH SYNOPSIS\n"
      ".B kelpie\n\\fIcommand\\fR [\\fIoptions\\fR]\n",
      version);
  page += std::string(kAbout) + ".SH OPTIONS\nOf every command:\n";
  for (const OptionDoc& option : commands.front().options) {
    page += option_entry(option);
  }
  page += ".SH COMMANDS\n";
  for (const CommandDoc& command : commands.subspan(1)) {
    page += section(command);
  }
  return page + std::string(kRest);
}

}  // namespace kelpie::cli
