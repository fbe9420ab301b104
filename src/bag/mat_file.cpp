// SPDX-License-Identifier: Apache-2.0
#include "bag/mat_file.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "bag/mapped_file.hpp"
#include "bag/mat_collector.hpp"
#include "bag/mat_elements.hpp"

#ifdef KELPIE_WITH_MATIO
#include <matio.h>
#endif

namespace kelpie::bag {
namespace {

constexpr std::size_t kMatHeader = 128;
constexpr std::size_t kMatVersion = 124;

[[noreturn]] void refuse_mat(const std::filesystem::path& file, const std::string& field,
                             const std::string& message) {
  throw InputError({.file = file.string(), .line = 0, .field = field}, message);
}

#ifdef KELPIE_WITH_MATIO

using MatVariable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

std::string& heard() {
  thread_local std::string text;
  return text;
}

// HDF5's errors are of several lines.
void hear(int /*level*/, char* message) {
  const std::string_view text = message;
  heard() = text.substr(0, text.find('\n'));
}

#endif

}  // namespace

bool begins_as_mat(std::string_view beginning) {
  const std::string_view mark =
      beginning.size() < kMatHeader ? "" : beginning.substr(kMatVersion, 4);
  using namespace std::string_view_literals;
  return beginning.starts_with("MATLAB ") &&
         (mark == "\0\1IM"sv || mark == "\0\2IM"sv || mark == "\1\0MI"sv || mark == "\2\0MI"sv);
}

#ifdef KELPIE_WITH_MATIO

std::vector<MatArray> read_mat_arrays(const std::filesystem::path& file,
                                      const std::function<void(const InputError&)>& lose) {
  Mat_LogInitFunc("kelpie", hear);
  heard().clear();
  const std::unique_ptr<mat_t, decltype(&Mat_Close)> mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY),
                                                         &Mat_Close);
  if (mat == nullptr) {
    refuse_mat(file, {}, "is no MATLAB file that can be read: " + heard());
  }
  const bool is_version_5 = Mat_GetVersion(mat.get()) == MAT_FT_MAT5;
  const std::size_t due =
      is_version_5 ? sound_mat_variables(MappedFile(file).bytes(), file.string(), lose) : 0;
  MatCollector collector(file, lose);
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
        {.file = file.string(), .line = 0, .field = {}},
        fmt::format("is damaged: its variable number {} can't be read: {}", read + 1, heard())));
  }
  if (collector.arrays().empty()) {
    refuse_mat(file, {},
               "has no arrays of real numbers that can be read; objects (timeseries, timetable, "
               "table) have to be "
               "saved as structs or arrays");
  }
  return std::move(collector.arrays());
}

#else

std::vector<MatArray> read_mat_arrays(const std::filesystem::path& file,
                                      const std::function<void(const InputError&)>& /*lose*/) {
  refuse_mat(file, {}, "is a file of MATLAB, and this kelpie is built without libmatio");
}

#endif

}  // namespace kelpie::bag
