#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/hdf5_handle.hpp"
#include "protocol/files/hdf5_library.hpp"
#include "protocol/files/printable.hpp"

namespace furrow {
namespace {

constexpr hsize_t kMaxNumbers = hsize_t{1} << 31;  // of one dataset
constexpr std::size_t kMaxAttribute = 4096;        // bytes of a text

std::string quoted(const std::string& name) { return "'" + excerpt(name) + "'"; }

/// Whether it is one of the plain number types that every program writes, in any byte order.
bool is_plain_number(hid_t type) {
  static const std::array<hid_t, 20> kPlain{
      H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_IEEE_F64BE, H5T_STD_I8LE,  H5T_STD_I16LE, H5T_STD_I32LE,
      H5T_STD_I64LE,  H5T_STD_U8LE,   H5T_STD_U16LE,  H5T_STD_U32LE,  H5T_STD_U64LE, H5T_STD_I8BE,  H5T_STD_I16BE,
      H5T_STD_I32BE,  H5T_STD_I64BE,  H5T_STD_U8BE,   H5T_STD_U16BE,  H5T_STD_U32BE, H5T_STD_U64BE};
  return std::any_of(kPlain.begin(), kPlain.end(), [&](hid_t plain) { return H5Tequal(type, plain) > 0; });
}

/// The product; 2⁶⁴ − 1 if it is larger.
hsize_t product(const std::vector<hsize_t>& factors, hsize_t first) {
  hsize_t all = first;
  for (const hsize_t factor : factors)
    if (__builtin_mul_overflow(all, factor, &all)) all = std::numeric_limits<hsize_t>::max();
  return std::find(factors.begin(), factors.end(), 0) != factors.end() ? 0 : all;
}

herr_t add_dataset(hid_t, const char* name, const H5O_info_t* info, void* names) {
  if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

}  // namespace

/// An open dataset with its shape and type.
class Hdf5Reader::Set {
 public:
  Set(const Hdf5Reader& file, const std::string& name)
      : file_(file),
        name_(name),
        set_(file.has(name) ? H5Dopen2(file.handle_, name.c_str(), H5P_DEFAULT) : -1, H5Dclose),
        made_(set_.ok() ? H5Dget_create_plist(set_) : -1, H5Pclose),
        space_(set_.ok() ? H5Dget_space(set_) : -1, H5Sclose),
        type_(set_.ok() ? H5Dget_type(set_) : -1, H5Tclose) {
    file_.check(set_.ok(), "lacks the dataset " + quoted(name));
    file_.check(made_.ok() && space_.ok() && type_.ok(), "the dataset " + quoted(name) + " is damaged");
    const int axes = std::max(H5Sget_simple_extent_ndims(space_), 0);
    shape_.resize(static_cast<std::size_t>(axes));
    if (axes > 0) H5Sget_simple_extent_dims(space_, shape_.data(), nullptr);
    const hsize_t count = numbers();
    file_.check(count <= kMaxNumbers, fmt::format("the dataset {} is said to have more than {} numbers, expected fewer",
                                                  quoted(name), kMaxNumbers));
  }

  operator hid_t() const { return set_; }
  const std::vector<hsize_t>& shape() const { return shape_; }
  hid_t type() const { return type_; }
  hsize_t numbers() const { return H5Sget_simple_extent_type(space_) == H5S_NULL ? 0 : product(shape_, 1); }

  /// @throws Error(io) unless it has plain numbers, and no more than the file has bytes for
  void check_stored() const {
    file_.check(
        is_plain_number(type_),
        "the dataset " + quoted(name_) + " does not hold plain numbers, expected integers or floats of 1 to 8 bytes");
    const bool packed = H5Pget_nfilters(made_) > 0;
    const hsize_t bytes = H5Dget_storage_size(set_), each = H5Tget_size(type_);
    const hsize_t most = packed ? product({kMaxRatio}, bytes) : bytes;
    const hsize_t needed = product(shape_, each), chunk = chunk_bytes(each);
    if (numbers() == 0) return;
    file_.check(bytes <= file_.size_ && needed <= most && chunk <= std::max(most, kSmallChunk),
                fmt::format("the dataset {} is said to have {} bytes, but {} are stored: it was never written, or the "
                            "file is cut short or damaged",
                            quoted(name_), needed, std::min<hsize_t>(bytes, file_.size_)));
  }

 private:
  static constexpr hsize_t kSmallChunk = 1 << 20;

  hsize_t chunk_bytes(hsize_t each) const {
    if (H5Pget_layout(made_) != H5D_CHUNKED) return 0;
    std::array<hsize_t, H5S_MAX_RANK> length{};
    const int axes = H5Pget_chunk(made_, H5S_MAX_RANK, length.data());
    return axes > 0 ? product({length.begin(), length.begin() + axes}, each) : 0;
  }

  const Hdf5Reader& file_;
  const std::string& name_;
  Handle set_, made_, space_, type_;
  std::vector<hsize_t> shape_;
};

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file) : lock_(hdf5::library()), file_(file) {
  hdf5::prepare();
  std::error_code error;
  check(std::filesystem::exists(file_, error), "does not exist");
  check(std::filesystem::is_regular_file(file_, error), "is not a regular file");
  size_ = std::filesystem::file_size(file_, error);
  check(!error, "cannot be read");
  handle_ = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  check(handle_ >= 0, "not an HDF5 file, or damaged");
  try {
    if (!has_attribute("format_version")) return;
    const std::int64_t version = integer("format_version");
    check(version <= hdf5::kFormatVersion, "format_version " + std::to_string(version) +
                                               " is newer than this program reads, which is " +
                                               std::to_string(hdf5::kFormatVersion));
  } catch (...) {
    H5Fclose(handle_);
    throw;
  }
}

Hdf5Reader::~Hdf5Reader() { H5Fclose(handle_); }

void Hdf5Reader::check(bool ok, const std::string& what) const {
  if (!ok) throw io_error(file_.string(), what);
}

bool Hdf5Reader::has(const std::string& name) const {
  for (std::size_t end = 0; end != std::string::npos;) {
    end = name.find('/', end + 1);
    if (H5Lexists(handle_, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return true;
}

bool Hdf5Reader::has_attribute(const std::string& name) const { return H5Aexists(handle_, name.c_str()) > 0; }

std::vector<std::string> Hdf5Reader::datasets() const {
  std::vector<std::string> names;
#if H5_VERSION_GE(1, 12, 0)
  constexpr auto visit = H5Ovisit3;
#else
  constexpr auto visit = H5Ovisit2;
#endif
  check(visit(handle_, H5_INDEX_NAME, H5_ITER_INC, add_dataset, &names, H5O_INFO_BASIC) >= 0,
        "its contents cannot be listed: the file is damaged");
  return names;
}

std::vector<hsize_t> Hdf5Reader::shape(const std::string& name) const { return Set(*this, name).shape(); }

Hdf5Type Hdf5Reader::type(const std::string& name) const {
  const Set set(*this, name);
  const hid_t type = set.type();
  const std::size_t size = H5Tget_size(type);
  if (!is_plain_number(type)) return Hdf5Type::other;
  if (H5Tget_class(type) == H5T_FLOAT) return size == 8 ? Hdf5Type::float64 : Hdf5Type::float32;
  const bool has_sign = H5Tget_sign(type) == H5T_SGN_2;
  if (size == 8) return has_sign ? Hdf5Type::int64 : Hdf5Type::uint64;
  if (size == 4 && has_sign) return Hdf5Type::int32;
  return size == 1 && !has_sign ? Hdf5Type::uint8 : Hdf5Type::other;
}

template <class T>
std::vector<T> Hdf5Reader::get(const std::string& name) const {
  const Set set(*this, name);
  set.check_stored();
  std::vector<T> values(static_cast<std::size_t>(set.numbers()));
  if (values.empty()) return values;
  check(H5Dread(set, hdf5::native(T{}), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
        "cannot read the dataset " + quoted(name) + ": is the file cut short?");
  return values;
}

template std::vector<double> Hdf5Reader::get(const std::string&) const;
template std::vector<float> Hdf5Reader::get(const std::string&) const;
template std::vector<std::int32_t> Hdf5Reader::get(const std::string&) const;
template std::vector<std::int64_t> Hdf5Reader::get(const std::string&) const;
template std::vector<std::uint64_t> Hdf5Reader::get(const std::string&) const;
template std::vector<std::uint8_t> Hdf5Reader::get(const std::string&) const;

void Hdf5Reader::read_number(const std::string& name, hid_t type, void* value) const {
  const Handle attribute(H5Aopen(handle_, name.c_str(), H5P_DEFAULT), H5Aclose);
  check(attribute.ok(), "lacks the attribute '" + name + "'");
  const Handle stored(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  check(is_plain_number(stored) && H5Sget_simple_extent_npoints(space) == 1,
        "holds the attribute '" + name + "' as something else than one number");
  check(H5Aread(attribute, type, value) >= 0, "cannot read the attribute '" + name + "'");
}

double Hdf5Reader::number(const std::string& attribute) const {
  double value = 0.0;
  read_number(attribute, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::int64_t Hdf5Reader::integer(const std::string& attribute) const {
  std::int64_t value = 0;
  read_number(attribute, H5T_NATIVE_INT64, &value);
  return value;
}

std::string Hdf5Reader::text(const std::string& attribute) const {
  const Handle opened(H5Aopen(handle_, attribute.c_str(), H5P_DEFAULT), H5Aclose);
  check(opened.ok(), "lacks the attribute '" + attribute + "'");
  const Handle type(H5Aget_type(opened), H5Tclose), space(H5Aget_space(opened), H5Sclose);
  const std::size_t size = H5Tget_size(type);
  check(H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && size <= kMaxAttribute &&
            H5Sget_simple_extent_npoints(space) == 1,
        "holds the attribute '" + attribute + "' as something else than a short text");
  std::string text(size, '\0');
  check(H5Aread(opened, type, text.data()) >= 0, "cannot read the attribute '" + attribute + "'");
  text.resize(text.find_last_not_of('\0') + 1);
  return text;
}

}  // namespace furrow
