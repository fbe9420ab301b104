// SPDX-License-Identifier: Apache-2.0
#include "bag/sqlite_reader.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <limits>
#include <map>

namespace kelpie::bag {
namespace {

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close_v2)>;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

std::string text_at(const Statement& row, int column) {
  const unsigned char* const text = sqlite3_column_text(row.get(), column);
  const int bytes = sqlite3_column_bytes(row.get(), column);
  return text == nullptr ? "" : std::string(text, text + bytes);  // NOLINT: SQLite's interface
}

class SqliteReader final : public MessageReader {
 public:
  SqliteReader(const std::filesystem::path& file, ReadMode mode)
      : MessageReader(mode, file.string()), file_(file.string()) {
    open();
    limit();
    if (!has_table("topics") || !has_table("messages")) {
      refuse("is an SQLite file, but no bag: it has no tables topics and messages");
    }
    check_last_page();
    read_topics();
    rows_ = prepare(messages("ORDER BY rowid"));
  }

  Place place() const override {
    const std::string topic = last_topic_.empty() ? "" : last_topic_ + ", ";
    return {.file = file_, .field = fmt::format("{}message {}", topic, last_id_)};
  }

 private:
  bool at_end() const override { return at_end_; }

  bool step(Message& message) override {
    if (!run(rows_, fmt::format("after message {}", last_id_))) {
      at_end_ = true;
      return false;
    }
    sqlite3_stmt* const row = rows_.get();
    const std::int64_t id = sqlite3_column_int64(row, 0);
    const auto topic = topic_by_id_.find(sqlite3_column_int64(row, 1));
    const std::int64_t time_ns = sqlite3_column_int64(row, 2);
    last_id_ = id;
    last_topic_ = topic == topic_by_id_.end() ? "" : topics()[topic->second].name;
    if (topic == topic_by_id_.end()) {
      lose(InputError(place(), "belongs to a topic that the bag doesn't list"));
      return false;
    }
    if (time_ns < 0 || time_ns > Message::kLatestNs) {
      lose(InputError(place(), fmt::format("has the time {} ns, before 1970 or later than the year "
                                           "2116",
                                           time_ns)));
      return false;
    }
    const void* const data = sqlite3_column_blob(row, 3);
    const int bytes = sqlite3_column_bytes(row, 3);
    message = {.topic = topic->second,
               .receive_ns = time_ns,
               .publish_ns = time_ns,
               .data = {static_cast<const std::byte*>(data), static_cast<std::size_t>(bytes)}};
    return true;
  }

  // Once: what lies behind the damage is reached from the other side.
  void pass_damage() override {
    if (backwards_ || bytes_left_ == 0 || steps_left_ == 0) {
      at_end_ = true;
      return;
    }
    backwards_ = true;
    rows_ = prepare(messages(fmt::format("WHERE rowid > {} ORDER BY rowid DESC", last_id_)));
  }

  // Row by row as the file has them: no index, whose rows would have to be sorted first.
  static std::string messages(const std::string& which) {
    return "SELECT rowid, topic_id, timestamp, data FROM messages NOT INDEXED " + which;
  }

  [[noreturn]] void refuse(const std::string& message) const {
    throw InputError({.file = file_}, message);
  }

  void open() {
    sqlite3* raw = nullptr;
    const int code = sqlite3_open_v2(file_.c_str(), &raw, SQLITE_OPEN_READONLY, nullptr);
    database_.reset(raw);
    if (code != SQLITE_OK) {
      refuse(fmt::format("cannot be read: {}", sqlite3_errstr(code)));
    }
  }

  // A damaged file may claim anything: no cell is longer than the file, no schema is trusted, and
  // pages that are named twice do not make the work endless.
  void limit() {
    for (const char* const ending : {"", "-wal"}) {
      std::error_code error;
      const auto size = std::filesystem::file_size(file_ + ending, error);
      bytes_ += error ? 0 : size;
    }
    bytes_left_ = steps_left_ = bytes_;
    const auto longest = std::min<std::uintmax_t>(bytes_, std::numeric_limits<int>::max());
    sqlite3_limit(database_.get(), SQLITE_LIMIT_LENGTH,  // the query itself has to fit, too
                  std::max(static_cast<int>(longest), 4096));
    const auto has_ended = [](void* reader) {
      auto& left = static_cast<SqliteReader*>(reader)->steps_left_;
      return left == 0 ? 1 : static_cast<int>(--left == 0);
    };
    sqlite3_progress_handler(database_.get(), kInstructions, has_ended, this);
    for (const char* const pragma :
         {"PRAGMA trusted_schema = OFF", "PRAGMA cell_size_check = ON"}) {
      sqlite3_exec(database_.get(), pragma, nullptr, nullptr, nullptr);
    }
  }

  Statement prepare(const std::string& query) const {
    sqlite3_stmt* raw = nullptr;
    const int code = sqlite3_prepare_v2(database_.get(), query.c_str(), -1, &raw, nullptr);
    if (code != SQLITE_OK) {
      refuse(fmt::format("is damaged, or no bag of rosbag2: {}", sqlite3_errmsg(database_.get())));
    }
    return {raw, &sqlite3_finalize};
  }

  bool run(const Statement& statement, const std::string& where) {
    const int code = sqlite3_step(statement.get());
    if (code == SQLITE_DONE) {
      return false;
    }
    if (code == SQLITE_ROW && pay_for_row(statement.get())) {
      return true;
    }
    if (code == SQLITE_ROW || (code & 0xFF) == SQLITE_INTERRUPT) {
      refuse(fmt::format("{}: holds more rows than can come of its {} bytes", where, bytes_));
    }
    if ((code & 0xFF) == SQLITE_NOMEM) {
      throw Failure(file_ + ": out of memory");
    }
    refuse(fmt::format("{}: is damaged or cut off: {}", where, sqlite3_errmsg(database_.get())));
  }

  // Every row costs the bytes of its texts and blobs and one more. False: the file has no more.
  bool pay_for_row(sqlite3_stmt* row) {
    std::uintmax_t cost = 1;
    for (int column = 0; column < sqlite3_column_count(row); ++column) {
      const int type = sqlite3_column_type(row, column);
      if (type == SQLITE_TEXT || type == SQLITE_BLOB) {
        cost += static_cast<std::uintmax_t>(sqlite3_column_bytes(row, column));
      }
    }
    const bool is_paid = cost <= bytes_left_;
    bytes_left_ = is_paid ? bytes_left_ - cost : 0;
    return is_paid;
  }

  bool has_table(const std::string& name) {
    const Statement query =
        prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = '" + name + "'");
    return run(query, "table of contents");
  }

  // SQLite takes what is missing of the last page for zeros.
  void check_last_page() {
    const Statement query = prepare("PRAGMA page_size");
    run(query, "page size");
    std::error_code error;
    const auto page = static_cast<std::uintmax_t>(sqlite3_column_int64(query.get(), 0));
    if (page > 0 && std::filesystem::file_size(file_, error) % page != 0) {
      lose(InputError({.file = file_}, "is cut off within its last page"));
    }
  }

  void read_topics() {
    const std::map<std::string, std::string> definitions = read_definitions();
    const Statement query =
        prepare("SELECT id, name, type, serialization_format, offered_qos_profiles FROM topics");
    while (run(query, "topics")) {
      Topic topic;
      topic.name = text_at(query, 1);
      topic.type = text_at(query, 2);
      topic.encoding = text_at(query, 3);
      topic.qos_profiles = text_at(query, 4);
      if (const auto found = definitions.find(topic.type); found != definitions.end()) {
        topic.definition = found->second;
      }
      topic_by_id_[sqlite3_column_int64(query.get(), 0)] = add_topic(topic, file_);
    }
  }

  std::map<std::string, std::string> read_definitions() {
    std::map<std::string, std::string> definitions;
    if (has_table("message_definitions")) {
      const Statement query = prepare(
          "SELECT topic_type, encoded_message_definition FROM message_definitions WHERE "
          "encoding = 'ros2msg'");
      while (run(query, "message_definitions")) {
        definitions[text_at(query, 0)] = text_at(query, 1);
      }
    }
    return definitions;
  }

  static constexpr int kInstructions = 16;  // of SQLite, for a byte of the file: a row takes ten

  std::string file_;
  std::uintmax_t bytes_ = 0;       // of the file
  std::uintmax_t bytes_left_ = 0;  // for rows
  std::uintmax_t steps_left_ = 0;  // of kInstructions, also for what makes no row
  Database database_{nullptr, &sqlite3_close_v2};
  Statement rows_{nullptr, &sqlite3_finalize};
  std::map<std::int64_t, std::size_t> topic_by_id_;
  std::string last_topic_;
  std::int64_t last_id_ = 0;
  bool backwards_ = false;
  bool at_end_ = false;
};

}  // namespace

bool begins_as_sqlite(std::string_view beginning) {
  return beginning.starts_with("SQLite format 3");
}

std::unique_ptr<MessageReader> read_sqlite_bag(const std::filesystem::path& file, ReadMode mode,
                                               const RowTimes& /*times*/) {
  return std::make_unique<SqliteReader>(file, mode);
}

}  // namespace kelpie::bag
