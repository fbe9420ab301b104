// SPDX-License-Identifier: Apache-2.0
#include "bag/mat_arrays.hpp"

#ifdef KELPIE_WITH_MATIO
#include <fmt/format.h>
#include <matio.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "bag/byte_reader.hpp"
#include "bag/child_process.hpp"
#include "bag/tuning.hpp"
#include "file/content.hpp"
#include "file/mapped_file.hpp"
#endif

namespace kelpie::bag {

#ifdef KELPIE_WITH_MATIO

namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// How many elements a variable has; none where its sizes can't be.
std::optional<std::size_t> count_of(const matvar_t& variable) {
  std::size_t count = 1;
  if (variable.rank < 1 || variable.dims == nullptr) {
    return std::nullopt;
  }
  for (int k = 0; k < variable.rank; ++k) {
    const std::size_t size = variable.dims[k];  // NOLINT: C
    if (size != 0 && count > kTuning.most_numbers / size) {
      return std::nullopt;
    }
    count *= size;
  }
  return count;
}

template <typename T>
std::vector<double> doubles_of(const void* data, std::size_t count) {
  const auto* const from = static_cast<const T*>(data);
  std::vector<double> values(count);
  std::transform(from, from + count, values.begin(),  // NOLINT: C
                 [](T value) { return static_cast<double>(value); });
  return values;
}

using ToDoubles = std::vector<double> (*)(const void* data, std::size_t count);

// nullptr: no array of numbers.
ToDoubles conversion_of(matio_classes kind) {
  constexpr auto kConversions = std::to_array<std::pair<matio_classes, ToDoubles>>({
      {MAT_C_DOUBLE, doubles_of<double>},
      {MAT_C_SINGLE, doubles_of<float>},
      {MAT_C_INT8, doubles_of<std::int8_t>},
      {MAT_C_UINT8, doubles_of<std::uint8_t>},
      {MAT_C_INT16, doubles_of<std::int16_t>},
      {MAT_C_UINT16, doubles_of<std::uint16_t>},
      {MAT_C_INT32, doubles_of<std::int32_t>},
      {MAT_C_UINT32, doubles_of<std::uint32_t>},
      {MAT_C_INT64, doubles_of<std::int64_t>},
      {MAT_C_UINT64, doubles_of<std::uint64_t>},
  });
  const auto* const found =
      std::ranges::find(kConversions, kind, [](const auto& one) { return one.first; });
  return found == kConversions.end() ? nullptr : found->second;
}

bool is_real(const matvar_t* variable) {
  return variable != nullptr && conversion_of(variable->class_type) != nullptr &&
         variable->isComplex == 0;
}

bool is_object(const matvar_t& variable) {
  return variable.class_type == MAT_C_OBJECT || variable.class_type == MAT_C_FUNCTION ||
         variable.class_type == MAT_C_OPAQUE;
}

bool is_real_scalar(const matvar_t* variable) {
  return is_real(variable) && count_of(*variable) == 1;
}

// Letters, digits and underscores, a letter first.
std::string mat_identifier(std::string_view name) {
  std::string text(name.substr(0, kTuning.longest_name));
  std::ranges::replace_if(
      text, [](char c) { return !is_letter(c) && (c < '0' || c > '9'); }, '_');
  return text.empty() || !is_letter(text.front()) ? "v" + text : text;
}

// The text of a row of characters, or "".
std::string characters_of(const matvar_t* variable) {
  if (variable == nullptr || variable->class_type != MAT_C_CHAR || variable->data == nullptr ||
      (variable->data_size != 1 && variable->data_size != 2)) {
    return {};
  }
  const std::size_t count = count_of(*variable).value_or(0);
  const auto* const bytes = static_cast<const char*>(variable->data);
  const auto step = static_cast<std::size_t>(variable->data_size);
  std::string text;
  for (std::size_t k = 0; k < count && k * step < variable->nbytes; ++k) {
    text.push_back(bytes[k * step]);  // NOLINT: C
  }
  return text;
}

// Whether all elements of a field are single numbers.
bool are_scalars(const std::vector<matvar_t*>& elements) {
  return std::ranges::all_of(
      elements, [](const matvar_t* one) { return is_real_scalar(one) && one->data != nullptr; });
}

std::vector<matvar_t*> elements_of(matvar_t* variable, unsigned int field, std::size_t count) {
  std::vector<matvar_t*> elements;
  for (std::size_t k = 0; k < count; ++k) {
    elements.push_back(Mat_VarGetStructFieldByIndex(variable, field, k));
  }
  return elements;
}

// Of a field of the k-th struct. Simulink's signals are called by their labels.
std::string path_of(matvar_t* variable, std::size_t k, std::size_t count, const std::string& path,
                    const std::string& field) {
  const std::string label = characters_of(Mat_VarGetStructFieldByName(variable, "label", k));
  const bool is_signal = Mat_VarGetStructFieldByName(variable, "values", k) != nullptr;
  if (is_signal && !label.empty() && path.find('.') != std::string::npos) {
    const std::string name = path.substr(0, path.rfind('.') + 1) + mat_identifier(label);
    return field == "values" ? name : name + "." + field;
  }
  return fmt::format("{}{}.{}", path, count > 1 ? fmt::format("_{}", k + 1) : "", field);
}

// Receives what is in a file.
struct MatNews {
  std::function<void(const MatArray&)> take;
  LoseDamage lose;
  LeaveOut leave_out;
};

// Takes variables of libmatio apart into arrays of real numbers.
class MatCollector {
 public:
  MatCollector(const std::filesystem::path& file, const MatNews& news) : file_(file), news_(news) {}

  // `most`: numbers that the variable's bytes can hold.
  void add_variable(matvar_t* variable, const std::string& path, std::size_t most) {
    left_ = most;
    add(variable, path, 0);
  }

 private:
  void add(matvar_t* variable, const std::string& path, std::size_t depth) {
    if (variable == nullptr || count_ >= kTuning.most_arrays) {
      return;
    }
    if (depth > kTuning.deepest_struct) {
      throw InputError({.file = file_.string(), .field = path},
                       "has structs within structs more than 16 deep");
    }
    const auto count = count_of(*variable);
    if (variable->class_type == MAT_C_EMPTY) {
      news_.leave_out(path + " was never filled");
    } else if (is_object(*variable)) {
      news_.leave_out(path + " is an object of MATLAB; save the content as a struct or array");
    } else if (!count) {
      lose(path, "is damaged: impossible size");
    } else if (variable->class_type == MAT_C_STRUCT && variable->data != nullptr) {
      add_structs(variable, *count, path, depth);
    } else if (variable->class_type == MAT_C_CELL && variable->data != nullptr) {
      for (std::size_t k = 0; k < std::min(*count, kTuning.most_elements); ++k) {
        add(Mat_VarGetCell(variable, static_cast<int>(k)), fmt::format("{}_{}", path, k + 1),
            depth + 1);
      }
    } else if (is_real(variable) && *count > 0) {
      add_numbers(*variable, *count, path);
    }
  }

  void hand_on(const MatArray& array) {
    ++count_;
    news_.take(array);
  }

  void add_numbers(const matvar_t& variable, std::size_t count, const std::string& path) {
    const std::size_t bytes = Mat_SizeOfClass(variable.class_type);
    if (variable.data == nullptr || static_cast<std::size_t>(variable.data_size) != bytes ||
        variable.nbytes / bytes < count || count > left_) {
      lose(path, fmt::format("is damaged: {} numbers are missing", count));
      return;
    }
    left_ -= count;
    const std::size_t last = variable.dims[variable.rank - 1];  // NOLINT: C
    hand_on({.path = path,
             .rows = count / last,
             .columns = last,
             .values = conversion_of(variable.class_type)(variable.data, count)});
  }

  void add_structs(matvar_t* variable, std::size_t count, const std::string& path,
                   std::size_t depth) {
    const unsigned int fields = Mat_VarGetNumberOfFields(variable);
    char* const* const names = Mat_VarGetStructFieldnames(variable);
    if (names == nullptr || variable->nbytes / sizeof(matvar_t*) / std::max(1U, fields) < count) {
      lose(path, "is damaged: structs are missing");
      return;
    }
    for (unsigned int f = 0; f < fields; ++f) {
      const char* const raw = names[f];  // NOLINT: C
      const std::string name = mat_identifier(raw == nullptr ? "" : raw);
      const std::vector<matvar_t*> elements = elements_of(variable, f, count);
      if (count > 1 && are_scalars(elements)) {
        MatArray array{.path = path + "." + name, .rows = count, .columns = 1, .values = {}};
        for (const matvar_t* const one : elements) {
          array.values.push_back(conversion_of(one->class_type)(one->data, 1).front());
        }
        hand_on(array);
        continue;
      }
      for (std::size_t k = 0; k < std::min(count, kTuning.most_elements); ++k) {
        add(elements[k], path_of(variable, k, count, path, name), depth + 1);
      }
    }
  }

  void lose(const std::string& path, const std::string& message) const {
    news_.lose(InputError({.file = file_.string(), .field = path}, message));
  }

  const std::filesystem::path& file_;
  const MatNews& news_;
  std::size_t count_ = 0;
  std::size_t left_ = 0;  // of the variable's numbers
};

using MatVariable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

std::string& heard() {
  thread_local std::string text;
  return text;
}

// HDF5's errors are of several lines.
void hear(int /*level*/, char* message) {  // NOLINT(readability-non-const-parameter): matio's
  const std::string_view text = message;
  heard() = text.substr(0, text.find('\n'));
}

// A variable's element of version 5, unpacked: its size, and its first bytes (tag, flags, name and
// further).
struct MatElement {
  std::size_t size = 0;
  std::vector<std::byte> head{};
};

constexpr std::size_t kMatHead = 128;  // bytes of the file before the first variable
constexpr std::size_t kTag = 8;
constexpr std::size_t kHeadBytes = 512;  // bytes that hold name and class of an object

// Unpacks all for zlib's checksum; nothing where the content is damaged.
std::optional<MatElement> unpacked(std::span<const std::byte> packed) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) {
    return std::nullopt;
  }
  MatElement element;
  std::array<std::byte, 65'536> block;  // NOLINT: filled by zlib
  // NOLINTBEGIN: C
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  int state = Z_OK;
  while (state == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = static_cast<uInt>(block.size());
    state = inflate(&stream, Z_NO_FLUSH);
    const std::size_t bytes = block.size() - stream.avail_out;
    if (element.size == 0) {
      element.head.assign(block.begin(), block.begin() + std::min(kHeadBytes, bytes));
    }
    element.size += bytes;
  }
  // NOLINTEND
  inflateEnd(&stream);
  return state == Z_STREAM_END ? std::optional(std::move(element)) : std::nullopt;
}

// The variables of a file of version 5 that are whole, by their outermost elements, because
// libmatio fills with zeros where a file is cut off. Tells the first variable that is not whole.
std::vector<MatElement> whole_variables(std::span<const std::byte> bytes, std::endian order,
                                        const std::filesystem::path& file, const LoseDamage& lose) {
  std::vector<MatElement> whole;
  std::size_t at = kMatHead;
  while (at < bytes.size()) {
    const std::span<const std::byte> left = bytes.subspan(at);
    const bool has_tag = left.size() >= kTag;
    const auto kind = has_tag ? number_at<std::uint32_t>(left, order) : 0;
    const std::size_t size = has_tag ? number_at<std::uint32_t>(left.subspan(4), order) : 0;
    std::optional<MatElement> element;
    if (has_tag && size <= left.size() - kTag) {
      if (kind == MAT_T_COMPRESSED) {
        element = unpacked(left.subspan(kTag, size));
      } else if (kind == MAT_T_MATRIX) {
        const std::span<const std::byte> head = left.first(std::min(kHeadBytes, kTag + size));
        element = MatElement{.size = size, .head = {head.begin(), head.end()}};
      }
    }
    if (!element) {
      lose(InputError({.file = file.string(), .field = fmt::format("offset {}", at)},
                      "is cut off or damaged: the variable that begins here is not whole"));
      break;
    }
    whole.push_back(*std::move(element));
    at += kTag + size;
  }
  return whole;
}

// "vehicle is an object of class string; …". libmatio reads neither name nor class of an object:
// both stand behind tag and flags, with the name of the type system between.
std::string object_text(std::span<const std::byte> head, std::endian order) {
  std::array<std::string, 3> texts{"a variable", "", ""};
  std::size_t at = 3 * kTag;
  for (std::string& text : texts) {
    if (head.size() < at + kTag) {
      break;
    }
    const auto first = number_at<std::uint32_t>(head.subspan(at), order);
    const bool is_small = first >> 16U != 0;  // the text stands within the tag
    const std::size_t size =
        is_small ? first >> 16U : number_at<std::uint32_t>(head.subspan(at + 4), order);
    const std::size_t begin = at + (is_small ? 4 : kTag);
    if (size > head.size() - begin) {
      break;
    }
    const auto* const letters = reinterpret_cast<const char*>(head.data());  // NOLINT: bytes
    text = mat_identifier(std::string_view(letters, head.size()).substr(begin, size));
    at = (begin + size + kTag - 1) / kTag * kTag;
  }
  return fmt::format("{} is an object{}; save the content as a struct or array", texts[0],
                     texts[2].empty() ? " of MATLAB" : " of class " + texts[2]);
}

// Reads a file with libmatio, in the process that calls.
void read_with_matio(const std::filesystem::path& file, const MatNews& news) {
  Mat_LogInitFunc("kelpie", hear);
  heard().clear();
  const std::unique_ptr<mat_t, decltype(&Mat_Close)> mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY),
                                                         &Mat_Close);
  if (mat == nullptr) {
    throw InputError({.file = file.string()}, "is no MATLAB file that can be read: " + heard());
  }
  const bool is_version_5 = Mat_GetVersion(mat.get()) == MAT_FT_MAT5;
  const file::MappedFile content(file);
  const bool is_little = is_version_5 && content.bytes()[kMatHead - 2] == std::byte{'I'};
  const std::endian order = is_little ? std::endian::little : std::endian::big;
  const std::vector<MatElement> whole =
      is_version_5 ? whole_variables(content.bytes(), order, file, news.lose)
                   : std::vector<MatElement>();
  MatCollector collector(file, news);
  std::size_t read = 0;
  for (; read < whole.size() || !is_version_5; ++read) {
    const MatVariable variable(Mat_VarReadNext(mat.get()), &Mat_VarFree);
    if (variable == nullptr || (is_version_5 && !heard().empty())) {
      break;
    }
    const std::string name = variable->name == nullptr ? "" : variable->name;
    if (!name.empty()) {
      collector.add_variable(variable.get(), mat_identifier(name),
                             is_version_5 ? whole[read].size : kTuning.most_numbers);
    } else if (variable->class_type == MAT_C_OPAQUE && is_version_5) {
      news.leave_out(object_text(whole[read].head, order));
    }  // else the content of all objects
  }
  if (read < whole.size() || (!is_version_5 && !heard().empty())) {
    news.lose(InputError(
        {.file = file.string()},
        fmt::format("is damaged: its variable number {} can't be read: {}", read + 1, heard())));
  }
}

// What the child tells: an array, damage, what is left out, an error that ends the child, or the
// end of the file.
enum class News : char { array = 'a', damage = 'd', left_out = 'l', error = 'e', end = 'z' };

// The child's side: news follow each other, each with a text; an array with its size and values.
class NewsWriter {
 public:
  explicit NewsWriter(const ChildProcess::Write& write) : write_(write) {}

  void tell(News kind, const std::string& text) const {
    put(kind);
    put(text.size());
    write_(std::as_bytes(std::span(text)));
  }
  void tell(const MatArray& array) const {
    tell(News::array, array.path);
    put(array.rows);
    put(array.columns);
    write_(std::as_bytes(std::span(array.values)));
  }

 private:
  template <typename T>
  void put(const T& value) const {
    write_(std::as_bytes(std::span(&value, 1)));
  }

  const ChildProcess::Write& write_;
};

// The parent's side. A child with a damaged heap may say anything: every size is checked.
class NewsReader {
 public:
  NewsReader(ChildProcess& child, std::size_t most_bytes) : child_(child), left_(most_bytes) {}

  // False where the child breaks off.
  bool next(News& kind, std::string& text) {
    std::size_t size = 0;
    if (!get(kind) || !get(size) || !takes(size)) {
      return false;
    }
    text.resize(size);
    return child_.read(std::as_writable_bytes(std::span(text)));
  }
  bool next(MatArray& array) {
    if (!get(array.rows) || !get(array.columns) || array.columns == 0 ||
        array.rows > kTuning.most_numbers / array.columns ||
        !takes(array.rows * array.columns * sizeof(double))) {
      return false;
    }
    array.values.resize(array.rows * array.columns);
    return child_.read(std::as_writable_bytes(std::span(array.values)));
  }

 private:
  template <typename T>
  bool get(T& value) {
    return child_.read(std::as_writable_bytes(std::span(&value, 1)));
  }
  bool takes(std::size_t bytes) {
    const bool fits = bytes <= left_;
    left_ -= fits ? bytes : left_;
    return fits;
  }

  ChildProcess& child_;
  std::size_t left_;
};

ChildLimits limits_for(const std::filesystem::path& file) {
  const auto size = static_cast<std::size_t>(std::filesystem::file_size(file));
  return {.bytes = kTuning.child_free_bytes + kTuning.child_ratio * size,
          .seconds = kTuning.child_free_s + static_cast<int>(size / 1'000'000)};
}

void read_in_child(const std::filesystem::path& file, const ChildProcess::Write& write) {
  const NewsWriter writer(write);
  try {
    read_with_matio(
        file, {.take = [&](const MatArray& array) { writer.tell(array); },
               .lose = [&](const InputError& damage) { writer.tell(News::damage, damage.what()); },
               .leave_out = [&](const std::string& what) { writer.tell(News::left_out, what); }});
    writer.tell(News::end, "");
  } catch (const InputError& error) {
    writer.tell(News::error, error.what());
  }
}

}  // namespace

std::vector<MatArray> read_mat_arrays(const std::filesystem::path& file, const LoseDamage& lose,
                                      const LeaveOut& leave_out) {
  const ChildLimits limits = limits_for(file);
  ChildProcess child([&](const auto& write) { read_in_child(file, write); }, limits);
  NewsReader reader(child, limits.bytes);
  std::vector<MatArray> arrays;
  for (News kind{}; kind != News::end;) {
    std::string text;
    MatArray array;
    if (!reader.next(kind, text) || (kind == News::array && !reader.next(array))) {
      lose(InputError(
          {.file = file.string()},
          fmt::format("is damaged, or too large: behind {} arrays libmatio {}, with at "
                      "most {} and {} s",
                      arrays.size(), child.end(), file::megabytes(limits.bytes), limits.seconds)));
      break;
    }
    if (kind == News::array) {
      array.path = text;
      arrays.push_back(std::move(array));
    } else if (kind == News::damage) {
      lose(InputError(text));
    } else if (kind == News::left_out) {
      leave_out(text);
    } else if (kind == News::error) {
      throw InputError(text);
    }
  }
  if (arrays.empty()) {
    throw InputError(
        {.file = file.string()},
        "has no arrays of real numbers that can be read; objects (timeseries, timetable, "
        "table) have to be "
        "saved as structs or arrays");
  }
  return arrays;
}

#else

std::vector<MatArray> read_mat_arrays(const std::filesystem::path& file, const LoseDamage& /*lose*/,
                                      const LeaveOut& /*leave_out*/) {
  throw InputError({.file = file.string()},
                   "is a file of MATLAB, and this kelpie is built without libmatio");
}

#endif

}  // namespace kelpie::bag
