// SPDX-License-Identifier: Apache-2.0
#include "bag/mat_arrays.hpp"

#ifdef KELPIE_WITH_MATIO
#include <fmt/format.h>
#include <matio.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "bag/child_process.hpp"
#include "bag/mat_elements.hpp"
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

using TakeArray = std::function<void(const MatArray&)>;

// Takes variables of libmatio apart into arrays of real numbers.
class MatCollector {
 public:
  MatCollector(const std::filesystem::path& file, const TakeArray& take, const LoseDamage& lose)
      : file_(file), take_(take), lose_(lose) {}

  void add(matvar_t* variable, const std::string& path, std::size_t depth = 0) {
    if (variable == nullptr || count_ >= kTuning.most_arrays) {
      return;
    }
    if (depth > kTuning.deepest_struct) {
      throw InputError({.file = file_.string(), .field = path},
                       "has structs within structs more than 16 deep");
    }
    const auto count = count_of(*variable);
    if (!count) {
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

 private:
  void hand_on(const MatArray& array) {
    ++count_;
    take_(array);
  }

  void add_numbers(const matvar_t& variable, std::size_t count, const std::string& path) {
    const std::size_t bytes = Mat_SizeOfClass(variable.class_type);
    if (variable.data == nullptr || static_cast<std::size_t>(variable.data_size) != bytes ||
        variable.nbytes / bytes < count) {
      lose(path, fmt::format("is damaged: {} numbers are missing", count));
      return;
    }
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
    lose_(InputError({.file = file_.string(), .field = path}, message));
  }

  const std::filesystem::path& file_;
  const TakeArray& take_;
  const LoseDamage& lose_;
  std::size_t count_ = 0;
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

// Reads a file with libmatio, in the process that calls.
void read_with_matio(const std::filesystem::path& file, const TakeArray& take,
                     const LoseDamage& lose) {
  Mat_LogInitFunc("kelpie", hear);
  heard().clear();
  const std::unique_ptr<mat_t, decltype(&Mat_Close)> mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY),
                                                         &Mat_Close);
  if (mat == nullptr) {
    throw InputError({.file = file.string()}, "is no MATLAB file that can be read: " + heard());
  }
  const bool is_version_5 = Mat_GetVersion(mat.get()) == MAT_FT_MAT5;
  const std::size_t due =
      is_version_5 ? sound_mat_variables(file::MappedFile(file).bytes(), file.string(), lose) : 0;
  MatCollector collector(file, take, lose);
  std::size_t read = 0;
  while (read < due || !is_version_5) {
    const MatVariable variable(Mat_VarReadNext(mat.get()), &Mat_VarFree);
    if (variable == nullptr) {
      break;
    }
    ++read;
    if (variable->name != nullptr) {
      collector.add(variable.get(), mat_identifier(variable->name));
    }
  }
  if (read < due || (!is_version_5 && !heard().empty())) {
    lose(InputError(
        {.file = file.string()},
        fmt::format("is damaged: its variable number {} can't be read: {}", read + 1, heard())));
  }
}

// What the child tells: an array, damage, an error that ends it, or the end of the file.
enum class News : char { array = 'a', damage = 'd', error = 'e', end = 'z' };

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
        file, [&](const MatArray& array) { writer.tell(array); },
        [&](const InputError& damage) { writer.tell(News::damage, damage.what()); });
    writer.tell(News::end, "");
  } catch (const InputError& error) {
    writer.tell(News::error, error.what());
  }
}

}  // namespace

std::vector<MatArray> read_mat_arrays(const std::filesystem::path& file, const LoseDamage& lose) {
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

std::vector<MatArray> read_mat_arrays(const std::filesystem::path& file,
                                      const LoseDamage& /*lose*/) {
  throw InputError({.file = file.string()},
                   "is a file of MATLAB, and this kelpie is built without libmatio");
}

#endif

}  // namespace kelpie::bag
